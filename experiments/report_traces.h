#ifndef BATTEN_EXPERIMENTS_REPORT_TRACES_H_
#define BATTEN_EXPERIMENTS_REPORT_TRACES_H_

#include <string>
#include <string_view>
#include <vector>

#include "experiments/report_cells.h"

namespace batten {

/// A trace as far as the page shows it; NaN: not there.
struct ReportTrace {
  struct Row {
    double iteration, evaluations, seconds, cpu_seconds, energy, gradient_norm;
  };
  std::vector<Row> rows;           ///< Thinned.
  std::size_t num_rows = 0;        ///< In the file.
  std::vector<std::string> terms;  ///< Of the columns energy_TERM.
};

/// The fields of one line of CSV (RFC 4180) that holds no line ends.
std::vector<std::string> CsvFields(std::string_view line);

/// Reads a trace (docs/formats.md) and keeps `most` rows. `evaluations` are the calls of E, of its
/// gradient and of its Jacobian and the products, added. A torn last line is left out with a note.
bool ReadReportTrace(const std::string& path, std::size_t most, ReportTrace* trace,
                     std::vector<std::string>* notes, std::string* error);

/// The targets of the page's profiles: gaps 1e-1, 1e-2, ..., 1e-10 and those of `suite`, from the
/// widest to the narrowest, then 0, the noise floor, if `suite` has it.
std::vector<double> ReportTargets(const std::vector<double>& suite);

/// What a run needs to each target, from all rows of its trace: JSON of four lists (iterations,
/// evaluations, seconds, processor seconds) with one number or null a target. A gap is
/// (E - minimum) / (start - minimum), as some methods have done a step before their first row
/// (`start` NaN: E of that row); the noise floor is reached with E at most `truth`, never where
/// that is NaN.
std::string TargetHits(const std::vector<ReportTrace::Row>& rows,
                       const std::vector<double>& targets, double start, double minimum,
                       double truth);

/// Numbers with 6 digits, NaN as null: enough for a plot.
std::string PlotNumber(double value);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_REPORT_TRACES_H_
