#ifndef BATTEN_EXPERIMENTS_FAIRING_PAPER_H_
#define BATTEN_EXPERIMENTS_FAIRING_PAPER_H_

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "experiments/reproduction.h"
#include "problems/fit_problem.h"

namespace batten {

/// "B-Spline (11): spline curve fitting - fairing approximation" (a Chinese series by whudj, 2017,
/// after Luo Weilan 2003 and Lan Hao 2008), run again: open cubics with a knot at every data
/// point's centripetal parameter, alpha integral |C''|^2 + beta sum |C(u_i) - F_i|^2.
Reproduction FairingPaper();

// Its experiments, one file each, fairing_paper_NAME.cc.
Experiment FairingPaperCircle();
Experiment FairingPaperShapes();
Experiment FairingPaperMethod();
Experiment FairingPaperFormula();

/// One of the source's pairs (alpha, beta); interpolation has no alpha.
struct FairingRatio {
  const char* name;
  double alpha;
  double beta;
};
inline constexpr FairingRatio kFairingRatios[] = {{"interpolation", 0.0, 1.0},
                                                  {"0.01 : 1", 0.01, 1.0},
                                                  {"1 : 1", 1.0, 1.0},
                                                  {"1 : 0.01", 1.0, 0.01}};

/// The source's problem over `points` (m x d): parameters the sums of the roots of the chords, not
/// normalised, knots there, Bessel end tangents as two more rows of weight beta.
std::shared_ptr<const Problem> SourceFit(const Points& points, double alpha, double beta);

/// Every `every`-th point of a file of `data/` that is different from the one kept before it, at
/// most `most` of them. False with one sentence in `error`.
bool ReadDistinctPoints(const char* file, int every, int most, Points* points, std::string* error);

/// The upper band of W over the open cubic basis on knots u: row i has the integrals of N''_i
/// N''_(i+k), k = 0..3. The source's formula in double: lines a u + b, multiplied out in the
/// parameter as it is, and differences of the powers of u.
Eigen::MatrixXd SourceFormulaOfW(const std::vector<double>& u);
/// The same from the values of the lines at the ends of spans, in long double: nothing cancels.
Eigen::MatrixXd AccurateW(const std::vector<double>& u);

struct FormulaErrors {
  double reach = 0.0;  ///< The largest u_(s+1) / (u_(s+1) - u_s).
  double w = 0.0;      ///< Of SourceFormulaOfW, over the root of its two diagonal entries.
  /// Of control points at alpha = beta = 1, largest difference from banded_qr in units of the
  /// data's size: of the source's formula, of dense_qr; NaN where they were not asked for.
  double source = NAN;
  double dense_qr = NAN;
};
/// Of the source's problem over `points` (m x d, m > 2), scaled to a mean chord of 1.
FormulaErrors MeasureSourceFormula(const Points& points, bool solve);

/// Columns of FairnessCells.
std::vector<std::string> FairnessColumns();
/// rms of the residuals, largest residual, bending energy, variation of the curvature, largest
/// curvature, extrema, inflections (empty but in the plane) of a fit at x.
std::vector<std::string> FairnessCells(const Problem& problem, const Eigen::VectorXd& x);

/// Rows "setting, s, x, y, kappa": the curve and its curvature, `most` samples or some more.
std::vector<std::string> CurveColumns();
void AddCurveRows(const std::vector<std::string>& first, const Problem& problem,
                  const Eigen::VectorXd& x, int most, CsvTable* table);
/// Panels of the curves and of the curvatures of `rows` (CurveColumns()), by setting. `log_size`:
/// |kappa| on a logarithmic axis, where single sharp bends would hide all others.
std::vector<PlotPanel> CurveAndCurvaturePanels(const std::string& title, const CsvTable& rows,
                                               bool log_size);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_FAIRING_PAPER_H_
