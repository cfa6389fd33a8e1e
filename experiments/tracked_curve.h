#ifndef BATTEN_EXPERIMENTS_TRACKED_CURVE_H_
#define BATTEN_EXPERIMENTS_TRACKED_CURVE_H_

#include <optional>
#include <string>
#include <vector>

#include "splines/bspline_curve.h"

namespace batten {

/// A spline curve whose knots and control points move, and the data points, each followed at a
/// parameter near its foot. Distances at these parameters bound the distances from the curve from
/// above, whether or not a parameter is the nearest foot. Notation of BsplineBasis, but for closed
/// curves knots and control points have any index: U(i + n) = U(i) + period, P(i + n) = P(i).
class TrackedCurve {
 public:
  TrackedCurve(const BsplineCurve& curve, const Points& points, const Eigen::VectorXd& parameters);

  int degree() const { return degree_; }
  bool closed() const { return closed_; }
  int dimension() const { return static_cast<int>(control_points_.cols()); }
  int num_control_points() const { return static_cast<int>(control_points_.rows()); }
  int num_points() const { return static_cast<int>(points_->rows()); }
  double period() const { return period_; }  ///< Of closed curves; else the domain's length.

  double Knot(int i) const {
    if (!closed_) return knots_[static_cast<std::size_t>(i)];
    const int turns = Turns(i);
    return knots_[static_cast<std::size_t>(i - turns * num_control_points())] + turns * period_;
  }
  /// Where knot or control point i of a closed curve is kept, 0..n-1; of an open one i.
  int Index(int i) const { return closed_ ? i - Turns(i) * num_control_points() : i; }
  const double* ControlPoint(int i) const {
    return control_points_.data() + static_cast<std::ptrdiff_t>(Index(i)) * dimension();
  }
  void MoveKnot(int i, double by) { knots_[static_cast<std::size_t>(Index(i))] += by; }
  /// Knot i, 0..n-1, as it is kept.
  void SetKnot(int i, double knot) { knots_[static_cast<std::size_t>(i)] = knot; }
  double* MutableControlPoint(int i) {
    return control_points_.data() + static_cast<std::ptrdiff_t>(Index(i)) * dimension();
  }
  /// Knots that may move or go: the inner ones of an open curve, all of a closed one.
  int first_free_knot() const { return closed_ ? 0 : degree_ + 1; }
  int last_free_knot() const { return num_control_points() - 1; }
  double domain_begin() const { return Knot(degree_); }
  double domain_end() const { return Knot(degree_) + period_; }

  /// Takes knot i and a control point out; the others and all parameters stay what they are.
  void RemoveKnot(int i);

  /// A knot at t, not one of the knots: the curve stays the same.
  void InsertKnot(double t);

  double parameter(int point) const { return parameters_[point]; }
  const Eigen::VectorXd& parameters() const { return parameters_; }
  const double* point(int i) const {
    return points_->data() + static_cast<std::ptrdiff_t>(i) * dimension();
  }
  /// Squared distance at the parameter, as Follow left it.
  double squared_distance(int point) const { return squared_distances_[point]; }
  const Eigen::VectorXd& squared_distances() const { return squared_distances_; }
  void SetFoot(int point, double parameter, double squared_distance) {
    parameters_[point] = parameter;
    squared_distances_[point] = squared_distance;
  }

  /// k with U(k) <= t < U(k + 1), t in the domain's reach: closed curves wrap k with t.
  int SpanOf(double t) const;
  /// The 2p knots U(k - p + 1)..U(k + p) that the basis functions of span k depend on.
  void CopySpanKnots(int span, double* knots) const;
  /// C, C', ..., C^(max_derivative) at t by the polynomial of span k, result[k * d + c].
  void Evaluate(int span, double t, int max_derivative, double* result) const;
  /// Moves the parameter of a data point to the foot by `iterations` safeguarded Newton steps that
  /// never raise its distance, inside [low, high]. The first and the last point of an open curve
  /// stay at its ends.
  void Follow(int point, int iterations, double low, double high);
  void FollowAll(int iterations);

  /// As the library has it; nothing if the knots are no basis.
  std::optional<BsplineCurve> ToCurve() const;
  std::vector<double> AllKnots() const;

 private:
  int Turns(int i) const {
    const int n = num_control_points();
    return i >= 0 ? i / n : -((n - 1 - i) / n);
  }

  int degree_;
  bool closed_;
  double period_;
  std::vector<double> knots_;  // open: n + p + 1; closed: n, U(0)..U(n - 1)
  Points control_points_;
  const Points* points_;
  Eigen::VectorXd parameters_;
  Eigen::VectorXd squared_distances_;
};

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_TRACKED_CURVE_H_
