#ifndef BATTEN_EXPERIMENTS_CURVATURE_READER_H_
#define BATTEN_EXPERIMENTS_CURVATURE_READER_H_

#include <vector>

#include "splines/bspline_curve.h"

namespace batten {

/// Curvature along a curve. In the plane kappa has a sign, positive where the curve turns left; in
/// space it is at least 0.
struct CurvatureSample {
  double t = 0.0;
  double s = 0.0;  ///< Arc length from the begin.
  /// In 1 / the unit of the data; 0 where it is no more than rounding, not a number where C' is.
  double kappa = 0.0;
  /// By how much roundings may have moved kappa: those of the control points, which are worth a few
  /// of the last digits of the largest of them, of C' and of C''. Infinite where C' is rounding.
  double noise = 0.0;
  double point[kMaxDimension] = {0.0, 0.0, 0.0, 0.0};
  /// Unit, to where the curve bends; zeros where kappa is 0 or not a number.
  double normal[kMaxDimension] = {0.0, 0.0, 0.0, 0.0};
};

/// Reads curvature and how much of it may be rounding. A basis function has some 2 p roundings, the
/// product and the sum p + 1: fewer than 4 (p + 1), of the largest control point, for each
/// coordinate; the solution that control points come from is granted as many.
class CurvatureReader {
 public:
  explicit CurvatureReader(const BsplineCurve& curve);  ///< Keeps a reference to `curve`.

  /// By the polynomials of one span, also at its right end.
  CurvatureSample Read(int span, double t, double* speed) const;
  /// Where |C'| is least inside the span: there the curve may bend sharply.
  std::vector<double> SlowPlaces(int span) const;
  /// Over how much of t |C'| there grows by itself.
  double WidthAt(int span, double t) const;
  /// Both ends of the span, its slow places, and places graded towards each of these, by factors of
  /// 2 from the width there on, in order: between two of them |C'| and the curvature change gently.
  std::vector<double> GentleBreaks(int span) const;

 private:
  static constexpr int kMostDerivatives = 2;
  /// C, C', C'' and by how much the lengths of these may be off.
  struct SpanValues {
    double c[kMostDerivatives + 1][kMaxDimension] = {};
    double error[kMostDerivatives + 1] = {};
  };
  SpanValues Evaluate(int span, double t) const;
  /// Half of the derivative of |C'|^2.
  double SpeedSlope(int span, double t) const;

  const BsplineCurve& curve_;
  double rounding_;
};

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_CURVATURE_READER_H_
