#ifndef BATTEN_EXPERIMENTS_CURVATURE_FIGURE_H_
#define BATTEN_EXPERIMENTS_CURVATURE_FIGURE_H_

#include <array>
#include <string>
#include <vector>

#include "experiments/curve_fairness.h"
#include "experiments/plot.h"
#include "problems/fit_problem.h"
#include "splines/bspline_curve.h"

namespace batten {

struct NamedCurve {
  std::string name;
  BsplineCurve curve;
  bool is_for_comparison = false;  ///< It does not set the scale.
};

/// The length of a comb's teeth per unit of curvature, one for all these curves: the sharpest teeth
/// but for two percent are 15 % of the longest side of all. 0 where there is no curvature.
double ToothLength(const std::vector<std::vector<CurvatureSample>>& curves);
/// The tip of the tooth at a sample whose kappa is finite: all kMaxDimension coordinates.
std::array<double, kMaxDimension> ToothTip(const CurvatureSample& sample, double tooth_length);

/// One panel per curve with its curvature comb (teeth of length proportional to kappa, to the side
/// that the curve bends away from, alike in scale for all curves; in space the first two
/// coordinates), then one with kappa of all curves over the part of their arc length. Curvature
/// beyond three times the scale's is cut, and titles say so. At least one curve that is not for
/// comparison, all of dimension 2 or more.
std::vector<PlotPanel> CurvaturePanels(const std::vector<NamedCurve>& curves);

/// The fit at x and, for comparison, what banded_qr finds of: the same fit without its fairing
/// terms, where it has some; the curve of the same degree that interpolates the data at the fit's
/// parameters (fixed ones, or those that it started from), knots averaged from these. The second
/// alone where the first has as many control points as there are points, or more; without it if
/// parameters coincide, are more than 20,000, or fewer than a curve needs.
std::vector<NamedCurve> FitBesideOthers(const Problem& problem, const Eigen::VectorXd& x);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_CURVATURE_FIGURE_H_
