#ifndef BATTEN_EXPERIMENTS_CURVE_WINDOW_H_
#define BATTEN_EXPERIMENTS_CURVE_WINDOW_H_

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

#include "experiments/tracked_curve.h"
#include "splines/normal_band.h"

namespace batten {

/// A stretch of a curve that may move while all the rest stays: control points first..last, the
/// knots that change no other part of the curve than theirs do, and the data points followed there.
/// It lowers sum_i (s_i + floor)^(q/2), s_i = (distance / bound)^2, by Levenberg-Marquardt steps in
/// control points and knots, the parameters following as feet: tangent distance minimisation (Wang,
/// Pottmann & Liu, ACM TOG 25, 2006) of a power of the distance, whose minimum for growing q is
/// that of the largest distance.
class CurveWindow {
 public:
  /// Knots first_knot..last_knot are to move (indices of `curve`, which is changed).
  /// `stray`: what is allowed of the curve's own s, below.
  CurveWindow(TrackedCurve* curve, double bound, int first_knot, int last_knot,
              double stray_limit = 1.0);

  /// max s_i over the data points that take part, and of the curve's own over `stray_limit`.
  double LargestRatio() const;
  /// The curve's own s: between neighbouring data points it may leave their chord by the bound and
  /// kBulge of the chord; sampled where their feet are far apart. Without it fewer control points
  /// would do: between the points the curve would shoot away.
  double Stray() const;

  /// Control points alone to the least squares at the parameters as they are, then feet.
  void SolveAtParameters();
  /// Up to `most_steps` steps at power q (even); ends early once all s_i are at most `goal`, or no
  /// step helps. Of many data points few take part: those that are found beyond the goal in the end
  /// join them. True if none is left beyond it.
  bool Lower(int power, int most_steps, double goal);

 private:
  /// A place of the curve and the point of a chord that it is compared with.
  struct Sample {
    double t;
    double target[kMaxDimension];
    double squared_bound;
    double ratio;  // its s
  };
  /// Points far inside the bound keep this much of a weight, so that they go on holding the curve.
  static constexpr double kFloor = 0.05;
  static constexpr int kMaxColumns = kMaxOrder * kMaxDimension + 2 * kMaxDegree;
  struct State {
    std::vector<double> control_points;  // of the window, in its order
    std::vector<double> knots;
    std::vector<double> parameters;
    std::vector<double> squared_distances;
  };
  void CollectPoints();
  void CollectGaps();
  std::vector<Sample> Samples() const;
  void AddSamples(int gap, std::vector<Sample>* samples) const;
  void ChoosePoints();
  bool Descend(int power, int most_steps, double goal);
  /// All other data points to their feet; those with s_i above `limit` take part from now on.
  bool JoinPointsAbove(double limit);
  State Save() const;
  void Restore(const State& state);
  /// Whether control point or knot i moves, and the first unknown of its place in the band: place j
  /// holds control point j and knot j + (p + 1) / 2. Not taken modulo anything where all move.
  bool ColumnOf(int i, int first, int count, int place, int* column) const;
  /// (ratio + kFloor)^(power / 2), power even.
  static double Raised(double ratio, int power);
  double Value(int power) const;
  /// Gradient / q and Hessian / q of the value, Gauss-Newton but for the power.
  void Assemble(int power, bool at_parameters);
  /// `slides`: its parameter is a foot, which follows.
  void AddPoint(double t, const double* q, double squared_bound, int power, bool slides,
                bool moves_knots);
  void AddControlPointColumns(int span, const double* basis);
  void AddKnotColumns(int span, double t, const double* span_knots);
  void AddRow(const double* metric, const double* slope);
  /// The step of every unknown; knots that would come too near to a neighbour are held.
  bool FindStep(double damping, Eigen::VectorXd* step) const;
  bool SolveDamped(double damping, const std::vector<int>& held, Eigen::VectorXd* step) const;
  int KnotUnknown(int knot) const;
  /// How far the k-th knot may go down and up.
  std::pair<double, double> KnotRoom(int k) const;
  void Apply(const Eigen::VectorXd& step);
  void FollowPoints(const std::vector<int>& points, int iterations);

  TrackedCurve* curve_;
  double squared_bound_;
  bool holds_all_ = false;  // every control point, knot and data point of a closed curve
  int first_;               // control points
  int count_;
  int first_knot_;
  int num_knots_;
  double low_ = 0.0;  // parameters of the stretch
  double high_ = 0.0;
  std::vector<int> points_;  // that take part
  std::vector<int> others_;
  std::vector<int> gaps_;  // between data points i and i + 1
  double stray_limit_;
  double mean_span_ = 0.0;
  // Of one data point: unknowns it depends on, and the derivatives of C(t) by them.
  int num_columns_ = 0;
  int columns_[kMaxColumns];
  double entries_[kMaxColumns][kMaxDimension];
  std::optional<NormalBand> hessian_;
  Eigen::VectorXd gradient_;
};

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_CURVE_WINDOW_H_
