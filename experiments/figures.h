#ifndef BATTEN_EXPERIMENTS_FIGURES_H_
#define BATTEN_EXPERIMENTS_FIGURES_H_

#include <string>
#include <vector>

#include "experiments/comparison.h"
#include "experiments/gnuplot.h"

namespace batten {

/// The fit at the end of `run`: data blue, control polygon black, curve red, axes of equal scale.
/// Knots that were given or searched for are green.
/// Dimension 1: against t; 3: the projections xy, xz, yz; 4: xy and zw. Of more than 4,000 points
/// every k-th is drawn; from 400 on they are small, light, and below the rest.
FigureResult FitFigure(const Problem& problem, const RunResult& run, const std::string& stem,
                       FileBatch* batch);

/// Energy gap and gradient norm against iteration, log scale, all `rows` (of one problem) in one
/// plot; rows without a trace are left out. Where no E* is known, the energy itself.
FigureResult ConvergenceFigure(const std::vector<const ComparisonRow*>& rows,
                               const std::string& stem, FileBatch* batch);

/// The rows of one problem of a comparison.
std::vector<const ComparisonRow*> RowsOfProblem(const ComparisonResult& result, int problem_index);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_FIGURES_H_
