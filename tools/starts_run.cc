#include "tools/starts_run.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "cost_functions/options.h"
#include "experiments/atomic_file.h"
#include "experiments/comparison_tables.h"
#include "experiments/short_number.h"
#include "tools/interrupts.h"
#include "tools/output_files.h"
#include "tools/progress.h"

namespace batten {
namespace {

std::string Shown(const std::string& cell) {
  double value = 0.0;
  if (!ParseNumber(cell, &value)) return cell.empty() ? "-" : cell;
  const bool is_count = value == std::floor(value) && std::abs(value) < 1e6;
  return is_count ? cell : ShortNumber(value, 5);
}

/// Columns side by side, numbers short.
std::string Aligned(const CsvTable& table, std::size_t most_rows) {
  std::vector<std::vector<std::string>> rows = {table.columns()};
  for (std::size_t row = 0; row < std::min(table.num_rows(), most_rows); ++row) {
    rows.emplace_back();
    for (const std::string& column : table.columns()) {
      rows.back().push_back(Shown(table.Text(row, column)));
    }
  }
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      std::size_t width = 0;
      for (const auto& other : rows) width = std::max(width, other[c].size());
      text += row[c] + std::string(c + 1 == row.size() ? 0 : width - row[c].size() + 2, ' ');
    }
    text += "\n";
  }
  if (table.num_rows() > most_rows) {
    text += "(and " + std::to_string(table.num_rows() - most_rows) + " more)\n";
  }
  return text;
}

void Append(const CsvTable& rows, CsvTable* table) {
  if (table->columns().empty()) *table = CsvTable(rows.columns());
  for (std::size_t row = 0; row < rows.num_rows(); ++row) {
    std::vector<std::string> cells;
    for (const std::string& column : rows.columns()) cells.push_back(rows.Text(row, column));
    table->AddRow(std::move(cells));
  }
}

}  // namespace

int RunStartComparisons(const std::vector<std::shared_ptr<const Problem>>& problems,
                        const std::vector<std::string>& written, StartComparisonSpec spec,
                        const std::string& folder, bool quiet, CommandOutput* output) {
  if (!folder.empty() &&
      (!CheckName({"out", folder}, &output->error) || !CreateDirectories(folder, &output->error))) {
    return kBadInput;
  }
  const InterruptibleRun interruptible;
  Progress progress(quiet);
  CsvTable solvers, runs;
  FileBatch batch;
  const auto write = [&](const std::string& name, const CsvTable& table) {
    const std::string path = (std::filesystem::path(folder) / name).string();
    return folder.empty() || batch.Write(path, table.ToCsv(), &output->error) != nullptr;
  };
  double done = 0.0;
  for (std::size_t i = 0; i < problems.size(); ++i) {
    const auto& problem = problems[i];
    spec.progress = [&](int k, int total, const std::string& running) {
      progress.Show((done + static_cast<double>(k) / total) / static_cast<double>(problems.size()),
                    problem->name() + ": " + running);
    };
    StartComparison comparison;
    if (!CompareStarts(*problem, spec, &comparison, &output->error)) return kBadInput;
    if (comparison.interrupted) {
      output->error = "interrupted; nothing is written";
      return kInterruptedStatus;
    }
    done += 1.0;
    Append(comparison.solvers, &solvers);
    Append(comparison.runs, &runs);
    constexpr std::size_t kMostBasins = 12;
    output->results += Aligned(comparison.solvers, comparison.solvers.num_rows()) + "\n" +
                       Aligned(comparison.basins, kMostBasins) + "\n";
    // Of the best basin, if any run has ended.
    const std::string beside =
        comparison.basins.num_rows() == 0
            ? ""
            : BesideBestKnown(written[i], comparison.basins.Number(0, "energy_at_foot_points"));
    if (!beside.empty()) output->results += beside + "\n\n";
    if (!write("starts_basins_" + problem->name() + ".csv", comparison.basins)) return kBadInput;
  }
  output->results +=
      "From " + std::to_string(spec.starts) +
      " disturbed circles. Ends are polished by newton where it takes the problem; ends that are "
      "one curve, to 1e-6 of the size, share a basin, numbered by energy at foot points, with "
      "fixed parameters by energy. "
      "best_found: runs that end in basin "
      "1; median_length: of the curves at the ends, in the unit of the data (basin 1's is in the "
      "table of basins); loop_share: share of ends whose curve has a loop that no data point is "
      "nearest to.\n";
  if (!write("starts_solvers.csv", solvers) || !write("starts_runs.csv", runs)) return kBadInput;
  return batch.Commit(&output->error) ? kDone : kBadInput;
}

}  // namespace batten
