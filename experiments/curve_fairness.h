#ifndef BATTEN_EXPERIMENTS_CURVE_FAIRNESS_H_
#define BATTEN_EXPERIMENTS_CURVE_FAIRNESS_H_

#include <vector>

#include "experiments/curvature_reader.h"
#include "splines/bspline_curve.h"

namespace batten {

/// At both ends of every span that is not empty, at `per_span` - 1 places between and where the
/// curve is slow for less than their distance, which is where it may bend sharply, in order: a knot
/// has one sample from either side, since curvature may jump there. The dimension is 2 or more.
std::vector<CurvatureSample> SampleCurvature(const BsplineCurve& curve, int per_span);

/// The same at up to 25 places a span, as many as make at most `most` samples (2 or more); where
/// two a span are too many, some of these, evenly, with both ends of the curve.
std::vector<CurvatureSample> SampleCurvatureUpTo(const BsplineCurve& curve, int most);

struct CurvaturePlace {
  double t = 0.0;
  double kappa = 0.0;
};

/// How fair a curve is, read from samples of its curvature: 4 to 32 a span, and more around places
/// where the curve is slow, as many as its bends there need. The energy is right to about 1e-6 of
/// itself, the largest curvature to 1e-6, the variation to a percent. What may be rounding
/// (CurvatureSample::noise) is not counted: a straight line and a curve that is one point have
/// zeros throughout.
struct CurveFairness {
  double bending_energy = 0.0;  ///< integral of kappa^2 ds
  /// integral of |d kappa / ds| ds: all rises and falls of the curvature, jumps at knots included.
  double curvature_variation = 0.0;
  double max_curvature = 0.0;     ///< Largest |kappa|...
  double max_curvature_at = 0.0;  ///< ...and its parameter.
  /// Local extrema of kappa inside the curve, of closed curves all. Ups and downs of less than 1e-6
  /// of the |kappa| there are none: a fitted circle has no extremum.
  int num_curvature_extrema = 0;
  int num_inflections = -1;  ///< In the plane: changes of the sign of kappa. -1 otherwise.
  /// The extrema and inflections in order, the first kMostPlaces of each: of extrema the sample
  /// that is highest or lowest, of inflections where the line between samples is zero.
  static constexpr int kMostPlaces = 1000;
  std::vector<CurvaturePlace> curvature_extrema;
  std::vector<double> inflections;
};
CurveFairness MeasureFairness(const BsplineCurve& curve);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_CURVE_FAIRNESS_H_
