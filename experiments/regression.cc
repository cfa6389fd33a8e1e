#include "experiments/regression.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "cost_functions/options.h"
#include "experiments/comparison.h"
#include "experiments/short_number.h"
#include "experiments/signed_rank.h"
#include "solvers/run_context.h"

namespace batten {
namespace {

using RunKey = std::array<std::string, 3>;  // instance, solver, seed

struct Pair {
  const BenchRun* before = nullptr;
  const BenchRun* now = nullptr;
};

std::string NameOf(const RunKey& key) { return key[0] + ": " + key[1]; }

std::map<RunKey, const BenchRun*> ByName(const BenchResults& results) {
  std::map<RunKey, const BenchRun*> runs;
  for (const BenchRun& run : results.runs) {
    runs[{results.instances[run.instance].label, results.solvers[run.solver],
          std::to_string(run.solver_seed)}] = &run;
  }
  return runs;
}

/// In every repetition, and nothing belies it.
bool Reached(const BenchRun& run) {
  return std::all_of(run.rows.begin(), run.rows.end(), [](const nlohmann::json* row) {
    StopReason reason = StopReason::kNotRun;
    return FromString(TextAt(*row, "stop"), &reason) && IsSuccess(reason) &&
           !HasFinding(*row, "claim_fails");
  });
}

double Evaluations(const BenchRun& run) {
  double sum = 0.0;
  for (const char* key : {"energy_calls", "gradient_calls", "jacobian_calls", "products"}) {
    sum += NumberAt(*run.first, key);
  }
  return sum;
}

/// What pairs of runs are compared by.
enum class CostMeasure { kEvaluations, kSeconds, kEnergyInTime };
constexpr std::array kMeasures = {CostMeasure::kEvaluations, CostMeasure::kSeconds,
                                  CostMeasure::kEnergyInTime};

const char* ToString(CostMeasure measure) {
  switch (measure) {
    case CostMeasure::kEvaluations:
      return "evaluations";
    case CostMeasure::kSeconds:
      return "seconds";
    case CostMeasure::kEnergyInTime:
      break;
  }
  return "E at the time limit";
}

/// Where a run was when its time was over depends on the machine's mood.
bool EndsInTime(const BenchRun& run) { return TextAt(*run.first, "stop") == "time_limit"; }

class Finder {
 public:
  Finder(const RegressionRule& rule, RegressionReport* report) : rule_(rule), report_(report) {
    report_->tests = CsvTable(
        {"solver", "cost", "cells", "median_ratio", "rank_sum", "p", "p_corrected", "worse"});
  }

  void Match(const BenchResults& before, const BenchResults& now) {
    for (std::size_t t = 0; t < std::min(before.targets.size(), now.targets.size()); ++t) {
      if (before.targets[t].label == now.targets[t].label && before.targets[t].gap > 0.0) {
        targets_.push_back({before.targets[t].gap, t});
      }
    }
    std::sort(targets_.begin(), targets_.end());  // the strictest first
    CompareMachines(before, now);
    const auto old_runs = ByName(before);
    const auto new_runs = ByName(now);
    int only_before = 0, only_now = static_cast<int>(new_runs.size());
    for (const auto& [key, run] : old_runs) {
      const auto found = new_runs.find(key);
      if (found == new_runs.end()) {
        ++only_before;
        continue;
      }
      --only_now;
      pairs_[key] = {run, found->second};
    }
    report_->matched = static_cast<int>(pairs_.size());
    if (only_before > 0) {
      report_->differences.push_back(std::to_string(only_before) + " runs are in the first only");
    }
    if (only_now > 0) {
      report_->differences.push_back(std::to_string(only_now) + " runs are in the second only");
    }
  }

  void CompareEnds() {
    for (const auto& [key, pair] : pairs_) {
      const bool reached = Reached(*pair.before), reaches = Reached(*pair.now);
      const std::string stops = TextAt(*pair.before->first, "stop") + " before, " +
                                TextAt(*pair.now->first, "stop") + " now";
      if (reached && !reaches) {
        const std::string why = TextAt(*pair.now->first, "message");
        (IsCloseToTheLimit(pair) ? report_->differences : report_->regressions)
            .push_back(NameOf(key) + ": " + stops + (why.empty() ? "" : " (" + why + ")"));
        continue;
      }
      if (!reached && reaches) report_->differences.push_back(NameOf(key) + ": " + stops);
      CompareEnergies(key, pair);
    }
  }

