#include "experiments/bench_suite.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "experiments/bench_matrix.h"
#include "experiments/bench_problem.h"
#include "experiments/plugin_faults.h"
#include "problems/strict_json.h"
#include "solvers/plugin_loader.h"

namespace batten {
namespace {

using Presence = StrictObject::Presence;
constexpr double kLongest = 1e9;  // seconds
constexpr int kLargest = std::numeric_limits<int>::max();

/// First of all: problems, terms and solvers may come from them. Paths begin at the suite's folder.
bool ReadPlugins(const StrictObject& file, const std::string& suite_path) {
  std::vector<std::string> paths;
  if (!file.Texts("plugins", Presence::kOptional, &paths)) return false;
  const std::filesystem::path folder = std::filesystem::path(suite_path).parent_path();
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const std::string why = LoadPlugins({(folder / paths[i]).string()}, &LoadedPlugins());
    if (!why.empty()) return file.Complain("plugins/" + std::to_string(i), why);
  }
  return true;
}

bool ReadProblems(const StrictObject& file, BenchSuite* suite, std::string* error) {
  std::vector<StrictObject> entries;
  if (!file.Entries("problems", Presence::kRequired, "a list of problems", &entries)) return false;
  std::set<std::string> labels;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const std::string place = "/problems/" + std::to_string(i);
    std::vector<BenchProblem> read;
    if (!ReadBenchProblems(entries[i], suite->path, place, &read, error)) return false;
    for (BenchProblem& problem : read) {
      if (!labels.insert(problem.label).second) {
        return entries[i].Complain(
            "", "found " + problem.label + " twice; allowed: each problem once, by its name");
      }
      suite->problems.push_back(std::move(problem));
    }
  }
  return true;
}

bool ReadExclusions(const StrictObject& file, BenchSuite* suite) {
  std::vector<StrictObject> entries;
  if (!file.Entries("exclude", Presence::kOptional, "a list of exclusions", &entries)) return false;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    BenchExclusion exclusion;
    exclusion.place = "/exclude/" + std::to_string(i);
    if (!entries[i].HasOnly({"problems", "terms", "solvers"}) ||
        !entries[i].Texts("problems", Presence::kOptional, &exclusion.problems) ||
        !entries[i].Texts("terms", Presence::kOptional, &exclusion.terms) ||
        !entries[i].Texts("solvers", Presence::kOptional, &exclusion.solvers)) {
      return false;
    }
    suite->exclusions.push_back(std::move(exclusion));
  }
  return true;
}

bool ReadTargets(const StrictObject& file, BenchSuite* suite) {
  StrictObject targets;
  if (!file.Has("targets")) return true;
  if (!file.Object("targets", Presence::kRequired, &targets) || !targets.HasOnly({"gaps"}) ||
      !targets.Numbers("gaps", Presence::kRequired, &suite->gap_targets)) {
    return false;
  }
  for (std::size_t i = 0; i < suite->gap_targets.size(); ++i) {
    if (suite->gap_targets[i] > 0.0 && suite->gap_targets[i] < 1.0) continue;
    return targets.Refuse("gaps/" + std::to_string(i), "numbers above 0 and below 1");
  }
  if (!targets.IsWithoutRepeats("gaps", suite->gap_targets)) return false;
  std::sort(suite->gap_targets.rbegin(), suite->gap_targets.rend());
  return true;
}

bool ReadBudgets(const StrictObject& file, BenchSuite* suite) {
  StrictObject budgets;
  if (!file.Has("budgets")) return true;
  RunSpec* const run = &suite->run;
  BenchLimits* const limits = &suite->limits;
  // Below a millisecond no process would even begin.
  constexpr double kShortest = 1e-3;
  if (!file.Object("budgets", Presence::kRequired, &budgets) ||
      !budgets.HasOnly({"iterations", "seconds", "cpu_seconds", "wall_seconds", "memory_mb"}) ||
      !budgets.Integer("iterations", Presence::kOptional, 0, kLargest, &run->max_iterations) ||
      !budgets.Number("seconds", Presence::kOptional, kShortest, kLongest, &run->max_seconds) ||
      !budgets.Number("cpu_seconds", Presence::kOptional, kShortest, kLongest,
                      &limits->cpu_seconds) ||
      !budgets.Number("wall_seconds", Presence::kOptional, kShortest, kLongest,
                      &limits->wall_seconds) ||
      !budgets.Integer("memory_mb", Presence::kOptional, 16, 16'000'000, &limits->memory_mb)) {
    return false;
  }
  // The process would end before its solver may.
  if (limits->wall_seconds == 0.0 || run->max_seconds <= limits->wall_seconds) return true;
  if (budgets.Has("seconds")) {
    return budgets.Refuse("seconds", "at most wall_seconds, " + NumberText(limits->wall_seconds));
  }
  run->max_seconds = limits->wall_seconds;
  return true;
}

