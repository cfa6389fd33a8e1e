#include "experiments/curve_shape.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "experiments/curve_panels.h"
#include "experiments/nearest_point.h"

namespace batten {
namespace {

/// Adds up by how much a tangent turns from one place to the next.
class Turning {
 public:
  explicit Turning(int dimension) : dimension_(dimension) {}

  void MoveTo(const double* tangent) {
    if (has_last_) {
      const double angle = AngleBetween(last_, tangent, dimension_);
      total_ += angle;
      const double cross = last_[0] * tangent[1] - last_[1] * tangent[0];
      signed_ += cross < 0.0 ? -angle : angle;
    } else {
      std::copy_n(tangent, dimension_, first_);
    }
    std::copy_n(tangent, dimension_, last_);
    has_last_ = true;
  }
  /// Back to the first tangent, as closed curves do.
  void Close() {
    if (has_last_) MoveTo(first_);
  }

  double total() const { return total_; }
  double rotation() const {
    return dimension_ == 2 ? signed_ / (2.0 * M_PI) : std::numeric_limits<double>::quiet_NaN();
  }

 private:
  int dimension_;
  bool has_last_ = false;
  double first_[kMaxDimension];
  double last_[kMaxDimension];
  double total_ = 0.0;
  double signed_ = 0.0;
};

void MeasureTurning(const BsplineCurve& curve, const CurvePanels& panels, CurveShape* shape) {
  Turning turning(curve.dimension());
  double tangent[kMaxDimension];
  for (const CurvePanels::Panel& panel : panels.panels()) {
    const double middle = panel.begin + 0.5 * (panel.end - panel.begin);
    for (const double t : {panel.begin, middle, panel.end}) {
      if (panels.Tangent(panel, t, tangent)) turning.MoveTo(tangent);
    }
  }
  if (curve.basis().periodic()) turning.Close();
  shape->turning = turning.total();
  shape->rotation = turning.rotation();
}

/// The distance f from the data along a stretch of a curve changes by no more than its length:
/// between the ends f is at most bound = (f(begin) + f(end) + length) / 2.
struct DistanceStretch {
  int span = 0;
  double length = 0.0;
  double begin = 0.0;
  double end = 0.0;
  double at_begin = 0.0;
  double at_end = 0.0;

