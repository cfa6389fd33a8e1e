#ifndef BATTEN_EXPERIMENTS_FIT_REPORT_H_
#define BATTEN_EXPERIMENTS_FIT_REPORT_H_

#include <optional>
#include <ostream>
#include <string>

#include "experiments/audit.h"
#include "experiments/curve_fairness.h"
#include "experiments/curve_shape.h"
#include "experiments/fairing_choice.h"
#include "experiments/run.h"
#include "problems/fit_problem.h"

namespace batten {

/// A run's end measured: distances, foot points, shape and audit, all off the clock.
struct FitReport {
  double rms = 0.0;  // distances at the parameters, of free ones those at the end
  double max = 0.0;
  double rms_orthogonal = 0.0;  // at plain closest points (splines/closest_point.h)
  double max_orthogonal = 0.0;
  double energy_at_foot_points = 0.0;  // sum of w |C(foot) - Q|^2
  /// Data points that another point of the curve, farther along it, is as near to (FootPoint::tie);
  /// none where it was not looked for: in rows that were read again.
  std::optional<int> num_ties;
  std::optional<CurveShape> shape;              // none in dimension 1, or without a curve
  std::optional<CurveFairness> fairness;        // the same
  std::optional<FairingChoice> fairing_choice;  // where a rule chose the weight of fairing
  /// False where the audit does not apply: it knows distances from the data, end_point, end_tangent
  /// and end_curvature with any loss, fairing without one, linear constraints, and, but for |g|,
  /// the others. `audit` and `verdict` then say nothing.
  bool audited = false;
  AuditReport audit;
  Verdict verdict;  // of the run's claim against the audit
};
/// The curve's shape beside the data that count, of which `feet` are the parameters. None in
/// dimension 1: a curve on the line lies on itself.
std::optional<CurveShape> ShapeBesideData(const CurveFit& fit, const BsplineCurve& curve,
                                          const Eigen::VectorXd& feet);

FitReport MeasureFit(const Problem& problem, const RunResult& run, const RunSpec& spec);

/// The claim of a run, for Verify.
Claim ClaimOf(const RunResult& run, const RunSpec& spec);

/// The text of fit.json ("format": "batten.fit/1", docs/formats.md). Never NaN or infinity: null.
std::string FitJson(const Problem& problem, const RunResult& run, const RunSpec& spec,
                    const FitReport& report);
/// Streams the same text to `stream` without holding it: for millions of points.
void WriteFitJson(const Problem& problem, const RunResult& run, const RunSpec& spec,
                  const FitReport& report, std::ostream* stream);
/// JSON lines {"iteration", "control_points", "parameters"}.
std::string IteratesJsonLines(const Problem& problem, const RunResult& run);
/// TraceCsv() with the columns that the problem has.
std::string RunTraceCsv(const Problem& problem, const RunResult& run);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_FIT_REPORT_H_
