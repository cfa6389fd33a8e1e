#ifndef BATTEN_SPLINES_CLOSEST_POINT_H_
#define BATTEN_SPLINES_CLOSEST_POINT_H_

#include <vector>

#include "splines/bspline_curve.h"

namespace batten {

struct FootPoint {
  double parameter = 0.0;
  double squared_distance = 0.0;
  int num_pieces = 0;  // in which it was looked for by Newton's method: the work
};

/// Closest points on one curve. Between evenly spread samples (8 per span and degree, step h) the
/// curve stays within e = h^2 max |C''| / 8 of its chords; a tree of bounding boxes over runs of
/// chords finds all pieces that can hold the foot, and in each of them Newton's method solves
/// (C(t) - Q) . C'(t) = 0 (Piegl & Tiller, sec. 6.1), safeguarded: it stays in the piece, and after
/// a step that raises the distance comes a bisection. A piece in which the distance has several
/// minima may give the wrong one, so that the distance is too large by 2 e at most. Where distances
/// cannot be told apart, on a curve that passes through the point or runs as flat as rounding lets
/// it, the search ends: bounds alone would exclude nothing.
class ClosestPoint {
 public:
  explicit ClosestPoint(const BsplineCurve& curve);  ///< Keeps a reference to `curve`.
  /// `point` has d coordinates. `start` (a parameter in the domain) competes with all pieces, so
  /// that the result is never farther than C(start), to rounding, and equally far feet do not take
  /// turns. A point or curve that is not finite gives some parameter and a distance that is not
  /// finite.
  FootPoint Find(const double* point, double start) const;

 private:
  struct Box {
    double low[kMaxDimension];
    double high[kMaxDimension];
  };
  /// A chord's distance less what the curve may be off it, and the parameter of its nearest point.
  struct Piece {
    int index;
    double squared_bound;
    double start;
  };
  void SampleSpans();
  void BuildBoxes();
  Piece MakePiece(const double* point, int index) const;
  bool CanBeNearer(int level, int index, double squared_bound, double squared_distance) const;

  const BsplineCurve& curve_;
  std::vector<int> spans_;          // those not empty
  std::vector<double> deviations_;  // e, one a span
  double size_ = 0.0;               // largest coordinate of a control point
  double rounding_ = 0.0;           // what samples and boxes are off at most
  std::vector<double> sample_parameters_;
  Points samples_;
  // levels_[0]: boxes of runs of pieces; each next: of pairs.
  std::vector<std::vector<Box>> levels_;
};

}  // namespace batten

#endif  // BATTEN_SPLINES_CLOSEST_POINT_H_
