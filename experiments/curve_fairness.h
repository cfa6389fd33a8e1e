#ifndef BATTEN_EXPERIMENTS_CURVE_FAIRNESS_H_
#define BATTEN_EXPERIMENTS_CURVE_FAIRNESS_H_

#include <vector>

#include "splines/bspline_curve.h"

namespace batten {

/// Curvature along a curve. In the plane kappa has a sign, positive where the curve turns left; in
/// space it is at least 0.
struct CurvatureSample {
  double t = 0.0;
  double s = 0.0;      ///< Arc length from the begin.
  double kappa = 0.0;  ///< In 1 / the unit of the data; not finite where C' is zero.
  double point[kMaxDimension] = {0.0, 0.0, 0.0, 0.0};
  double normal[kMaxDimension] = {0.0, 0.0, 0.0, 0.0};  ///< Unit, to where the curve bends.
};

/// At both ends of every span that is not empty and at `per_span` - 1 places between, in order: a
/// knot has one sample from either side, since curvature may jump there. The dimension is 2 or
/// more.
std::vector<CurvatureSample> SampleCurvature(const BsplineCurve& curve, int per_span);

/// How fair a curve is, read from samples of its curvature (4 to 32 a span, at most some two
/// million).
struct CurveFairness {
  double bending_energy = 0.0;  ///< integral of kappa^2 ds
  /// integral of |d kappa / ds| ds: all rises and falls of the curvature, jumps at knots included.
  double curvature_variation = 0.0;
  double max_curvature = 0.0;     ///< Largest |kappa|...
  double max_curvature_at = 0.0;  ///< ...and its parameter.
  /// Local extrema of kappa inside the curve. Ups and downs of less than 1e-6 of the largest
  /// |kappa| are none: the curvature of a circle has no extremum that is more than rounding.
  int num_curvature_extrema = 0;
  /// In the plane: changes of the sign of kappa, by as much. -1 in other dimensions.
  int num_inflections = -1;
  /// Parameters of the extrema and inflections, in order, the first kMostPlaces of each: of extrema
  /// the sample that is highest or lowest, of inflections where the line between samples is zero.
  static constexpr int kMostPlaces = 1000;
  std::vector<double> curvature_extrema;
  std::vector<double> inflections;
};
CurveFairness MeasureFairness(const BsplineCurve& curve);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_CURVE_FAIRNESS_H_
