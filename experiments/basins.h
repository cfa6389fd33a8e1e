#ifndef BATTEN_EXPERIMENTS_BASINS_H_
#define BATTEN_EXPERIMENTS_BASINS_H_

#include <vector>

#include "experiments/run.h"
#include "problems/fit_problem.h"

namespace batten {

/// Whether E of a curve fit may have several minima: parameters that move, terms that are not
/// affine (curve_fairing), losses that are not convex (cauchy, tukey).
bool MayHaveSeveralMinima(const Problem& problem);

/// Where a run on a problem with several minima leads, polished.
struct BasinEnd {
  Points control_points;               ///< User units.
  double energy = 0.0;                 ///< At its parameters.
  double energy_at_foot_points = 0.0;  ///< Of the interpolation part: weights, nothing else.
  bool polished = false;               ///< Newton's method came to its rounding floor.
};

/// Follows a run's end x (all variables, scaled as inside) to the rounding floor by `newton`, so
/// that ends in one basin become one curve; for `max_seconds` > 0 at most.
inline constexpr double kMostPolishing = 10.0;
BasinEnd Polish(const Problem& problem, const Eigen::VectorXd& x,
                double max_seconds = kMostPolishing);

/// Sum of w_i times the squared distance of data point i from the curve of these control points.
double EnergyAtFootPoints(const CurveFit& fit, const Points& control_points);

/// Largest distance of a sampled point of either curve from the other one, 16 samples a span.
double CurveDistanceBetween(const BsplineCurve& a, const BsplineCurve& b);

/// Basin of each end, 0, 1, ... in the order of their energies at foot points, with fixed
/// parameters of their energies: ends whose curves are nearer to each other than kSameCurve of the
/// data's size share one; of the first one's own size where it goes farther than the data.
std::vector<int> FindBasins(const Problem& problem, const std::vector<BasinEnd>& ends);
/// The same where the problem is not at hand: `size` is that of its data.
std::vector<int> FindBasins(const BsplineBasis& basis, double size,
                            const std::vector<BasinEnd>& ends);
inline constexpr double kSameCurve = 1e-6;

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_BASINS_H_
