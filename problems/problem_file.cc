#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "problems/catalogue.h"
#include "problems/curve_constraints.h"
#include "problems/data_folders.h"
#include "problems/fit_guard.h"
#include "problems/strict_json.h"

namespace batten {
namespace {

constexpr auto kRequired = StrictObject::Presence::kRequired;
constexpr auto kOptional = StrictObject::Presence::kOptional;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Knots as a list: they stand for the number of control points, the ends and the domain.
bool ReadGivenKnots(const StrictObject& spline, FitSpec* spec) {
  for (const char* key : {"ends", "domain"}) {
    if (spline.Has(key)) return spline.Refuse(key, "nothing, where the knots are given");
  }
  std::string why;
  if (!spline.Numbers("knots", kRequired, &spec->given_knots)) return false;
  const auto basis = BsplineBasis::Make(spec->degree, spec->closed, spec->given_knots, &why);
  if (!basis.has_value()) return spline.Complain("knots", why);
  const int n = basis->num_control_points();
  spec->control_points = n;
  if (!spline.Integer("control_points", kOptional, 1, kMaxControlPoints, &spec->control_points)) {
    return false;
  }
  return spec->control_points == n ||
         spline.Refuse("control_points", std::to_string(n) + ", as the given knots make");
}

bool ReadKnotRule(const StrictObject& spline, FitSpec* spec) {
  const int fewest = spec->closed ? 1 : spec->degree + 1;
  std::string knots = ToString(spec->knots);
  std::string ends = "end_interpolating";
  if (!spline.Integer("control_points", kRequired, fewest, kMaxControlPoints,
                      &spec->control_points) ||
      !spline.Word("knots", kOptional, {"uniform", "averaged"}, &knots)) {
    return false;
  }
  if (spec->closed && spline.Has("ends")) {
    return spline.Refuse("ends", "nothing, where the spline is closed");
  }
  if (!spline.Word("ends", kOptional, {"end_interpolating", "floating"}, &ends)) return false;
  FromString(knots, &spec->knots);
  spec->ends = ends == "floating" ? EndKnots::kFloating : EndKnots::kEndInterpolating;
  return true;
}

bool ReadDomain(const StrictObject& spline, FitSpec* spec) {
  if (!spline.Has("domain")) return true;
  constexpr char kAllowed[] = "[begin, end] with begin < end";
  std::vector<double> domain;
  if (!spline.Numbers("domain", kRequired, &domain)) return false;
  if (domain.size() != 2 || !(domain[0] < domain[1])) return spline.Refuse("domain", kAllowed);
  if (spec->parameters.has_value()) {
    return spline.Refuse("domain", "nothing, unless the parameters are given");
  }
  spec->domain = {domain[0], domain[1]};
  return true;
}

/// After the parameters, whose rule decides whether a domain may be stated.
bool ReadSpline(const StrictObject& file, FitSpec* spec) {
  StrictObject spline;
  if (!file.Object("spline", kRequired, &spline) ||
      !spline.HasOnly({"degree", "closed", "control_points", "knots", "ends", "domain"}) ||
      !spline.Integer("degree", kOptional, 1, kMaxDegree, &spec->degree) ||
      !spline.Flag("closed", kOptional, &spec->closed)) {
    return false;
  }
  if (spline.IsList("knots")) return ReadGivenKnots(spline, spec);
  return ReadKnotRule(spline, spec) && ReadDomain(spline, spec);
}

bool ReadParameters(const StrictObject& file, FitSpec* spec) {
  std::string word = ToString(*spec->parameters);
  if (!file.Word("parameters", kOptional, {"uniform", "chord_length", "centripetal", "given"},
                 &word)) {
    return false;
  }
  Parameterization rule = Parameterization::kUniform;
  spec->parameters.reset();
  if (FromString(word, &rule)) spec->parameters = rule;
  return true;
}

bool ReadTerms(const StrictObject& file, FitSpec* spec) {
  std::vector<std::string> texts;  // none: those usual for the kind of parameters
  if (!file.Texts("terms", kOptional, &texts)) return false;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    NameSpec term;
    const Term* found = nullptr;
    OptionValues options;
    std::string why;
    if (!ParseNameSpec(texts[i], &term, &why) ||
        !TermRegistry::Global().Resolve(term, &found, &options, &why)) {
      return file.Complain("terms/" + std::to_string(i), why);
    }
    spec->terms.push_back(std::move(term));
  }
  return true;
}

bool ReadConstraints(const StrictObject& file, FitSpec* spec) {
  std::vector<std::string> texts;
  if (!file.Texts("constraints", kOptional, &texts)) return false;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    NameSpec constraint;
    std::string why;
    if (!ParseNameSpec(texts[i], &constraint, &why) || !CheckConstraint(constraint, &why)) {
      return file.Complain("constraints/" + std::to_string(i), why);
    }
    spec->constraints.push_back(std::move(constraint));
  }
  return true;
}

