#ifndef BATTEN_EXPERIMENTS_FIT_LINES_H_
#define BATTEN_EXPERIMENTS_FIT_LINES_H_

#include <string>
#include <utility>
#include <vector>

#include "problems/fit_problem.h"

namespace batten {

/// Places that a picture of a fit shows, with their parameters: what FitFigure() draws and
/// FitPanels() hands out as numbers.
struct FitLine {
  std::string name;
  std::vector<double> t;
  Points points;
};

/// Every `step`-th data point; the name says so.
FitLine DataLine(const CurveFit& fit, const Eigen::VectorXd& x, int step);
/// Closed where the curve is. In dimension 1 control point j stands at its Greville abscissa, and
/// they are in the order of these.
FitLine PolygonLine(const CurveFit& fit, const Eigen::VectorXd& x);
/// Every span alike, its ends included: 24 places in each, or about `most` in all.
FitLine CurveLine(const BsplineCurve& curve, int most);
/// Where the spans meet, the ends of the domain among them.
FitLine KnotLine(const BsplineCurve& curve);

/// The coordinates across and up of each panel; -1: the parameter.
std::vector<std::pair<int, int>> AxisPairs(int dimension);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_FIT_LINES_H_
