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
};

/// The length of a comb's teeth per unit of curvature, one for all these curves: the sharpest teeth
/// but for two percent are 15 % of the longest side of all. 0 where there is no curvature.
double ToothLength(const std::vector<std::vector<CurvatureSample>>& curves);
/// The tip of the tooth at a sample whose kappa is finite: all kMaxDimension coordinates.
std::array<double, kMaxDimension> ToothTip(const CurvatureSample& sample, double tooth_length);

/// One panel per curve with its curvature comb (teeth of length proportional to kappa, to the side
/// that the curve bends away from, alike in scale for all curves; in space the first two
/// coordinates), then one with kappa of all curves over the part of their arc length. At least one
/// curve, of dimension 2 or more.
std::vector<PlotPanel> CurvaturePanels(const std::vector<NamedCurve>& curves);

/// The fit at x, and beside it the curve of the same fit without its fairing terms, where it has
/// some and banded_qr finds one.
std::vector<NamedCurve> FitBesideTheUnfaired(const Problem& problem, const Eigen::VectorXd& x);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_CURVATURE_FIGURE_H_
