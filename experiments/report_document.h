#ifndef BATTEN_EXPERIMENTS_REPORT_DOCUMENT_H_
#define BATTEN_EXPERIMENTS_REPORT_DOCUMENT_H_

#include <string>

namespace batten {

/// A folder of results as the report page reads it: four JSON values, valid UTF-8, described in
/// docs/report.md.
struct ReportDocument {
  std::string summary;  ///< Rows, groups with their E*, tables, pictures, claims, logs, notes.
  std::string traces;   ///< By key: thinned columns of the traces.
  std::string curves;   ///< By key: thinned control points; by problem: spline and data points.
  std::string plots;    ///< By figure: its panels, series thinned.
  int num_cells = 0;
};

/// How much of a folder goes into a page. What is left out is said in the notes.
struct ReportLimits {
  std::size_t rows_per_trace = 64;
  std::size_t iterates_per_run = 40;
  std::size_t curve_numbers = 1'200'000;  ///< Coordinates of iterates, all runs together.
  std::size_t log_bytes = 8 << 10;        ///< The end of each log.
  std::size_t all_log_bytes = 2 << 20;
  std::size_t rows_per_table = 2000;
  std::size_t table_bytes = 4 << 20;     ///< Of all CSV tables that stand in the folder.
  std::size_t picture_bytes = 6 << 20;   ///< Of all SVG files.
  std::size_t points_per_series = 2000;  ///< Of plots; fewer where all have more than the next.
  std::size_t plot_points = 200'000;     ///< Of all plots together.
};

/// Reads what compare, bench and reproduce write. False with one sentence in `error`
/// (`FILE:LINE: found ...; allowed: ...`) for a folder that is not there or holds no results, and
/// for a file that is broken elsewhere than in a torn last line, which is left out with a note.
bool ReadReportDocument(const std::string& folder, const ReportLimits& limits,
                        ReportDocument* document, std::string* error);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_REPORT_DOCUMENT_H_