bool ReadRule(const StrictObject& file, BenchSuite* suite) {
  StrictObject rule;
  if (!file.Has("rule")) return true;
  RunSpec* const run = &suite->run;
  std::string mode = ToString(run->mode);
  return file.Object("rule", Presence::kRequired, &rule) &&
         rule.HasOnly({"mode", "gradient_tolerance", "native_step", "native_gradient", "threads",
                       "compile"}) &&
         rule.Word("mode", Presence::kOptional, {"race", "native"}, &mode) &&
         FromString(mode, &run->mode) &&
         rule.Number("gradient_tolerance", Presence::kOptional, 0.0, 1.0,
                     &run->gradient_tolerance) &&
         rule.Number("native_step", Presence::kOptional, 0.0, HUGE_VAL, &run->native_step) &&
         rule.Number("native_gradient", Presence::kOptional, 0.0, HUGE_VAL,
                     &run->native_gradient) &&
         rule.Integer("threads", Presence::kOptional, 1, 1024, &run->threads) &&
         rule.Flag("compile", Presence::kOptional, &run->compile);
}

bool ReadSeeds(const StrictObject& file, BenchSuite* suite) {
  StrictObject seeds;
  if (!file.Has("seeds")) return true;
  return file.Object("seeds", Presence::kRequired, &seeds) &&
         seeds.HasOnly({"data", "start", "solver"}) &&
         seeds.Integers("data", Presence::kOptional, 1, kLargest, &suite->seeds.data) &&
         seeds.Integers("start", Presence::kOptional, 1, kLargest, &suite->seeds.start) &&
         seeds.Integers("solver", Presence::kOptional, 0, kLargest, &suite->seeds.solver) &&
         seeds.IsWithoutRepeats("data", suite->seeds.data) &&
         seeds.IsWithoutRepeats("start", suite->seeds.start) &&
         seeds.IsWithoutRepeats("solver", suite->seeds.solver);
}

/// The first and the last are always among them.
bool ReadKeptIterates(const StrictObject& file, BenchSuite* suite) {
  constexpr int kMost = 1000;
  constexpr char kAllowed[] = "all, 0, or 2 to 1000";
  if (!file.Has("keep_iterates")) return true;
  if (!file.IsNumber("keep_iterates")) {
    std::string word;
    return file.Text("keep_iterates", Presence::kRequired, &word) &&
           (word == "all" || file.Refuse("keep_iterates", kAllowed));
  }
  return file.Integer("keep_iterates", Presence::kRequired, 0, kMost, &suite->keep_iterates) &&
         (suite->keep_iterates != 1 || file.Refuse("keep_iterates", kAllowed));
}

bool ReadOrder(const StrictObject& file, BenchSuite* suite) {
  StrictObject order;
  constexpr int kMostRepetitions = 1000;
  if (!file.Integer("repetitions", Presence::kOptional, 1, kMostRepetitions, &suite->repetitions) ||
      !file.Integer("warm_up", Presence::kOptional, 0, kMostRepetitions, &suite->warm_up)) {
    return false;
  }
  if (!file.Has("order")) return true;
  return file.Object("order", Presence::kRequired, &order) && order.HasOnly({"shuffled", "seed"}) &&
         order.Flag("shuffled", Presence::kOptional, &suite->shuffled) &&
         order.Integer("seed", Presence::kOptional, 0, kLargest, &suite->order_seed);
}

