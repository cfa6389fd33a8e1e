#include "experiments/bench_tables.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "cost_functions/options.h"
#include "experiments/bench_kinds.h"
#include "experiments/comparison.h"
#include "experiments/short_number.h"
#include "experiments/table_text.h"

namespace batten {
namespace {

constexpr double kCharge = 10.0;

std::string WithoutCommas(std::string text) {
  std::replace_if(
      text.begin(), text.end(),
      [](unsigned char c) { return c == ',' || c == '"' || c == '\n' || c == '\r'; }, ';');
  return text;
}

double SumOfCalls(const nlohmann::json& row) {
  double sum = 0.0;
  for (const char* key : {"energy_calls", "gradient_calls", "jacobian_calls", "products"}) {
    sum += NumberAt(row, key);
  }
  return sum;
}

std::string Verified(const nlohmann::json& row) {
  const auto found = row.find("verified");
  if (found == row.end() || !found->is_boolean()) return "-";
  return found->get<bool>() ? "yes" : "NO";
}

std::string FlagsText(const nlohmann::json& row) {
  std::string text;
  for (const std::string& flag : TextsAt(row, "findings")) text += (text.empty() ? "" : " ") + flag;
  return text;
}

/// The seed of the bootstrap, so that a table is made again to the last digit.
constexpr std::uint64_t kBootstrapSeed = 1;

double Shift(BenchCost cost) { return cost == BenchCost::kSeconds ? 1e-3 : 10.0; }

double ChargedMean(const CostTable& costs, std::size_t solver, double shift) {
  std::vector<double> charged;
  for (const std::vector<double>& row : ChargeFailures(costs, kCharge)) {
    if (!std::isnan(row[solver])) charged.push_back(row[solver]);
  }
  return ShiftedGeometricMean(charged, shift);
}

int CountSolved(const CostTable& costs, std::size_t solver) {
  return static_cast<int>(std::count_if(
      costs.begin(), costs.end(),
      [solver](const std::vector<double>& row) { return std::isfinite(row[solver]); }));
}

int CountNotRun(const CostTable& costs, std::size_t solver) {
  return static_cast<int>(
      std::count_if(costs.begin(), costs.end(),
                    [solver](const std::vector<double>& row) { return std::isnan(row[solver]); }));
}

/// What one solver did on the instances of one kind of parameters.
struct KindCounts {
  bool applies = false;  // to one at least
  int best_basin = 0, of_basins = 0;
};

/// `with_target`: the instances that have the target, whose basins count.
KindCounts CountKind(const BenchResults& results, const std::string& kind, std::size_t solver,
                     const std::vector<std::size_t>& with_target) {
  KindCounts counts;
  for (const BenchRun& run : results.runs) {
    const BenchInstance& instance = results.instances[run.instance];
    if (run.solver != solver || instance.kind != kind) continue;
    counts.applies = counts.applies || TextAt(*run.first, "stop") != "skipped";
    const bool has_target =
        std::find(with_target.begin(), with_target.end(), run.instance) != with_target.end();
    if (!instance.has_basins || !has_target) continue;
    ++counts.of_basins;
    counts.best_basin += run.ran && run.basin == 0 ? 1 : 0;
  }
  return counts;
}

/// The rows of CostsOf() that are of one kind; `rows_of` as there.
CostTable RowsOfKind(const BenchResults& results, const CostTable& all,
                     const std::vector<std::size_t>& rows_of, const std::string& kind) {
  CostTable costs;
  for (std::size_t r = 0; r < all.size(); ++r) {
    if (results.instances[rows_of[r]].kind == kind) costs.push_back(all[r]);
  }
  return costs;
}

/// How many instances there are, who needs less on how many of them, and both profiles.
void AddPairCounts(const CostTable& costs, std::vector<std::string>* cells) {
  int less = 0, equal = 0, more = 0, neither = 0;
  for (const std::vector<double>& pair : costs) {
    const bool none = !std::isfinite(pair[0]) && !std::isfinite(pair[1]);
    ++(none ? neither : pair[0] < pair[1] ? less : pair[0] > pair[1] ? more : equal);
  }
  cells->push_back(std::to_string(costs.size()));
  for (const int count : {less, equal, more, neither}) cells->push_back(std::to_string(count));
  const std::vector<Steps> profiles = PairProfiles(costs, 0, 1);
  for (const double ratio : {1.0, 2.0, 10.0}) {
    for (const Steps& profile : profiles) cells->push_back(NumberText(profile.At(ratio)));
  }
}

/// For people: numbers that are not whole to four digits, and seeds that there are.
CsvTable RoundedTable(const CsvTable& table) {
  CsvTable rounded = table;
  for (const std::string& column : table.columns()) {
    if (column != "data_seed" && column != "start_seed") continue;
    for (std::size_t row = 0; row < table.num_rows(); ++row) {
      if (table.Text(row, column) == "0") rounded.Set(row, column, "");
    }
  }
  for (std::size_t row = 0; row < table.num_rows(); ++row) {
    for (const std::string& column : table.columns()) {
      const double value = table.Number(row, column);
      if (!std::isfinite(value) || value == std::floor(value)) continue;
      rounded.Set(row, column, ShortNumber(value, 4));
    }
  }
  return rounded;
}

/// What of a table is set in LaTeX; the CSV file has all of it.
struct LatexPart {
  std::vector<std::string> by;  // a float each
  std::vector<std::string> shown;
};
const LatexPart& RunPart() {
  static const auto& part = *new LatexPart{
      {"problem", "terms", "data_seed", "start_seed"},
      {"solver", "seed", "stop", "verified", "iterations", "evaluations", "energy", "gap",
       "gradient_norm", "basin", "failed", "seconds", "seconds_low", "seconds_high", "work_units"}};
  return part;
}
const LatexPart& SolverPart() {
  static const auto& part =
      *new LatexPart{{"target", "kind"},
                     {"solver", "instances", "not_run", "solved", "best_basin", "of_basins",
                      "evaluations", "work_units", "seconds"}};
  return part;
}
const LatexPart& PairPart() {
  static const auto& part = *new LatexPart{{"target", "kind", "cost"},
                                           {"first", "second", "instances", "first_less", "equal",
                                            "second_less", "neither", "first_at_2", "second_at_2"}};
  return part;
}

bool Write(const CsvTable& table, const LatexPart& part, const std::string& stem,
           const std::string& caption, FileBatch* batch, std::string* error) {
  const CsvTable rounded = RoundedTable(table);
  return batch->Write(stem + ".csv", table.ToCsv(), error) != nullptr &&
         batch->Write(stem + ".md", TableMarkdown(rounded), error) != nullptr &&
         batch->Write(stem + ".tex", TablesLatex(rounded, caption, part.by, part.shown), error) !=
             nullptr;
}

}  // namespace

CsvTable RunTable(const BenchResults& results) {
  CsvTable table({"problem",     "terms",        "data_seed",     "start_seed", "solver",
                  "seed",        "stop",         "verified",      "iterations", "evaluations",
                  "energy",      "gap",          "gradient_norm", "basin",      "rms_orthogonal",
                  "findings",    "message",      "repetitions",   "failed",     "seconds",
                  "seconds_low", "seconds_high", "work_units"});
  for (const BenchRun& run : results.runs) {
    const nlohmann::json& row = *run.first;
    const BenchInstance& instance = results.instances[run.instance];
    MedianWithInterval seconds = BootstrapMedian(run.seconds, kBootstrapSeed);
    // One run says nothing of the next.
    if (run.seconds.size() < 2) seconds.low = seconds.high = std::nan("");
    const double energy = NumberAt(row, "energy");
    const double fall = instance.start_energy - instance.minimum_energy;
    const double gap =
        instance.has_basins ? (energy - instance.minimum_energy) / fall : NumberAt(row, "gap");
    const bool knows_basin = instance.has_basins && run.basin >= 0;
    table.AddRow({WithoutCommas(instance.problem),
                  WithoutCommas(instance.terms),
                  NumberCell(NumberAt(row, "data_seed")),
                  NumberCell(NumberAt(row, "start_seed")),
                  WithoutCommas(results.solvers[run.solver]),
                  std::to_string(run.solver_seed),
                  WithoutCommas(TextAt(row, "stop")),
                  Verified(row),
                  NumberCell(NumberAt(row, "iterations")),
                  NumberCell(SumOfCalls(row)),
                  NumberCell(energy),
                  NumberCell(gap),
                  NumberCell(NumberAt(row, "gradient_norm")),
                  knows_basin ? std::to_string(run.basin + 1) : "",
                  NumberCell(NumberAt(row, "rms_orthogonal")),
                  FlagsText(row),
                  WithoutCommas(TextAt(row, "message")),
                  std::to_string(run.rows.size()),
                  std::to_string(run.num_failed),
                  NumberCell(seconds.median),
                  NumberCell(seconds.low),
                  NumberCell(seconds.high),
                  NumberCell(seconds.median / instance.unit_seconds)});
  }
  return table;
}

CsvTable SolverTable(const BenchResults& results) {
  CsvTable table({"target", "kind", "solver", "instances", "not_run", "solved", "best_basin",
                  "of_basins", "evaluations", "work_units", "seconds"});
  const std::vector<std::string> kinds = ParameterKinds(results);
  for (std::size_t t = 0; t < results.targets.size(); ++t) {
    std::vector<std::size_t> rows_of;
    std::array<CostTable, kBenchCosts.size()> all;
    for (std::size_t k = 0; k < all.size(); ++k) {
      all[k] = CostsOf(results, t, kBenchCosts[k], &rows_of);
    }
    for (const std::string& kind : kinds) {
      std::array<CostTable, kBenchCosts.size()> costs;
      for (std::size_t k = 0; k < costs.size(); ++k) {
        costs[k] = RowsOfKind(results, all[k], rows_of, kind);
      }
      if (costs[0].empty()) continue;
      for (std::size_t s = 0; s < results.solvers.size(); ++s) {
        const KindCounts counts = CountKind(results, kind, s, rows_of);
        if (!counts.applies) continue;
        const bool basins = counts.of_basins > 0;
        std::vector<std::string> cells = {results.targets[t].label,
                                          kind,
                                          WithoutCommas(results.solvers[s]),
                                          std::to_string(costs[0].size()),
                                          std::to_string(CountNotRun(costs[0], s)),
                                          std::to_string(CountSolved(costs[0], s)),
                                          basins ? std::to_string(counts.best_basin) : "",
                                          basins ? std::to_string(counts.of_basins) : ""};
        for (std::size_t k = 0; k < costs.size(); ++k) {
          cells.push_back(NumberCell(ChargedMean(costs[k], s, Shift(kBenchCosts[k]))));
        }
        table.AddRow(std::move(cells));
      }
    }
  }
  return table;
}

CsvTable PairTable(const BenchResults& results) {
  CsvTable table({"target", "kind", "cost", "first", "second", "instances", "first_less", "equal",
                  "second_less", "neither", "first_at_1", "second_at_1", "first_at_2",
                  "second_at_2", "first_at_10", "second_at_10"});
  const std::vector<std::string> kinds = ParameterKinds(results);
  std::vector<BenchResults> parts;
  for (const std::string& kind : kinds) parts.push_back(OfKind(results, kind));
  for (std::size_t t = 0; t < results.targets.size(); ++t) {
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      for (const BenchCost cost : kBenchCosts) {
        for (std::size_t a = 0; a < parts[k].solvers.size(); ++a) {
          for (std::size_t b = a + 1; b < parts[k].solvers.size(); ++b) {
            const CostTable costs = PairCosts(parts[k], t, cost, a, b);
            if (costs.empty()) continue;
            std::vector<std::string> cells = {results.targets[t].label, kinds[k], ToString(cost),
                                              WithoutCommas(parts[k].solvers[a]),
                                              WithoutCommas(parts[k].solvers[b])};
            AddPairCounts(costs, &cells);
            table.AddRow(std::move(cells));
          }
        }
      }
    }
  }
  return table;
}

