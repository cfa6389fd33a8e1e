#include <gflags/gflags.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "cost_functions/options.h"
#include "experiments/atomic_file.h"
#include "experiments/conformance.h"
#include "solvers/plugin_loader.h"
#include "tools/badge.h"
#include "tools/command.h"
#include "tools/interrupts.h"
#include "tools/limited_process.h"
#include "tools/output_files.h"
#include "tools/progress.h"
#include "tools/run_flags.h"

DEFINE_string(badge, "",
              "Where the badge is written, as a picture (.svg) or as JSON for shields.io (.json). "
              "Not given: beside the plugin, NAME.badge.svg.");
DEFINE_double(seconds_per_check, batten::ProcessLimits().seconds,
              "Wall time after which a check is given up, in seconds.");
DEFINE_double(memory_per_check, batten::ProcessLimits().memory_in_mib,
              "Memory that a check may take, in MiB.");

namespace batten {
namespace {

constexpr char kAllowedBadge[] = "FILE.svg, FILE.json";

/// One line of the table.
struct CheckRow {
  std::string kind;  // "solver"
  std::string name;
  std::string check;
  CheckVerdict verdict;
};

struct NamedCheck {
  PluginName subject;
  ConformanceCheck check;
};

std::string BadgePath(const std::string& plugin) {
  if (!FLAGS_badge.empty()) return FLAGS_badge;
  const std::string ending = ".so";
  const std::string stem =
      EndsWith(plugin, ending) ? plugin.substr(0, plugin.size() - ending.size()) : plugin;
  return stem + ".badge.svg";
}

ProcessLimits LimitsFromFlags() {
  ProcessLimits limits;
  limits.seconds = FLAGS_seconds_per_check;
  limits.memory_in_mib = FLAGS_memory_per_check;
  return limits;
}

/// Passed and failed checks as the child writes them: one letter, then the detail.
CheckVerdict VerdictOf(const ProcessEnd& end) {
  if (end.kind != ProcessEnd::Kind::kReturned) return {false, end.reason};
  const bool passed = !end.output.empty() && end.output.front() == 'p';
  return {passed, end.output.empty() ? "ends without a word" : end.output.substr(1)};
}

/// What registering brought in, of what has checks.
std::vector<NamedCheck> ChecksOf(const LoadedPlugin& plugin) {
  std::vector<NamedCheck> checks;
  for (const PluginName& subject : plugin.names) {
    std::vector<ConformanceCheck> of_subject;
    if (subject.kind == "solver")
      of_subject = SolverChecks(subject.name, SolverVariants::kEachWord);
    if (subject.kind == "term") of_subject = TermChecks(subject.name);
    for (ConformanceCheck& check : of_subject) checks.push_back({subject, std::move(check)});
  }
  return checks;
}

/// Loads it in a process of its own first: a plugin may crash already then. True: it is loaded
/// here too. False with the exit status in *status.
bool LoadChecked(const std::string& path, LoadedPlugin* plugin, int* status,
                 CommandOutput* output) {
  const ProcessEnd end = RunLimited(
      [&path] {
        std::vector<LoadedPlugin> loaded = LoadedPlugins();
        return LoadPlugins({path}, &loaded);
      },
      LimitsFromFlags());
  *status = kBadInput;
  if (end.kind == ProcessEnd::Kind::kInterrupted) {
    *status = kInterruptedStatus;
  } else if (end.kind != ProcessEnd::Kind::kReturned) {
    *status = kDisagreement;
    output->error = "check: " + path + ": " + end.reason + " while it is loaded";
  } else if (!end.output.empty()) {
    output->error = "check: " + end.output;
  } else {
    output->error = LoadPlugins({path}, &LoadedPlugins());
  }
  if (*status != kBadInput || !output->error.empty()) return false;
  // It need not be the last one: it may stand in BATTEN_PLUGIN_PATH too.
  std::error_code code;
  const std::string canonical = std::filesystem::canonical(path, code).string();
  for (const LoadedPlugin& loaded : LoadedPlugins()) {
    if (loaded.path == canonical) *plugin = loaded;
  }
  return true;
}

std::string TableOf(const LoadedPlugin& plugin, const std::vector<CheckRow>& rows) {
  constexpr std::size_t kNameWidth = 22;
  constexpr std::size_t kIndent = kNameWidth + 8;
  std::string text = plugin.path + "\nsha256 " + plugin.sha256 + "\n";
  std::string subject;
  for (const CheckRow& row : rows) {
    const std::string here = row.kind + " " + row.name;
    if (here != subject) text += "\n" + here + "\n";
    subject = here;
    std::string line = "  " + row.check;
    line.resize(kNameWidth, ' ');
    line += row.verdict.passed ? "passed" : "FAILED";
    line.resize(kIndent, ' ');
    text += line + Wrapped(OneLine(row.verdict.detail), kIndent, kIndent);
  }
  return text;
}

std::string Names(const LoadedPlugin& plugin) {
  std::string text;
  for (const PluginName& name : plugin.names) {
    if (name.kind != "solver" && name.kind != "term") {
      text += "\n" + name.kind + " " + name.name + "\n  has no checks\n";
    }
  }
  return text;
}

/// False where the program was interrupted.
bool RunChecks(const LoadedPlugin& plugin, std::vector<CheckRow>* rows) {
  const InterruptibleRun run;
  const ProcessLimits limits = LimitsFromFlags();
  const std::vector<NamedCheck> checks = ChecksOf(plugin);
  Progress progress(FLAGS_quiet);
  for (std::size_t i = 0; i < checks.size(); ++i) {
    const PluginName& subject = checks[i].subject;
    const ConformanceCheck& check = checks[i].check;
    progress.Show(static_cast<double>(i) / static_cast<double>(checks.size()),
                  subject.name + ": " + check.name);
    const ProcessEnd end = RunLimited(
        [&check] {
          const CheckVerdict verdict = check.run();
          return (verdict.passed ? "p" : "f") + verdict.detail;
        },
        limits);
    if (end.kind == ProcessEnd::Kind::kInterrupted) return false;
    rows->push_back({subject.kind, subject.name, check.name, VerdictOf(end)});
  }
  return true;
}

bool CheckBadge(const std::string& plugin, std::string* error) {
  const std::string path = BadgePath(plugin);
  if (WasGiven("badge") && !EndsWith(path, ".svg") && !EndsWith(path, ".json")) {
    *error = RefusedFlag("badge", path, kAllowedBadge);
    return false;
  }
  return CheckOutputs({{"badge", path}}, {plugin}, error);
}

int RunCheck(const std::vector<std::string>& positional, CommandOutput* output) {
  if (positional.size() != 1) {
    return Refuse(
        "check: found " + std::to_string(positional.size()) + " files; allowed: one PLUGIN.so",
        output);
  }
  const std::string& path = positional.front();
  if (!CheckBadge(path, &output->error)) return kBadInput;
  LoadedPlugin plugin;
  int status = kBadInput;
  if (!LoadChecked(path, &plugin, &status, output)) return status;
  std::vector<CheckRow> rows;
  if (!RunChecks(plugin, &rows)) return kInterruptedStatus;
  const auto num_passed = static_cast<std::size_t>(std::count_if(
      rows.begin(), rows.end(), [](const CheckRow& row) { return row.verdict.passed; }));
  const bool all = num_passed == rows.size();
  const std::string sum =
      std::to_string(num_passed) + " of " + std::to_string(rows.size()) + " checks passed";
  output->results = TableOf(plugin, rows) + Names(plugin) + "\n" + sum + "\n";
  const std::string badge = BadgePath(path);
  const std::string label = "batten API " + std::to_string(BATTEN_API_LEVEL);
  const std::string contents =
      EndsWith(badge, ".json") ? BadgeJson(label, sum, all) : BadgeSvg(label, sum, all);
  if (!WriteFileAtomically(badge, contents, &output->error)) return kBadInput;
  return all ? kDone : kDisagreement;
}

}  // namespace

Command CheckCommand() {
  Command command;
  command.name = "check";
  command.arguments = "PLUGIN.so";
  command.summary = "runs the conformance suite on a plugin's solvers and terms";
  command.details = {
      "Each check runs in a process of its own with limits of time and memory, so that a plugin "
      "that crashes, hangs or eats memory fails that check. docs/plugins.md says what each asks "
      "for.",
      "Writes a badge. Exit status 3 where a check fails."};
  command.examples = {"batten check build/mine.so",
                      "batten check build/mine.so --badge=docs/mine.json"};
  command.flags = {TextFlag("badge", "FILE", kAllowedBadge),
                   NumberAboveFlag("seconds_per_check", "SECONDS", 0.0, 1e6),
                   NumberAboveFlag("memory_per_check", "MIB", 0.0, 1e7), SwitchFlag("quiet")};
  command.run = &RunCheck;
  return command;
}

}  // namespace batten
