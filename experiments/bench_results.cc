#include "experiments/bench_results.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "cost_functions/options.h"
#include "experiments/basins.h"
#include "experiments/bench_notes.h"
#include "experiments/bench_targets.h"
#include "experiments/comparison.h"

namespace batten {
namespace {

std::string InstanceLabel(const nlohmann::json& row) {
  std::string text = TextAt(row, "problem") + " | " + TextAt(row, "terms");
  for (const auto& [key, word] : {std::pair{"data_seed", "data"}, {"start_seed", "start"}}) {
    const double seed = NumberAt(row, key);
    if (seed > 0.0) text += std::string(" | ") + word + " " + NumberText(seed);
  }
  return text;
}

/// The part that all of a folder's sessions ran; empty where it is the whole, or they differ.
std::string PartOf(const nlohmann::json& manifest) {
  std::string part;
  const auto sessions = manifest.find("sessions");
  if (sessions == manifest.end()) return part;
  for (const nlohmann::json& session : *sessions) {
    const std::string here = TextAt(session, "shard");
    if (here == "1/1" || (!part.empty() && here != part)) return "";
    part = here;
  }
  return part;
}

/// Gathers rows to runs, and runs to instances.
class Collector {
 public:
  explicit Collector(const BenchData& data) : data_(data) {}

  BenchResults Collect() {
    results_.suite = TextAt(data_.manifest, "suite");
    results_.num_cells = data_.num_cells;
    results_.num_finished = data_.rows.size();
    results_.part = PartOf(data_.manifest);
    for (const nlohmann::json& row : data_.rows) AddRow(row);
    AddTargets();
    for (std::size_t i = 0; i < results_.instances.size(); ++i) FindMinimum(i);
    for (BenchRun& run : results_.runs) MeasureCosts(&run);
    results_.notes = data_.bad_lines;
    AddNotes(&results_);
    for (std::string& left_out : TextsAt(data_.manifest, "repeated_terms")) {
      results_.notes.push_back(std::move(left_out));
    }
    return std::move(results_);
  }

 private:
  std::size_t SolverIndex(const std::string& solver) {
    auto& all = results_.solvers;
    const auto found = std::find(all.begin(), all.end(), solver);
    if (found != all.end()) return static_cast<std::size_t>(found - all.begin());
    all.push_back(solver);
    return all.size() - 1;
  }

  std::size_t InstanceIndex(const nlohmann::json& row) {
    const std::string label = InstanceLabel(row);
    const auto [place, is_new] = instance_index_.try_emplace(label, results_.instances.size());
    if (!is_new) return place->second;
    BenchInstance instance;
    instance.label = label;
    instance.problem = TextAt(row, "problem");
    instance.terms = TextAt(row, "terms");
    instance.kind = TextAt(row, "parameter_kind");
    const auto found = data_.instances.find(TextAt(row, "instance"));
    const nlohmann::json measured = found == data_.instances.end() ? nullptr : found->second;
    instance.num_variables = NumberAt(measured, "num_variables");
    const bool is_measured = IsMeasured(measured);
    instance.unit_seconds = is_measured ? NumberAt(measured, "evaluation_seconds") : NAN;
    instance.reference_seconds = is_measured ? NumberAt(measured, "reference_seconds") : NAN;
    instance.minimum_energy = NumberAt(measured, "minimum_energy");
    instance.truth_energy = NumberAt(measured, "truth_energy");
    // A truth without noise is a minimum, not a floor.
    if (!(NumberAt(measured, "noise") > 0.0)) instance.truth_energy = NAN;
    instance.has_basins = std::isnan(instance.minimum_energy);
    instance.start_energy = NAN;
    measured_.push_back(measured);
    results_.instances.push_back(std::move(instance));
    return place->second;
  }