/// What only making a problem shows: bad data, too few points, terms that do not fit.
bool TryProblems(const StrictObject& file, const BenchSuite& suite) {
  for (const BenchProblem& problem : suite.problems) {
    for (std::size_t t = 0; t < suite.terms.size(); ++t) {
      CellSeeds seeds;
      if (UsesDataSeed(problem)) seeds.data = suite.seeds.data.front();
      if (UsesStartSeed(problem) && !suite.seeds.start.empty()) {
        seeds.start = suite.seeds.start.front();
      }
      std::string why;
      const auto make = [&] { return MakeBenchProblem(problem, suite.terms[t], seeds, &why); };
      const std::string end = HasTermOfPlugin(TermsOf(problem, suite.terms[t]))
                                  ? WhyNoReturn([&make] { make(); })
                                  : std::string();
      if (end.empty() && make() != nullptr) continue;
      if (!end.empty()) why = "a term of a plugin " + end + " while the problem is made";
      const std::string with =
          suite.terms.size() > 1 ? " with terms " + suite.terms[t].label : std::string();
      return file.Complain(problem.place.substr(1), problem.label + with + ": " + why);
    }
  }
  return true;
}

/// One axis of a matrix, as exclusions name it.
struct Axis {
  std::string key;
  std::string kind;  // what one of its labels is
  std::vector<std::string> labels;
};

/// A pattern that matches nothing is a slip of the pen.
bool CheckPatterns(const StrictObject& file, const std::string& place, const Axis& axis,
                   const std::vector<std::string>& patterns) {
  for (std::size_t k = 0; k < patterns.size(); ++k) {
    const bool matches =
        std::any_of(axis.labels.begin(), axis.labels.end(),
                    [&](const std::string& label) { return MatchesPattern(patterns[k], label); });
    if (matches) continue;
    return file.Complain(place + "/" + axis.key + "/" + std::to_string(k),
                         UnknownNameMessage(axis.kind, patterns[k], axis.labels));
  }
  return true;
}

bool CheckExclusions(const StrictObject& file, const BenchSuite& suite) {
  Axis problems = {"problems", "problem", {}};
  Axis terms = {"terms", "terms", {}};
  Axis solvers = {"solvers", "solver", {}};
  for (const BenchProblem& problem : suite.problems) problems.labels.push_back(problem.label);
  for (const BenchTerms& choice : suite.terms) terms.labels.push_back(choice.label);
  for (const NameSpec& solver : suite.solvers) solvers.labels.push_back(solver.ToString());
  for (const BenchExclusion& exclusion : suite.exclusions) {
    const std::string place = exclusion.place.substr(1);
    if (!CheckPatterns(file, place, problems, exclusion.problems) ||
        !CheckPatterns(file, place, terms, exclusion.terms) ||
        !CheckPatterns(file, place, solvers, exclusion.solvers)) {
      return false;
    }
  }
  return !BenchMatrix(suite).empty() ||
         file.Complain("exclude", "leaves nothing to run; allowed: at least one cell");
}

}  // namespace

bool ReadBenchSuite(const std::string& path, BenchSuite* suite, std::string* error) {
  nlohmann::json json;
  if (!ReadJsonFile(path, &json, error)) return false;
  const StrictObject file(path, "", &json, error);
  BenchSuite read;
  read.path = path;
  std::string format;
  if (!file.HasOnly({"format", "name", "summary", "plugins", "problems", "terms", "solvers",
                     "exclude", "targets", "budgets", "rule", "seeds", "repetitions", "warm_up",
                     "order", "keep_iterates"}) ||
      !file.Word("format", Presence::kRequired, {"batten.suite/1"}, &format) ||
      !file.Text("name", Presence::kRequired, &read.name) ||
      !file.Text("summary", Presence::kOptional, &read.summary) || !ReadPlugins(file, path) ||
      !ReadProblems(file, &read, error) || !ReadBenchTerms(file, &read) ||
      !ReadBenchSolvers(file, &read.solvers) || !ReadExclusions(file, &read) ||
      !ReadTargets(file, &read) || !ReadBudgets(file, &read) || !ReadRule(file, &read) ||
      !ReadSeeds(file, &read) || !ReadOrder(file, &read) || !ReadKeptIterates(file, &read) ||
      !TryProblems(file, read) || !CheckRepeatedTerms(file, read) || !CheckExclusions(file, read)) {
    return false;
  }
  *suite = std::move(read);
  return true;
}

bool MatchesPattern(const std::string& pattern, const std::string& text) {
  const std::size_t star = pattern.find('*');
  if (star == std::string::npos) return pattern == text;
  if (text.compare(0, star, pattern, 0, star) != 0) return false;
  const std::string rest = pattern.substr(star + 1);
  for (std::size_t begin = star; begin <= text.size(); ++begin) {
    if (MatchesPattern(rest, text.substr(begin))) return true;
  }
  return false;
}

}  // namespace batten