  void CompareCosts() {
    struct Test {
      std::string solver;
      CostMeasure measure = CostMeasure::kEvaluations;
      SignedRank rank;
      double ratio = 1.0;
    };
    std::vector<Test> tests;
    std::vector<std::string> solvers = {"all"};
    for (const auto& [key, pair] : pairs_) {
      if (std::find(solvers.begin(), solvers.end(), key[1]) == solvers.end()) {
        solvers.push_back(key[1]);
      }
    }
    for (const CostMeasure measure : kMeasures) {
      for (const std::string& solver : solvers) {
        const std::vector<double> logs = LogRatios(solver, measure);
        if (!logs.empty()) {
          tests.push_back({solver, measure, TestSignedRank(logs), std::exp(Median(logs))});
        } else if (measure == CostMeasure::kEvaluations && Ran(solver) &&
                   LogRatios(solver, CostMeasure::kSeconds).empty()) {
          report_->differences.push_back(
              solver +
              ": no run reaches what is asked, or a target, both times: costs not compared");
        }
      }
    }
    std::vector<double> p_values;
    for (const Test& test : tests) p_values.push_back(test.rank.p_greater);
    const std::vector<double> corrected = HolmCorrected(p_values);
    for (std::size_t k = 0; k < tests.size(); ++k) {
      const Test& test = tests[k];
      const char* const cost = ToString(test.measure);
      const double allowed =
          test.measure == CostMeasure::kEnergyInTime ? rule_.energy_rounding : rule_.slowdown;
      const bool worse = corrected[k] < rule_.significance && test.ratio > 1.0 + allowed;
      report_->tests.AddRow({Cleaned(test.solver), cost, std::to_string(test.rank.count),
                             NumberText(test.ratio), NumberText(test.rank.positive_sum),
                             NumberText(test.rank.p_greater), NumberText(corrected[k]),
                             worse ? "yes" : "no"});
      if (!worse) continue;
      const std::string who = test.solver == "all" ? "all solvers" : test.solver;
      const bool of_energy = test.measure == CostMeasure::kEnergyInTime;
      report_->regressions.push_back(
          who + (of_energy ? " end at " : " need ") + ShortNumber(test.ratio, of_energy ? 7 : 3) +
          " times the " + cost + " (median of " + std::to_string(test.rank.count) +
          " cells that differ; p = " + ShortNumber(corrected[k], 2) + ")");
    }
  }

 private:
  static std::string Cleaned(std::string text) {
    std::replace(text.begin(), text.end(), ',', ';');
    return text;
  }

  /// The same program in two sessions of one machine may need other times: what moves them alike is
  /// taken out.
  void CompareMachines(const BenchResults& before, const BenchResults& now) {
    const auto Reference = [](const BenchResults& results) {
      std::vector<double> seconds;
      for (const BenchInstance& instance : results.instances) {
        if (std::isfinite(instance.reference_seconds)) {
          seconds.push_back(instance.reference_seconds);
        }
      }
      return seconds.empty() ? std::nan("") : Median(seconds);
    };
    const double ratio = Reference(now) / Reference(before);
    if (!(ratio > 0.0 && std::isfinite(ratio))) {
      report_->differences.push_back(
          "the machine's speed is not known of both: seconds are compared as they are");
      return;
    }
    machine_ratio_ = ratio;
    report_->differences.push_back("the machine: a fixed piece of arithmetic takes " +
                                   ShortNumber(ratio, 3) +
                                   " times the seconds now, by which seconds are divided");
  }

  /// It came to the limit of time from half of it or more: no more than the machine's mood.
  static bool IsCloseToTheLimit(const Pair& pair) {
    constexpr double kMood = 2.0;
    return EndsInTime(*pair.now) && NumberAt(*pair.now->first, "seconds") <=
                                        kMood * NumberAt(*pair.before->first, "seconds");
  }

  void CompareEnergies(const RunKey& key, const Pair& pair) {
    if (EndsInTime(*pair.before) || EndsInTime(*pair.now)) return;  // tested, all together
    const double before = NumberAt(*pair.before->first, "energy");
    const double now = NumberAt(*pair.now->first, "energy");
    const double start = NumberAt(*pair.before->first, "start_energy");
    // Ends at E = 0 are rounding of the start's.
    constexpr double kZero = 1e-12;
    const double allowed = rule_.energy_rounding * std::abs(before) + kZero * std::abs(start);
    if (!std::isfinite(before) || !std::isfinite(now) || std::abs(now - before) <= allowed) return;
    // Two that went up have no result of which one could be worse.
    if (before > start && now > start) return;
    const std::string sentence = NameOf(key) + ": ends at E = " + ShortNumber(now, 7) +
                                 ", before at " + ShortNumber(before, 7);
    (now > before ? report_->regressions : report_->differences).push_back(sentence);
  }