  void AddRow(const nlohmann::json& row) {
    const std::size_t instance = InstanceIndex(row);
    const std::size_t solver = SolverIndex(TextAt(row, "solver"));
    const int seed = static_cast<int>(NumberAt(row, "seed"));
    const auto [place, is_new] =
        run_index_.try_emplace({instance, solver, seed}, results_.runs.size());
    if (is_new) {
      BenchRun run;
      run.instance = instance;
      run.solver = solver;
      run.solver_seed = seed;
      run.first = &row;
      results_.runs.push_back(std::move(run));
    }
    BenchRun& run = results_.runs[place->second];
    run.rows.push_back(&row);
    const bool ran = std::isfinite(NumberAt(row, "iterations"));
    run.ran = run.ran || ran;
    if (ran && std::isnan(results_.instances[instance].start_energy)) {
      results_.instances[instance].start_energy = NumberAt(row, "start_energy");
    }
    const bool failed = !ran && TextAt(row, "stop") != "skipped";
    run.num_failed += failed ? 1 : 0;
    if (FlagAt(row, "overlapped")) {
      results_.overlapped = true;
    } else if (ran || failed) {
      run.seconds.push_back(failed ? HUGE_VAL : NumberAt(row, "seconds"));
    }
    for (const char* key : {"energy", "iterations", "energy_calls", "gradient_calls", "stream"}) {
      const bool known = row.contains(key) && run.first->contains(key);
      if (known && row[key] != (*run.first)[key]) run.repetitions_differ = true;
    }
  }

  void AddTargets() {
    for (const double gap : NumbersAt(data_.manifest, "gap_targets")) {
      results_.targets.push_back({"gap " + NumberText(gap), gap});
    }
    const auto& all = results_.instances;
    if (std::any_of(all.begin(), all.end(), [](const BenchInstance& instance) {
          return std::isfinite(instance.truth_energy);
        })) {
      results_.targets.push_back({"noise floor", 0.0});
    }
  }

  /// Basins of the ends on an instance without direct answer.
  void FindMinimum(std::size_t index) {
    BenchInstance& instance = results_.instances[index];
    if (!instance.has_basins) return;
    const nlohmann::json& measured = measured_[index];
    const auto basis =
        BsplineBasis::Make(static_cast<int>(std::max(1.0, NumberAt(measured, "degree"))),
                           FlagAt(measured, "periodic"), NumbersAt(measured, "knots"), nullptr);
    std::vector<BasinEnd> ends;
    std::vector<BenchRun*> runs;
    for (BenchRun& run : results_.runs) {
      if (run.instance != index) continue;
      run.basin = -1;
      BasinEnd end;
      if (!basis.has_value() || !ReadEnd(*run.first, basis->num_control_points(), &end)) continue;
      ends.push_back(std::move(end));
      runs.push_back(&run);
    }
    if (ends.empty()) return;
    const std::vector<int> basins = FindBasins(*basis, NumberAt(measured, "size"), ends);
    const int count = *std::max_element(basins.begin(), basins.end()) + 1;
    instance.basin_energies.assign(static_cast<std::size_t>(count), HUGE_VAL);
    for (std::size_t k = 0; k < ends.size(); ++k) {
      runs[k]->basin = basins[k];
      double& least = instance.basin_energies[static_cast<std::size_t>(basins[k])];
      least = std::min(least, ends[k].energy);
    }
    instance.minimum_energy = instance.basin_energies[0];
  }

  static bool ReadEnd(const nlohmann::json& row, int num_control_points, BasinEnd* end) {
    const std::vector<double> numbers = NumbersAt(row, "polished_control_points");
    const auto n = static_cast<std::size_t>(num_control_points);
    if (numbers.empty() || numbers.size() % n != 0) return false;
    end->energy = NumberAt(row, "polished_energy");
    end->energy_at_foot_points = NumberAt(row, "polished_energy_at_foot_points");
    end->polished = FlagAt(row, "polished");
    end->control_points = Eigen::Map<const Points>(numbers.data(), num_control_points,
                                                   static_cast<Eigen::Index>(numbers.size() / n));
    return std::isfinite(end->energy) && std::isfinite(end->energy_at_foot_points);
  }

