#ifndef BATTEN_EXPERIMENTS_FIT_PLOT_H_
#define BATTEN_EXPERIMENTS_FIT_PLOT_H_

#include <vector>

#include "experiments/plot.h"
#include "experiments/run.h"

namespace batten {

/// What FitFigure() draws of the end of `run`, as panels of numbers for the report page: data,
/// control polygon and curve, and knots that were given. None where there is no curve.
std::vector<PlotPanel> FitPanels(const Problem& problem, const RunResult& run);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_FIT_PLOT_H_
