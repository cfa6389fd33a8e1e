#ifndef BATTEN_SOLVERS_SOLVER_H_
#define BATTEN_SOLVERS_SOLVER_H_

#include <string>
#include <vector>

#include "cost_functions/options.h"
#include "problems/objective.h"
#include "solvers/run_context.h"

namespace batten {

/// Why a run ended. The solver claims it; the audit checks it.
struct Outcome {
  StopReason reason = StopReason::kNotRun;
  std::string message;  ///< One sentence where there is more to say.
};

/// The stop rule of a method's own authors, applied by run control in native mode.
enum class NativeRule { kDirect, kStep, kGradient };

struct SolverInfo {
  std::string name;
  std::string summary;  ///< One line.
  std::string source;
  std::vector<std::string> needs;     ///< "compiled rows", "as many control points as points".
  std::vector<std::string> supports;  ///< "bounds", "linear constraints", "losses", "weights".
  NativeRule native_rule = NativeRule::kGradient;
  bool wraps_solver = false;  ///< Written NAME:BASE.
  std::string usual_base;     ///< Of one that wraps a solver: what "all solvers" means by it.
  /// Empty: what it converges to is the minimum of E. Otherwise the equations of its own limit.
  std::string limit;
  std::vector<OptionInfo> options;
};

/// A method that lowers an objective. One object serves one run.
class Solver {
 public:
  virtual ~Solver() = default;
  virtual SolverInfo Info() const = 0;
  /// Empty: `objective` can be solved. Otherwise one sentence, shown as "skipped: ...".
  virtual std::string WhyUnsupported(const Objective& objective) const = 0;
  /// Lowers E from *x and leaves the best point there. Calls context->Iterate(*x) once after
  /// set-up, then after each iteration; neither prints, times nor stops by itself. The public call
  /// checks WhyUnsupported, sizes and finiteness of the start.
  Outcome Minimize(Objective* objective, RunContext* context, Eigen::VectorXd* x);

 private:
  virtual Outcome DoMinimize(Objective* objective, RunContext* context, Eigen::VectorXd* x) = 0;
};

/// `NAME does not keep the points in their order; use lbfgs` where that is asked for; else empty.
std::string WhyNoOrder(const Problem& problem, const std::string& solver_name);
/// `NAME holds linear constraints only; use ...` where the problem has others; else empty.
std::string WhyNoNonlinearConstraints(const Problem& problem, const std::string& solver_name);
/// Why `objective` has no curve view, as a sentence for WhyUnsupported; empty if it has one.
std::string WhyNoCurveView(const Objective& objective, const std::string& solver_name);
/// `NAME ignores bounds; use ceres_lm` where the problem has bounds, or WhyNoNonlinearConstraints;
/// otherwise empty.
std::string WhyNoBounds(const Objective& objective, const std::string& solver_name);
/// The first that is not empty of both: for methods that work on the view and ignore bounds.
std::string WhyNoUnboundedCurveView(const Objective& objective, const std::string& solver_name);

}  // namespace batten

#endif  // BATTEN_SOLVERS_SOLVER_H_