  void MeasureCosts(BenchRun* run) {
    const BenchInstance& instance = results_.instances[run->instance];
    std::vector<ShortTrace> traces;
    std::vector<bool> is_timed;
    for (const nlohmann::json* row : run->rows) {
      const bool has_trace = NumberAt(*row, "trace_rows") > 0.0;
      traces.push_back(
          has_trace ? ReadShortTrace(data_.folder + "/traces/" + TextAt(*row, "key") + ".csv")
                    : ShortTrace());
      is_timed.push_back(!FlagAt(*row, "overlapped"));
    }
    const auto& basins = instance.basin_energies;
    const double own = run->basin >= 0 && !basins.empty()
                           ? basins[static_cast<std::size_t>(run->basin)]
                           : instance.minimum_energy;
    for (const BenchTarget& target : results_.targets) {
      const auto Costs = [&](double minimum) {
        return CostsTo(TargetEnergy(instance, target, minimum), traces, is_timed,
                       instance.unit_seconds);
      };
      run->to_target.push_back(Costs(instance.minimum_energy));
      run->to_own_target.push_back(Costs(own));
    }
  }

  const BenchData& data_;
  BenchResults results_;
  std::map<std::string, std::size_t> instance_index_;
  std::map<std::tuple<std::size_t, std::size_t, int>, std::size_t> run_index_;
  std::vector<nlohmann::json> measured_;  // of each instance
};

bool HasTarget(const BenchInstance& instance, const BenchTarget& target) {
  return std::isfinite(TargetEnergy(instance, target, instance.minimum_energy));
}

}  // namespace

const char* ToString(BenchCost cost) {
  switch (cost) {
    case BenchCost::kEvaluations:
      return "evaluations";
    case BenchCost::kWorkUnits:
      return "work_units";
    case BenchCost::kSeconds:
      return "seconds";
  }
  return "";
}

BenchResults CollectResults(const BenchData& data) { return Collector(data).Collect(); }

CostTable CostsOf(const BenchResults& results, std::size_t target, BenchCost cost,
                  std::vector<std::size_t>* rows_of, BenchGoal goal) {
  const std::size_t num_solvers = results.solvers.size();
  std::vector<std::vector<std::vector<double>>> seeds(
      results.instances.size(), std::vector<std::vector<double>>(num_solvers));
  for (const BenchRun& run : results.runs) {
    const auto& costs = goal == BenchGoal::kBestBasin ? run.to_target : run.to_own_target;
    const double value = costs[target][static_cast<std::size_t>(cost)];
    if (!std::isnan(value)) seeds[run.instance][run.solver].push_back(value);
  }
  CostTable costs;
  if (rows_of != nullptr) rows_of->clear();
  for (std::size_t i = 0; i < results.instances.size(); ++i) {
    if (!HasTarget(results.instances[i], results.targets[target])) continue;
    costs.emplace_back();
    for (const std::vector<double>& values : seeds[i]) costs.back().push_back(Median(values));
    if (rows_of != nullptr) rows_of->push_back(i);
  }
  return costs;
}

namespace {

/// Both apply, and where there are several minima both ends are known and share one.
bool CanBeCompared(const BenchResults& results, const BenchRun& first, const BenchRun& second) {
  for (const BenchRun* run : {&first, &second}) {
    if (TextAt(*run->first, "stop") == "skipped") return false;
    if (results.instances[run->instance].has_basins && run->basin < 0) return false;
  }
  return first.basin == second.basin;
}

}  // namespace

CostTable PairCosts(const BenchResults& results, std::size_t target, BenchCost cost,
                    std::size_t first, std::size_t second) {
  using Key = std::pair<std::size_t, int>;  // instance, seed
  std::map<Key, std::array<const BenchRun*, 2>> pairs;
  for (const BenchRun& run : results.runs) {
    if (run.solver == first) pairs[{run.instance, run.solver_seed}][0] = &run;
    if (run.solver == second) pairs[{run.instance, run.solver_seed}][1] = &run;
  }
  CostTable costs;
  for (const auto& [key, pair] : pairs) {
    if (pair[0] == nullptr || pair[1] == nullptr || !CanBeCompared(results, *pair[0], *pair[1])) {
      continue;
    }
    if (!HasTarget(results.instances[key.first], results.targets[target])) continue;
    const auto CostOf = [&](const BenchRun* run) {
      return run->to_own_target[target][static_cast<std::size_t>(cost)];
    };
    if (std::isnan(CostOf(pair[0])) || std::isnan(CostOf(pair[1]))) continue;
    costs.push_back({CostOf(pair[0]), CostOf(pair[1])});
  }
  return costs;
}

}  // namespace batten
