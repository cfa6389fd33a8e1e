#ifndef BATTEN_EXPERIMENTS_REPORT_GROUPS_H_
#define BATTEN_EXPERIMENTS_REPORT_GROUPS_H_

#include <cmath>
#include <limits>
#include <vector>

#include "experiments/report_bench.h"
#include "experiments/report_cells.h"
#include "experiments/report_traces.h"

namespace batten {

/// An instance that rows belong to, with the E that its runs are held against.
struct ReportGroup {
  OrderedJson names;                    ///< problem, terms, seeds of data and start
  double direct = HUGE_VAL;             ///< lowest E* of a direct answer
  double best = HUGE_VAL;               ///< of bench: E of the best basin
  double lowest = HUGE_VAL;             ///< lowest E that a run has seen
  double unit_seconds = std::nan("");   ///< of bench: of one evaluation of E
  double truth = std::nan("");          ///< of bench: E of the truth, the noise floor
  double num_variables = std::nan("");  ///< of bench

  bool is_direct() const { return std::isfinite(direct); }
  bool has_basins() const { return !is_direct() && std::isfinite(best); }
  double minimum() const { return is_direct() ? direct : has_basins() ? best : lowest; }
};

struct ReportGroups {
  std::vector<ReportGroup> list;     ///< In the order of their first cells.
  std::vector<std::size_t> of_cell;  ///< The place in `list` of each cell.
};

/// `traces` has one for each of `cells`.
ReportGroups FindReportGroups(const std::vector<OrderedJson>& cells,
                              const std::vector<ReportTrace>& traces, const BenchFacts& bench);

/// As docs/report.md describes `groups`.
OrderedJson GroupsJson(const ReportGroups& groups);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_REPORT_GROUPS_H_
