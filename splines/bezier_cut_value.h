#ifndef BATTEN_SPLINES_BEZIER_CUT_VALUE_H_
#define BATTEN_SPLINES_BEZIER_CUT_VALUE_H_

#include <array>
#include <string>

#include "splines/bezier.h"

namespace batten {

/// By what a cut is judged: the sum over both parts (Ma, Lin, Shen 2016, Definitions 2.1 and 2.2).
enum class CutMeasure {
  kFlatness,  ///< Of the squared distances of inner control points from the part's chord.
  kHullArea,  ///< Of the areas of the hulls of the control points; planar curves.
};

const char* ToString(CutMeasure measure);  ///< "flatness", "hull_area".

/// That sum as a function of the cut's place u in [0, 1]; refers to the n + 1 points, d coordinates
/// each, and allocates nothing. A closed part (chord of length zero) counts as in Flatness().
class CutValue {
 public:
  CutValue(CutMeasure measure, int degree, int dimension, const double* points)
      : measure_(measure), degree_(degree), dimension_(dimension), points_(points) {}

  double operator()(double u);
  int num_evaluations() const { return num_evaluations_; }

 private:
  CutMeasure measure_;
  int degree_;
  int dimension_;
  const double* points_;
  int num_evaluations_ = 0;
  std::array<double, (kMaxBezierDegree + 1) * kMaxDimension> first_;
  std::array<double, (kMaxBezierDegree + 1) * kMaxDimension> second_;
};

}  // namespace batten

#endif  // BATTEN_SPLINES_BEZIER_CUT_VALUE_H_
