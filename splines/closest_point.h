#ifndef BATTEN_SPLINES_CLOSEST_POINT_H_
#define BATTEN_SPLINES_CLOSEST_POINT_H_

#include <vector>

#include "splines/bspline_curve.h"

namespace batten {

struct FootPoint {
  double parameter = 0.0;
  double squared_distance = 0.0;
};

/// Closest points on one curve: the nearest of evenly spread samples (8 per span and degree), found
/// through a tree of bounding boxes over runs of samples, then Newton's method on
/// (C(t) - Q) . C'(t) = 0 (Piegl & Tiller, sec. 6.1), safeguarded: it stays between the samples'
/// neighbours, and after a step that raises the distance comes a bisection. A foot that lies
/// between samples of a narrow detail can be missed: this one is for reports, not certified.
class ClosestPoint {
 public:
  explicit ClosestPoint(const BsplineCurve& curve);  ///< Keeps a reference to `curve`.
  /// `point` has d coordinates. `start` (a parameter in the domain) competes with the samples'
  /// best, so that the result is never farther than C(start), to rounding. A point or curve that is
  /// not finite gives some parameter and a distance that is not finite.
  FootPoint Find(const double* point, double start) const;

 private:
  struct Box {
    double low[kMaxDimension];
    double high[kMaxDimension];
  };
  int NearestSample(const double* point) const;
  FootPoint Refine(const double* point, double low, double start, double high) const;
  double SquaredDistance(const double* point, double t) const;

  const BsplineCurve& curve_;
  std::vector<double> sample_parameters_;
  Points samples_;
  // levels_[0]: boxes of runs of samples; each next: of pairs.
  std::vector<std::vector<Box>> levels_;
};

}  // namespace batten

#endif  // BATTEN_SPLINES_CLOSEST_POINT_H_
