#ifndef BATTEN_COST_FUNCTIONS_FIT_SETTING_H_
#define BATTEN_COST_FUNCTIONS_FIT_SETTING_H_

#include <memory>
#include <vector>

#include "splines/bspline_basis.h"

namespace batten {

/// Places on the curve where a term has a residual block, with the data it compares there, grouped
/// by span. Site s of the order is item order[s] of the arrays (item s if `order` is empty).
struct Sites {
  struct Group {
    int span;
    int begin;  // sites begin..end-1 lie in this span
    int end;
  };
  int size = 0;
  const double* parameters = nullptr;  // in the basis' domain
  const double* points = nullptr;      // size x dimension in user units, or null
  const double* weights = nullptr;     // >= 0, or null: all 1
  /// Points are derivatives or differences, which moving the origin does not change.
  bool points_are_displacements = false;
  std::vector<int> order;
  std::vector<Group> groups;
  std::shared_ptr<const void> storage;  // what the pointers point into, if it is not the caller's

  int item(int site) const { return order.empty() ? site : order[static_cast<std::size_t>(site)]; }
};

/// Sorts items by span. Parameters that do not decrease, which the caller may know already, are
/// only looked at around the knots; others cost one pass where they are in the order of their
/// spans.
void GroupBySpan(const BsplineBasis& basis, bool nondecreasing, Sites* sites);

/// Cuts the groups into parts for RowSource: the first group of each part, and behind the last part
/// the number of groups. A part is long enough to be worth a thread's while, and goes over at least
/// p + 1 spans.
std::vector<int> CutIntoParts(const BsplineBasis& basis, const Sites& sites);

/// What a term is told about the fit: the spline space, the data, and where the control points
/// stand in x. Inside, data are (point - center) * scale.
struct FitSetting {
  const BsplineBasis* basis = nullptr;
  int dimension = 0;
  double center[kMaxDimension] = {0.0, 0.0, 0.0, 0.0};
  double scale = 1.0;            // a power of two
  double size = 1.0;             // longest side of the data's box, scaled: below 4/3
  int control_point_offset = 0;  // P_j stands at x[control_point_offset + j * dimension]
  int parameter_offset = -1;     // t_i stands at x[parameter_offset + i]; -1: they are fixed
  bool keep_order = false;       // free parameters stay in the order of the data points
  bool ends_held = false;        // those of the first and last point at the ends of the domain
  const Sites* data = nullptr;   // the data points at their fixed parameters, or at their start
  /// Factors of fairing terms, one per non-empty span of the domain in their order; null: all 1.
  const std::vector<double>* span_weights = nullptr;
  /// What is taken from coordinate c of a site's point: points move with the origin.
  double Origin(const Sites& sites, int c) const {
    return sites.points_are_displacements ? 0.0 : center[c];
  }
  /// False: loops with run-time sizes also where compiled ones exist (the benchmark shows both).
  bool use_static_sizes = true;
};

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_FIT_SETTING_H_