  bool Ran(const std::string& solver) const {
    return std::any_of(pairs_.begin(), pairs_.end(), [&](const auto& entry) {
      return entry.first[1] == solver && entry.second.before->ran && entry.second.now->ran;
    });
  }

  /// Logarithms of now over before, of the pairs that can be compared by this.
  std::vector<double> LogRatios(const std::string& solver, CostMeasure measure) const {
    std::vector<double> logs;
    for (const auto& [key, pair] : pairs_) {
      if (solver != "all" && key[1] != solver) continue;
      const double ratio =
          measure == CostMeasure::kEnergyInTime ? EnergyRatio(pair) : CostRatio(pair, measure);
      if (std::isfinite(ratio) && ratio > 0.0) logs.push_back(std::log(ratio));
    }
    return logs;
  }

  /// NaN where no end of the two was set by time.
  static double EnergyRatio(const Pair& pair) {
    if (!EndsInTime(*pair.before) && !EndsInTime(*pair.now)) return std::nan("");
    return NumberAt(*pair.now->first, "energy") / NumberAt(*pair.before->first, "energy");
  }

  /// Of whole runs that reach what is asked both times; of others to the strictest gap in their own
  /// basin that both reach; NaN where there is none.
  double CostRatio(const Pair& pair, CostMeasure measure) const {
    const bool of_time = measure == CostMeasure::kSeconds;
    if (Reached(*pair.before) && Reached(*pair.now)) {
      return of_time ? Median(pair.now->seconds) / Median(pair.before->seconds) / machine_ratio_
                     : Evaluations(*pair.now) / Evaluations(*pair.before);
    }
    const auto place =
        static_cast<std::size_t>(of_time ? BenchCost::kSeconds : BenchCost::kEvaluations);
    for (const auto& [gap, t] : targets_) {
      const double before = pair.before->to_own_target[t][place];
      const double now = pair.now->to_own_target[t][place];
      if (std::isfinite(before) && std::isfinite(now)) {
        return now / before / (of_time ? machine_ratio_ : 1.0);
      }
    }
    return std::nan("");
  }

  const RegressionRule& rule_;
  RegressionReport* report_;
  std::map<RunKey, Pair> pairs_;
  std::vector<std::pair<double, std::size_t>> targets_;  // gap and place
  double machine_ratio_ = 1.0;  // seconds of the same work, now over before
};

void CompareBuilds(const BenchData& before, const BenchData& now, RegressionReport* report) {
  for (const char* key : {"suite_hash", "version", "commit", "compiler", "flags"}) {
    const std::string old_text = TextAt(before.manifest, key);
    const std::string new_text = TextAt(now.manifest, key);
    if (old_text == new_text) continue;
    report->differences.push_back(std::string(key) + ": " + old_text + " before, " + new_text +
                                  " now");
  }
  const auto Processor = [](const BenchData& data) {
    const auto found = data.manifest.find("sessions");
    const bool has_any = found != data.manifest.end() && found->is_array() && !found->empty();
    return has_any ? TextAt(found->back(), "processor") : std::string("unknown");
  };
  if (Processor(before) == Processor(now)) return;
  report->differences.push_back("processor: " + Processor(before) + " before, " + Processor(now) +
                                " now: their seconds tell nothing about the program");
}

}  // namespace

RegressionReport FindRegressions(const BenchData& before_data, const BenchResults& before,
                                 const BenchData& now_data, const BenchResults& now,
                                 const RegressionRule& rule) {
  RegressionReport report;
  CompareBuilds(before_data, now_data, &report);
  Finder finder(rule, &report);
  finder.Match(before, now);
  finder.CompareEnds();
  finder.CompareCosts();
  return report;
}

std::vector<double> HolmCorrected(const std::vector<double>& p_values) {
  std::vector<std::size_t> order(p_values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&p_values](std::size_t a, std::size_t b) { return p_values[a] < p_values[b]; });
  std::vector<double> corrected(p_values.size());
  double largest = 0.0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto left = static_cast<double>(order.size() - k);
    largest = std::max(largest, std::min(1.0, left * p_values[order[k]]));
    corrected[order[k]] = largest;
  }
  return corrected;
}

}  // namespace batten
