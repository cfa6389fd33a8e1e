#include "experiments/bench_notes.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "cost_functions/options.h"
#include "experiments/bench_targets.h"
#include "solvers/run_context.h"

namespace batten {
namespace {

std::string PlaceOf(const BenchResults& results, const BenchRun& run) {
  return results.instances[run.instance].label + ": " + results.solvers[run.solver];
}

bool ProcessFailed(const nlohmann::json& row) {
  const std::string stop = TextAt(row, "stop");
  return stop == "crashed" || stop == "out_of_memory" || stop == "wall_limit" ||
         stop == "cpu_limit";
}

/// What is looked for in one repetition only.
std::vector<std::string> PluginFaults(const nlohmann::json& row) {
  std::vector<std::string> faults;
  if (HasFinding(row, "wrong_gradient")) {
    std::string terms;
    for (const std::string& term : TextsAt(row, "wrong_gradients")) {
      terms += (terms.empty() ? "" : ", ") + term;
    }
    faults.push_back("wrong gradient: that of " + terms + " is not the one of its E");
  }
  if (HasFinding(row, "reads_past_x")) {
    faults.emplace_back("reads past x: what stands behind its end changes the iterates");
  }
  const double calls = NumberAt(row, "calls_past_early_stop");
  if (!std::isnan(calls)) {
    faults.push_back("ignores stop: " + NumberText(calls) +
                     " calls after it was told at its first iterate or fourth evaluation");
  }
  return faults;
}

/// What one row has to say against its solver.
std::vector<std::string> Complaints(const nlohmann::json& row) {
  const auto Has = [&row](const char* flag) { return HasFinding(row, flag); };
  const std::string stop = TextAt(row, "stop");
  if (ProcessFailed(row)) return {stop + ": " + TextAt(row, "message")};
  std::vector<std::string> complaints;
  if (Has("other_options")) {
    complaints.push_back("other options ran: " + TextAt(row, "other_options"));
  }
  if (!TextAt(row, "disagreement").empty()) {
    complaints.push_back(TextAt(row, "disagreement"));
  } else if (!TextAt(row, "failure").empty()) {
    complaints.push_back("claim fails: " + TextAt(row, "failure"));
  } else if (Has("claim_fails")) {
    complaints.push_back("claim fails: it says " + stop + ", and |g| at its end is " +
                         NumberText(NumberAt(row, "gradient_norm")));
  }
  if (Has("ignores_stop") && std::isnan(NumberAt(row, "calls_past_early_stop"))) {
    complaints.push_back("ignores stop: " + NumberText(NumberAt(row, "calls_past_stop")) +
                         " calls after it was told");
  }
  if (Has("no_finite_end")) {
    complaints.push_back("its end is no finite number: " + stop);
  } else if (stop == "numerical_failure" || stop == "diverged" || stop == "infeasible") {
    const std::string message = TextAt(row, "message");
    complaints.push_back(stop + (message.empty() ? "" : ": " + message));
  }
  return complaints;
}

/// Each once, with the log of its first repetition, and in how many of several it was so.
void NoteComplaints(const BenchRun& run, BenchResults* results) {
  std::vector<std::string> order;
  std::map<std::string, std::pair<std::size_t, std::string>> said;  // times, log
  for (const nlohmann::json* row : run.rows) {
    for (const std::string& fault : PluginFaults(*row)) {
      results->notes.push_back(PlaceOf(*results, run) + ": " + fault);
    }
    for (const std::string& complaint : Complaints(*row)) {
      auto& [times, log] = said[complaint];
      if (times++ > 0) continue;
      order.push_back(complaint);
      if (ProcessFailed(*row)) log = TextAt(*row, "log");
    }
  }
  for (const std::string& complaint : order) {
    const auto& [times, log] = said[complaint];
    std::string note = PlaceOf(*results, run) + ": " + complaint;
    if (times < run.rows.size()) {
      note += ", in " + std::to_string(times) + " of " + std::to_string(run.rows.size()) +
              " repetitions";
    }
    results->notes.push_back(note + (log.empty() ? "" : " (" + log + ")"));
  }
}

void NoteRuns(BenchResults* results) {
  for (const BenchRun& run : results->runs) {
    NoteComplaints(run, results);
    for (const nlohmann::json* row : run.rows) {
      const bool belied = HasFinding(*row, "claim_fails") || HasFinding(*row, "other_options") ||
                          HasFinding(*row, "wrong_gradient") || HasFinding(*row, "reads_past_x");
      if (belied || !TextAt(*row, "disagreement").empty()) results->some_claim_failed = true;
      StopReason reason = StopReason::kNotRun;
      const std::string stop = TextAt(*row, "stop");
      const bool reached = FromString(stop, &reason) && IsSuccess(reason);
      if (!reached && stop != "skipped") results->some_failed = true;
    }
    if (run.repetitions_differ) {
      const auto cut =
          std::count_if(run.rows.begin(), run.rows.end(), [](const nlohmann::json* row) {
            return TextAt(*row, "stop") == ToString(StopReason::kTimeLimit);
          });
      const std::string by_time = cut == 0 ? ""
                                           : ", as the time limit ended " + std::to_string(cut) +
                                                 " of " + std::to_string(run.rows.size());
      results->notes.push_back(PlaceOf(*results, run) +
                               ": its repetitions differ in more than time" + by_time);
    }
  }
}

/// Solvers whose evaluations are the same, point by point, wherever both ran.
bool IsCut(const BenchRun& run) {
  const std::string stop = TextAt(*run.first, "stop");
  return stop == "time_limit" || stop == "iteration_limit";
}

/// One evaluated at the points of the other; where a limit cut the shorter one, up to the last of
/// 4, 8, 16, ... points that both have.
bool HaveOneStream(const BenchRun& first, const BenchRun& second) {
  const bool equal = TextAt(*first.first, "stream") == TextAt(*second.first, "stream");
  if (equal || !(IsCut(first) || IsCut(second))) return equal;
  const std::vector<std::string> a = TextsAt(*first.first, "stream_prefixes");
  const std::vector<std::string> b = TextsAt(*second.first, "stream_prefixes");
  const std::size_t common = std::min(a.size(), b.size());
  // What ended by itself is to be the longer one.
  const double of_first = NumberAt(*first.first, "stream_points");
  const double of_second = NumberAt(*second.first, "stream_points");
  if (!IsCut(of_first <= of_second ? first : second)) return false;
  return common > 0 && a[common - 1] == b[common - 1];
}

void NoteTwins(BenchResults* results) {
  constexpr double kFewestPoints = 3.0;  // less is a start and an answer
  using Streams = std::map<std::pair<std::size_t, int>, const BenchRun*>;
  std::map<std::size_t, Streams> streams;  // by solver
  for (const BenchRun& run : results->runs) {
    if (!run.ran || !(NumberAt(*run.first, "stream_points") >= kFewestPoints)) continue;
    streams[run.solver][{run.instance, run.solver_seed}] = &run;
  }
  for (auto first = streams.begin(); first != streams.end(); ++first) {
    for (auto second = std::next(first); second != streams.end(); ++second) {
      int common = 0, equal = 0;
      for (const auto& [place, run] : first->second) {
        const auto other = second->second.find(place);
        if (other == second->second.end()) continue;
        ++common;
        equal += HaveOneStream(*run, *other->second) ? 1 : 0;
      }
      if (common == 0 || equal < common) continue;
      results->notes.push_back(results->solvers[first->first] + " and " +
                               results->solvers[second->first] +
                               " evaluate at the same points on all " + std::to_string(common) +
                               " instances: here they are one method");
    }
  }
}

void NoteTargets(BenchResults* results) {
  for (const BenchTarget& target : results->targets) {
    if (target.gap == 0.0) continue;
    int without = 0;
    for (const BenchInstance& instance : results->instances) {
      without += std::isnan(TargetEnergy(instance, target, instance.minimum_energy)) ? 1 : 0;
    }
    if (without == 0) continue;
    results->notes.push_back(target.label + ": left out on " + std::to_string(without) + " of " +
                             std::to_string(results->instances.size()) +
                             " instances, where no minimum is known, the start is one, or the gap "
                             "is within the rounding of E");
  }
}

}  // namespace

void AddNotes(BenchResults* results) {
  if (results->num_finished < results->num_cells) {
    results->notes.push_back(
        std::to_string(results->num_cells - results->num_finished) + " of " +
        std::to_string(results->num_cells) + " cells are not finished" +
        (results->part.empty()
             ? ""
             : "; this is part " + results->part + " alone, whose table is made by batten merge"));
  }
  if (results->overlapped) {
    results->notes.emplace_back(
        "cells that ran beside others (--jobs, or another bench on the machine) are left out of "
        "everything that is time");
  }
  NoteRuns(results);
  NoteTwins(results);
  NoteTargets(results);
}

}  // namespace batten