bool ReadName(const StrictObject& file, std::string* name) {
  constexpr char kCharacters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  if (!file.Text("name", kRequired, name)) return false;
  return name->find_first_not_of(kCharacters) == std::string::npos ||
         file.Refuse("name", "letters, digits, _ and -");
}

bool ReadData(const StrictObject& file, CatalogueEntry* entry) {
  std::string name;
  if (!file.Text("data", kRequired, &name)) return false;
  entry->data_path = FindDataFile(name, entry->path);
  if (!entry->data_path.empty()) return true;
  return file.Refuse("data", AllowedDataFiles(name, entry->path));
}

/// With moving parameters there are many minima, of which nobody knows that one is the least: what
/// is stated there is the lowest energy at foot points that was found.
bool ReadReference(const StrictObject& file, CatalogueEntry* entry) {
  StrictObject reference;
  std::string source;  // how the energy was computed: for the reader of the file
  entry->reference_energy = std::numeric_limits<double>::quiet_NaN();
  if (!file.Has("reference")) return true;
  const char* const key =
      entry->spec.parameter_kind == ParameterKind::kFixed ? "energy" : "best_known";
  return file.Object("reference", kRequired, &reference) && reference.HasOnly({key, "source"}) &&
         reference.Number(key, kRequired, 0.0, kInfinity, &entry->reference_energy) &&
         reference.Text("source", kOptional, &source);
}

bool ReadGuard(const StrictObject& file, FitSpec* spec) {
  if (!file.Has("guard")) return true;
  std::string text;
  NameSpec guard;
  std::vector<NameSpec> terms;
  std::string why;
  if (!file.Text("guard", kRequired, &text)) return false;
  if (!ParseNameSpec(text, &guard, &why) || !ApplyGuard(guard, 1, &terms, &why)) {
    return file.Complain("guard", why);
  }
  spec->guard = std::move(guard);
  return true;
}

/// After the terms and the guard. How many spans there are is known once the knots are.
bool ReadSpanWeights(const StrictObject& file, FitSpec* spec) {
  if (!file.Has("span_weights")) return true;
  const bool has_fairing = std::any_of(
      spec->terms.begin(), spec->terms.end(),
      [](const NameSpec& term) { return term.name == "fairing" || term.name == "curve_fairing"; });
  if (!has_fairing && !HasGuard(spec->guard)) {
    return file.Refuse("span_weights",
                       "nothing, where there is neither a fairing term nor a guard");
  }
  if (!file.Numbers("span_weights", kRequired, &spec->span_weights)) return false;
  for (std::size_t k = 0; k < spec->span_weights.size(); ++k) {
    const double weight = spec->span_weights[k];
    if (weight >= 0.0 && std::isfinite(weight)) continue;
    return file.Complain("span_weights/" + std::to_string(k),
                         "found " + NumberText(weight) + "; allowed: a number >= 0");
  }
  return true;
}

bool ReadKind(const StrictObject& file, FitSpec* spec) {
  std::string kind = ToString(spec->parameter_kind);
  return file.Word("parameter_kind", kOptional, {"fixed", "free", "projected"}, &kind) &&
         FromString(kind, &spec->parameter_kind) &&
         file.Flag("hold_ends", kOptional, &spec->hold_ends) &&
         file.Flag("keep_order", kOptional, &spec->keep_order);
}

}  // namespace

bool ReadProblemFile(const std::string& path, CatalogueEntry* entry, std::string* error) {
  nlohmann::json json;
  if (!ReadJsonFile(path, &json, error)) {
    const std::string ending = std::filesystem::path(path).extension();
    if (ending == ".csv" || ending == ".txt") {
      *error += "; points are fitted with batten fit, or named in a problem file";
    }
    return false;
  }
  const StrictObject file(path, "", &json, error);
  CatalogueEntry read;
  read.path = path;
  FitSpec* spec = &read.spec;
  if (!file.HasOnly({"name", "summary", "data", "spline", "parameters", "terms", "start",
                     "parameter_kind", "hold_ends", "keep_order", "guard", "span_weights",
                     "constraints", "reference", "citation"}) ||
      !ReadName(file, &read.name) || !file.Text("summary", kOptional, &read.summary) ||
      !ReadData(file, &read) || !ReadParameters(file, spec) || !ReadSpline(file, spec) ||
      !ReadTerms(file, spec) || !ReadConstraints(file, spec) ||
      !file.Word("start", kOptional, {"data", "centroid", "circle", "ellipse"}, &spec->start) ||
      !ReadKind(file, spec) || !ReadGuard(file, spec) || !ReadSpanWeights(file, spec) ||
      !ReadReference(file, &read) || !file.Text("citation", kOptional, &read.citation)) {
    return false;
  }
  spec->name = read.name;
  *entry = std::move(read);
  return true;
}

}  // namespace batten
