#ifndef BATTEN_SPLINES_CLOSEST_POINT_H_
#define BATTEN_SPLINES_CLOSEST_POINT_H_

#include <vector>

#include "splines/bspline_curve.h"
#include "splines/curve_distance.h"
#include "splines/distance_piece.h"

namespace batten {

struct FootPoint {
  double parameter = 0.0;
  double squared_distance = 0.0;
  /// No point of the curve is nearer: proven by bounds on every stretch, to rounding.
  double lower_bound = 0.0;
  /// If asked for: another point, farther along the curve than 1e-6 of its domain, is as near,
  /// within the tolerance; `other` is its parameter.
  bool tie = false;
  double other = 0.0;
  int num_pieces = 0;  ///< Stretches that had to be looked at: the work.
};

/// Closest points on one curve: a global search that cannot miss the nearest stretch. A tree of
/// boxes around Bezier points excludes what is too far; of the rest, stretches are halved until
/// their squared distance is seen to be monotone or convex (DistancePiece), or to be no more than
/// the tolerance below the best. In a convex stretch the foot is found by the second-order step of
/// Hu & Wallner, "A second order algorithm for orthogonal projection onto curves and surfaces",
/// CAGD 22, 2005, safeguarded by a bracket and bisection.
class ClosestPoint {
 public:
  /// Of the larger of the curve's size and the distance.
  static constexpr double kTolerance = 1e-12;

  explicit ClosestPoint(const BsplineCurve& curve);  ///< Keeps a reference to `curve`.
  /// What a certificate leaves open for a point at `distance`: kTolerance, or what the coordinates'
  /// own rounding makes of it on curves far from the origin.
  double Tolerance(double distance) const;
  /// `point` has d coordinates. `start` (a parameter in the domain) competes with all stretches, so
  /// that the result is never farther than C(start), to rounding, and equally far feet do not take
  /// turns; the nearer it is, the less is searched. A point or curve that is not finite gives some
  /// parameter and a distance that is not finite.
  FootPoint Find(const double* point, double start, bool look_for_tie = false) const;
  /// What Find gives for all rows of `points`, each started from its entry of `starts`. `threads`
  /// >= 1 share the rows in ranges: the bits do not depend on their number.
  std::vector<FootPoint> FindAll(const Points& points, int threads, const Eigen::VectorXd& starts,
                                 bool look_for_ties) const;
  /// Of the same their parameters, which replace the starts, and distances, which may be null.
  void FindAll(const Points& points, int threads, Eigen::VectorXd* parameters,
               Eigen::VectorXd* squared_distances) const;

 private:
  struct Box {
    double low[kMaxDimension];
    double high[kMaxDimension];
  };
  class Search;
  int PieceOf(int span, double t) const;
  double PieceLow(int piece) const;
  double PieceHigh(int piece) const;
  BezierStretch Stretch(int piece) const;
  void MakePieces();
  void BuildBoxes();

  const BsplineCurve& curve_;
  std::vector<int> spans_;        // those not empty
  std::vector<int> span_places_;  // where in spans_, by span less the first one
  std::vector<double> beziers_;   // p + 1 points of d coordinates, kPiecesPerSpan a span
  double size_ = 0.0;             // of the curve: longest side of its box
  double rounding_ = 0.0;         // what a coordinate of a point of the curve is off at most
  // levels_[0]: boxes of pieces; each next: of pairs.
  std::vector<std::vector<Box>> levels_;
};

}  // namespace batten

#endif  // BATTEN_SPLINES_CLOSEST_POINT_H_