  double bound() const { return 0.5 * (at_begin + at_end + length); }
  bool operator<(const DistanceStretch& other) const { return bound() < other.bound(); }
};

/// Stretches are halved, the one with the highest bound first, until no bound is above what was
/// found.
double MaxDistanceToData(const CurvePanels& panels, const Points& data) {
  const NearestPoint nearest(data);
  NearestPoint::Found found;
  double largest = 0.0;
  const auto distance = [&](int span, double t) {
    double point[kMaxDimension];
    panels.Evaluate(span, t, 0, point);
    found = nearest.Find(point, found.point);
    const double here = std::sqrt(found.squared_distance);
    largest = std::max(largest, here);
    return here;
  };
  std::priority_queue<DistanceStretch> stretches;
  double last = distance(panels.panels().front().span, panels.panels().front().begin);
  for (const CurvePanels::Panel& panel : panels.panels()) {
    const double next = distance(panel.span, panel.end);
    stretches.push({panel.span, panel.length, panel.begin, panel.end, last, next});
    last = next;
  }
  constexpr double kRelative = 1e-3;
  constexpr double kOfLength = 1e-5;
  while (!stretches.empty()) {
    const DistanceStretch stretch = stretches.top();
    const double tolerance = std::max(kRelative * largest, kOfLength * panels.length());
    if (!(stretch.bound() > largest + tolerance)) break;
    stretches.pop();
    const double middle = stretch.begin + 0.5 * (stretch.end - stretch.begin);
    if (!(stretch.begin < middle && middle < stretch.end)) continue;
    DistanceStretch half = stretch;
    half.end = middle;
    half.length = panels.Length(stretch.span, stretch.begin, middle);
    half.at_end = distance(stretch.span, middle);
    stretches.push(half);
    half.begin = middle;
    half.at_begin = half.at_end;
    half.end = stretch.end;
    half.length = panels.Length(stretch.span, middle, stretch.end);
    half.at_end = stretch.at_end;
    stretches.push(half);
  }
  return largest;
}

/// A stretch of the curve with no foot between its ends.
struct FreeArc {
  double length = 0.0;
  double straight = 0.0;  // between its ends
  bool between_feet = true;
};

std::vector<FreeArc> FreeArcs(const BsplineCurve& curve, const CurvePanels& panels,
                              const Eigen::VectorXd& feet) {
  // Feet nearer than this along the curve are one; so are all feet of a curve that is a point but
  // for roundings of its coordinates.
  constexpr double kRoundings = 64.0 * std::numeric_limits<double>::epsilon();
  const double same =
      std::max(1e-9 * panels.length(), kRoundings * curve.control_points().cwiseAbs().maxCoeff());
  std::vector<double> parameters(feet.data(), feet.data() + feet.size());
  std::sort(parameters.begin(), parameters.end());
  const BsplineBasis& basis = curve.basis();
  std::vector<FreeArc> arcs;
  const auto add = [&](double from, double to, double length, bool between_feet) {
    if (!(length > same)) return;
    double ends[2][kMaxDimension];
    curve.Evaluate(from, 0, ends[0]);
    curve.Evaluate(to, 0, ends[1]);
    double squared = 0.0;
    for (int c = 0; c < curve.dimension(); ++c) {
      squared += (ends[0][c] - ends[1][c]) * (ends[0][c] - ends[1][c]);
    }
    arcs.push_back({length, std::sqrt(squared), between_feet});
  };
  const double first = panels.LengthUpTo(parameters.front());
  double last = first;
  for (std::size_t k = 1; k < parameters.size(); ++k) {
    const double here = panels.LengthUpTo(parameters[k]);
    add(parameters[k - 1], parameters[k], here - last, true);
    last = here;
  }
  if (basis.periodic()) {
    add(parameters.back(), parameters.front(), first + panels.length() - last, true);
  } else {
    add(basis.domain_begin(), parameters.front(), first, false);
    add(parameters.back(), basis.domain_end(), panels.length() - last, false);
  }
  return arcs;
}

void MeasureFreeArcs(const std::vector<FreeArc>& arcs, const Points& data, CurveShape* shape) {
  constexpr double kUsual = 4.0;
  constexpr double kStraight = 3.0;
  constexpr double kDiagonals = 4.0;
  const double far =
      kDiagonals * (data.colwise().maxCoeff() - data.colwise().minCoeff()).stableNorm();
  std::vector<double> between_feet;
  for (const FreeArc& arc : arcs) {
    shape->longest_free_arc = std::max(shape->longest_free_arc, arc.length);
    if (arc.between_feet) between_feet.push_back(arc.length);
  }
  // One length says nothing about what is usual; of an even number the smaller one in the middle.
  double usual = 0.0;
  if (between_feet.size() > 1) {
    const auto middle =
        between_feet.begin() + static_cast<std::ptrdiff_t>((between_feet.size() - 1) / 2);
    std::nth_element(between_feet.begin(), middle, between_feet.end());
    usual = *middle;
  }
  for (const FreeArc& arc : arcs) {
    const bool is_loop = arc.length > std::max(kUsual * usual, kStraight * arc.straight);
    const bool runs_away = far > 0.0 && arc.length > far;
    if (is_loop || runs_away) ++shape->num_free_loops;
  }
}

}  // namespace

CurveShape MeasureShape(const BsplineCurve& curve, const Points& data,
                        const Eigen::VectorXd& feet) {
  CHECK_GE(curve.dimension(), 2);
  CHECK_EQ(data.rows(), feet.size());
  CHECK_GE(feet.size(), 1);
  const CurvePanels panels(curve);
  CurveShape shape;
  shape.length = panels.length();
  MeasureTurning(curve, panels, &shape);
  shape.max_distance_to_data = MaxDistanceToData(panels, data);
  MeasureFreeArcs(FreeArcs(curve, panels, feet), data, &shape);
  return shape;
}

}  // namespace batten