bool WriteBenchTables(const BenchResults& results, const std::string& folder, FileBatch* batch,
                      std::string* error) {
  std::string notes =
      "# " + MarkdownText(results.suite) + "\n\n" + std::to_string(results.num_finished) + " of " +
      std::to_string(results.num_cells) +
      " cells are finished. A solver that does not reach a target, or does not "
      "apply, is charged 10 times the largest cost of its instance in the means of "
      "solvers.md; instances on which nobody reaches it are left out of them. What "
      "was excluded or is not finished is no failure: not_run counts such instances, "
      "which are in no mean or share of that solver. Of repetitions the median "
      "counts, and one that failed is infinity in it. "
      "Evaluations are calls of E, g and J and products; a method that makes none, "
      "as a direct one, counts as one, and searches for feet are not among them. "
      "Solvers that apply to no instance of a kind, or ran on none, have no row "
      "there.\n\n";
  for (const std::string& note : results.notes) notes += "- " + MarkdownText(note) + "\n";
  return Write(RunTable(results), RunPart(), folder + "/table", results.suite + ": all runs", batch,
               error) &&
         Write(SolverTable(results), SolverPart(), folder + "/solvers",
               results.suite + ": by target and solver", batch, error) &&
         Write(PairTable(results), PairPart(), folder + "/pairs",
               results.suite + ": pairs of solvers", batch, error) &&
         batch->Write(folder + "/notes.md", notes, error) != nullptr;
}

}  // namespace batten
