#include <gflags/gflags.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cost_functions/term.h"
#include "problems/catalogue.h"
#include "solvers/cut_rule_registry.h"
#include "solvers/plugin_loader.h"
#include "solvers/solver_registry.h"
#include "tools/command.h"

DEFINE_bool(json, false, "As JSON, for programs.");

namespace batten {
namespace {

using Json = nlohmann::ordered_json;

Json NumberOrNull(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json OptionsJson(const std::vector<OptionInfo>& options) {
  Json list = Json::array();
  for (const OptionInfo& option : options) {
    Json json = {{"name", option.name}, {"help", option.help}};
    if (option.kind == OptionInfo::Kind::kWord) {
      json["kind"] = "word";
      json["default"] = option.default_word;
      json["words"] = option.words;
    } else {
      json["kind"] = option.kind == OptionInfo::Kind::kInteger ? "integer" : "real";
      json["default"] = NumberOrNull(option.default_number);
      json["lowest"] = NumberOrNull(option.lowest);
      json["highest"] = NumberOrNull(option.highest);
    }
    list.push_back(json);
  }
  return list;
}

const char* ToString(NativeRule rule) {
  switch (rule) {
    case NativeRule::kDirect:
      return "direct";
    case NativeRule::kStep:
      return "step";
    case NativeRule::kGradient:
      return "gradient";
  }
  return "";
}

Json SolversJson() {
  Json list = Json::array();
  for (const std::string& name : SolverRegistry::Global().Names()) {
    const SolverInfo& info = *SolverRegistry::Global().Find(name);
    list.push_back({{"name", info.name},
                    {"summary", info.summary},
                    {"source", info.source},
                    {"needs", info.needs},
                    {"supports", info.supports},
                    {"limit", info.limit.empty() ? Json(nullptr) : Json(info.limit)},
                    {"usual_base", info.usual_base.empty() ? Json(nullptr) : Json(info.usual_base)},
                    {"native_rule", ToString(info.native_rule)},
                    {"wraps_solver", info.wraps_solver},
                    {"options", OptionsJson(info.options)}});
  }
  return list;
}

std::vector<OptionInfo> AllOptions(const TermInfo& info) {
  std::vector<OptionInfo> options = info.options;
  for (const OptionInfo& option : CommonTermOptions()) options.push_back(option);
  return options;
}

Json TermsJson() {
  Json list = Json::array();
  for (const std::string& name : TermRegistry::Global().Names()) {
    const TermInfo info = TermRegistry::Global().Find(name)->Info();
    list.push_back({{"name", info.name},
                    {"summary", info.summary},
                    {"source", info.source},
                    {"linear", info.affine},
                    {"options", OptionsJson(AllOptions(info))}});
  }
  return list;
}

Json RulesJson() {
  Json list = Json::array();
  for (const std::string& name : CutRuleRegistry::Global().Names()) {
    const CutRuleInfo& info = *CutRuleRegistry::Global().Find(name);
    list.push_back({{"name", info.name},
                    {"summary", info.summary},
                    {"source", info.source},
                    {"options", OptionsJson(info.options)}});
  }
  return list;
}

Json ProblemsJson(const std::vector<CatalogueEntry>& entries) {
  Json list = Json::array();
  const double nan = std::nan("");
  for (const CatalogueEntry& entry : entries) {
    const bool fixed = entry.spec.parameter_kind == ParameterKind::kFixed;
    list.push_back({{"name", entry.name},
                    {"summary", entry.summary},
                    {"path", entry.path},
                    {"data", entry.data_path},
                    {"degree", entry.spec.degree},
                    {"closed", entry.spec.closed},
                    {"control_points", entry.spec.control_points},
                    {"reference_energy", NumberOrNull(fixed ? entry.reference_energy : nan)},
                    {"best_known_energy", NumberOrNull(fixed ? nan : entry.reference_energy)},
                    {"citation", entry.citation}});
  }
  return list;
}

Json PluginsJson() {
  Json list = Json::array();
  for (const LoadedPlugin& plugin : LoadedPlugins()) {
    Json names = Json::array();
    for (const PluginName& name : plugin.names) {
      names.push_back({{"kind", name.kind}, {"name", name.name}});
    }
    Json card = Json::object();
    for (const auto& [field, value] : plugin.card) card[field] = value;
    list.push_back({{"path", plugin.path},
                    {"sha256", plugin.sha256},
                    {"card", std::move(card)},
                    {"names", std::move(names)}});
  }
  return list;
}

constexpr size_t kIndent = 21;

std::string Entry(const std::string& name, const std::string& text, size_t indent = kIndent) {
  std::string first = "  " + name + " ";
  first.resize(std::max(first.size(), indent), ' ');
  return first + Wrapped(text, indent, first.size());
}

std::string OptionsText(const std::vector<OptionInfo>& options) {
  std::string text;
  for (const OptionInfo& option : options) {
    const std::string sentence = "/" + option.name + "=" + option.DefaultText() + "  " +
                                 option.help + " [" + option.RangeText() + "]";
    text += std::string(kIndent, ' ') + Wrapped(sentence, kIndent + 4, kIndent);
  }
  return text;
}

std::string SolversText() {
  std::string text = "Solvers, with their options and defaults (NAME/OPTION=VALUE):\n";
  for (const std::string& name : SolverRegistry::Global().Names()) {
    const SolverInfo& info = *SolverRegistry::Global().Find(name);
    text += Entry(name + (info.wraps_solver ? ":SOLVER" : ""), info.summary);
    std::string needs;
    for (const std::string& need : info.needs) needs += (needs.empty() ? "needs " : ", ") + need;
    if (!needs.empty()) text += std::string(kIndent, ' ') + Wrapped(needs, kIndent, kIndent);
    if (!info.limit.empty()) {
      const std::string limit = "does not always go to the minimum of E, but to " + info.limit;
      text += std::string(kIndent, ' ') + Wrapped(limit, kIndent, kIndent);
    }
    text += OptionsText(info.options);
  }
  return text;
}

std::string TermsText() {
  std::string text = "Terms, with their own options (NAME/OPTION=VALUE):\n";
  for (const std::string& name : TermRegistry::Global().Names()) {
    const TermInfo info = TermRegistry::Global().Find(name)->Info();
    text += Entry(name, info.summary) + OptionsText(info.options);
  }
  return text + "  every term:\n" + OptionsText(CommonTermOptions());
}

std::string RulesText() {
  std::string text = "Cut rules of subdivide, with their options (NAME/OPTION=VALUE):\n";
  for (const std::string& name : CutRuleRegistry::Global().Names()) {
    const CutRuleInfo& info = *CutRuleRegistry::Global().Find(name);
    text += Entry(name, info.summary) + OptionsText(info.options);
  }
  return text;
}

std::string ProblemsText(const std::vector<CatalogueEntry>& entries) {
  std::string text = "Problems:\n";
  size_t indent = kIndent;
  for (const CatalogueEntry& entry : entries) indent = std::max(indent, entry.name.size() + 4);
  for (const CatalogueEntry& entry : entries) {
    const FitSpec& spec = entry.spec;
    text += Entry(entry.name,
                  entry.summary + "; " + (spec.closed ? "closed" : "open") + ", degree " +
                      std::to_string(spec.degree) + ", " + std::to_string(spec.control_points) +
                      " control points",
                  indent);
  }
  return text;
}

int RunList(const std::vector<std::string>& positional, CommandOutput* output) {
  const std::vector<std::string> kinds = {"solvers", "terms", "rules", "problems"};
  if (positional.size() > 1) {
    return Refuse("list: found " + std::to_string(positional.size()) +
                      " words; allowed: one of solvers, terms, rules, problems",
                  output);
  }
  const std::string wanted = positional.empty() ? "" : positional.front();
  if (!positional.empty() && std::count(kinds.begin(), kinds.end(), wanted) == 0) {
    return Refuse(UnknownNameMessage("list", wanted, kinds), output);
  }
  const auto shown = [&wanted](const char* kind) { return wanted.empty() || wanted == kind; };
  std::vector<CatalogueEntry> entries;
  if (shown("problems")) {
    std::vector<std::string> names;
    if (!ListCatalogue(&names, &output->error)) return kBadInput;
    for (const std::string& name : names) {
      entries.emplace_back();
      if (!FindProblem(name, &entries.back(), &output->error)) return kBadInput;
    }
  }
  if (FLAGS_json) {
    Json json = Json::object();
    if (shown("solvers")) json["solvers"] = SolversJson();
    if (shown("terms")) json["terms"] = TermsJson();
    if (shown("rules")) json["rules"] = RulesJson();
    if (shown("problems")) json["problems"] = ProblemsJson(entries);
    if (!LoadedPlugins().empty()) json["plugins"] = PluginsJson();
    output->results = json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
    return kDone;
  }
  std::vector<std::string> parts;
  if (shown("solvers")) parts.push_back(SolversText());
  if (shown("terms")) parts.push_back(TermsText());
  if (shown("rules")) parts.push_back(RulesText());
  if (shown("problems")) parts.push_back(ProblemsText(entries));
  for (const std::string& part : parts) {
    output->results += (output->results.empty() ? "" : "\n") + part;
  }
  return kDone;
}

}  // namespace

Command ListCommand() {
  Command command;
  command.name = "list";
  command.arguments = "[solvers|terms|rules|problems]";
  command.summary =
      "lists solvers, terms, cut rules and problems with their options, defaults and ranges";
  command.examples = {"batten list solvers", "batten list --json"};
  command.flags = {SwitchFlag("json")};
  command.run = &RunList;
  return command;
}

}  // namespace batten
