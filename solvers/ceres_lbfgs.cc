#include "solvers/ceres_lbfgs.h"

#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include <algorithm>
#include <cctype>

#include "problems/fit_problem.h"
#include "solvers/ceres_adapter.h"
#include "solvers/ceres_problem.h"
#include "solvers/options_note.h"

namespace batten {
namespace {

/// E / 2 and its gradient for ceres::GradientProblem.
class HalfEnergy final : public ceres::FirstOrderFunction {
 public:
  HalfEnergy(Objective* objective, bool* stopped) : objective_(objective), stopped_(stopped) {}

  int NumParameters() const override { return objective_->num_variables(); }

  bool Evaluate(const double* parameters, double* cost, double* gradient) const override {
    if (*stopped_) return false;
    x_ = Eigen::Map<const Eigen::VectorXd>(parameters, NumParameters());
    const Status status = gradient == nullptr ? objective_->Energy(x_, cost)
                                              : objective_->EnergyAndGradient(x_, cost, &gradient_);
    *stopped_ = status == Status::kStop;
    if (status != Status::kOk) return false;
    *cost *= 0.5;
    if (gradient != nullptr) {
      Eigen::Map<Eigen::VectorXd> half(gradient, NumParameters());
      half = 0.5 * gradient_;
    }
    return true;
  }

 private:
  Objective* objective_;
  bool* stopped_;
  // Ceres calls from one thread.
  mutable Eigen::VectorXd x_;
  mutable Eigen::VectorXd gradient_;
};

/// Why Ceres ended a run that run control would have let go on.
template <typename Summary>
Outcome OwnEnd(const Summary& summary) {
  const std::string reason = ShortReason(summary.message);
  if (summary.termination_type == ceres::FAILURE) {
    // "[Initial] cost and jacobian evaluation failed"; all other failures are the line search's.
    const bool no_number = summary.message.find("evaluation failed") != std::string::npos;
    return {no_number ? StopReason::kNumericalFailure : StopReason::kLineSearchEnded, reason};
  }
  // With all tolerances zero: a step of length zero, an equal cost, or a gradient of zero.
  const bool at_zero_gradient =
      summary.iterations.empty() || summary.iterations.back().gradient_max_norm == 0.0;
  return {at_zero_gradient ? StopReason::kNativeStop : StopReason::kLineSearchEnded, reason};
}

}  // namespace

SolverInfo CeresLbfgsSolver::ClassInfo() {
  SolverInfo info;
  info.name = "ceres_lbfgs";
  info.summary = "L-BFGS of Ceres, from our objective or from Ceres' own problem";
  info.source = "Ceres Solver 2.1, line_search_minimizer.cc; Nocedal, Math. Comp. 1980";
  info.needs = {"compiled rows (form=spans)"};
  info.supports = {"any objective", "linear constraints", "losses",
                   "weights",       "any rank",           "threads"};
  info.native_rule = NativeRule::kGradient;
  info.options = {
      OptionInfo::Integer("memory", 20, 1, 1000, "pairs of steps and gradient changes kept"),
      OptionInfo::Word("form", "objective", {"objective", "problem", "spans"},
                       "what Ceres gets: our objective as one function, one residual block per "
                       "block of the terms, or one per span"),
      OptionInfo::Word("scaling", "off", {"off", "on"},
                       "first inverse Hessian scaled by an approximate eigenvalue"),
      OptionInfo::Word("interpolation", "cubic", {"cubic", "quadratic", "bisection"},
                       "how the line search chooses its next step"),
      OptionInfo::Real("curvature", 0.9, 1e-3, 0.999,
                       "line search ends where the slope has fallen to this part of the first one"),
  };
  return info;
}

std::string CeresLbfgsSolver::WhyUnsupported(const Objective& objective) const {
  std::string why = WhyNoBounds(objective, "ceres_lbfgs");
  if (!why.empty()) return why;
  why = WhyNoOrder(objective.problem(), "ceres_lbfgs");
  if (!why.empty()) return why;
  const std::string& form = options_.Word("form");
  if (form == "problem") {
    const CurveFit* fit = objective.problem().curve_fit();
    if (fit != nullptr && fit->has_free_parameters()) {
      return "ceres_lbfgs/form=problem cannot follow free parameters past their spans; use "
             "form=objective";
    }
    return WhyNoCeresProblem(objective.problem(), "ceres_lbfgs/form=problem");
  }
  return form == "spans" ? WhyNoCurveView(objective, "ceres_lbfgs/form=spans") : "";
}

/// As Ceres itself says after the solve.
template <typename Summary>
std::string RanWith(const Summary& summary) {
  std::string interpolation =
      ceres::LineSearchInterpolationTypeToString(summary.line_search_interpolation_type);
  std::transform(interpolation.begin(), interpolation.end(), interpolation.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return "ceres_lbfgs/memory=" + std::to_string(summary.max_lbfgs_rank) +
         "/interpolation=" + interpolation;
}

template <typename Options>
void CeresLbfgsSolver::SetOptions(Options* ceres_options) const {
  // All of them, though the defaults agree today: equal points need equal options.
  ceres_options->line_search_direction_type = ceres::LBFGS;
  ceres_options->line_search_type = ceres::WOLFE;
  ceres_options->max_lbfgs_rank = options_.Integer("memory");
  ceres_options->use_approximate_eigenvalue_bfgs_scaling = options_.Word("scaling") == "on";
  const std::string& interpolation = options_.Word("interpolation");
  ceres_options->line_search_interpolation_type = interpolation == "cubic"       ? ceres::CUBIC
                                                  : interpolation == "quadratic" ? ceres::QUADRATIC
                                                                                 : ceres::BISECTION;
  ceres_options->min_line_search_step_size = 1e-9;
  ceres_options->line_search_sufficient_function_decrease = 1e-4;
  ceres_options->line_search_sufficient_curvature_decrease = options_.Real("curvature");
  ceres_options->max_line_search_step_contraction = 1e-3;
  ceres_options->min_line_search_step_contraction = 0.6;
  ceres_options->max_num_line_search_step_size_iterations = 20;
  ceres_options->max_num_line_search_direction_restarts = 5;
  ceres_options->max_line_search_step_expansion = 10.0;
}

Outcome CeresLbfgsSolver::DoMinimize(Objective* objective, RunContext* context,
                                     Eigen::VectorXd* x) {
  if (const auto outcome = RunWithoutVariables(*objective, context, *x)) return *outcome;
  return options_.Word("form") == "objective" ? MinimizeObjective(objective, context, x)
                                              : MinimizeCeresProblem(objective, context, x);
}

Outcome CeresLbfgsSolver::MinimizeObjective(Objective* objective, RunContext* context,
                                            Eigen::VectorXd* x) const {
  Eigen::VectorXd state = *x;
  bool stopped = false;
  const ceres::GradientProblem problem(new HalfEnergy(objective, &stopped));  // it owns it
  IterateBooker booker(context, &state);
  ceres::GradientProblemSolver::Options ceres_options;
  SetOptions(&ceres_options);
  LeaveStoppingToRunControl(&booker, &ceres_options);
  ceres::GradientProblemSolver::Summary summary;
  do {
    booker.GoOnFrom(&state);
    ceres::Solve(ceres_options, problem, state.data(), &summary);
    context->Note(kOptionsThatRan, RanWith(summary));
    const Status status = booker.Finish(summary.IsSolutionUsable(), x);
    if (stopped || status != Status::kOk) return {context->stop_reason(), ""};
    // Of parameters past an end Ceres sees no slope: where E draws them back it goes on from there,
    // unless it has gone to and fro at one E.
  } while (summary.final_cost < summary.initial_cost && objective->Seat(&state));
  return OwnEnd(summary);
}

Outcome CeresLbfgsSolver::MinimizeCeresProblem(Objective* objective, RunContext* context,
                                               Eigen::VectorXd* x) const {
  CeresProblem problem(objective, Evaluation::kGradient, *x);
  if (options_.Word("form") == "problem") {
    problem.AddTerms();
  } else {
    problem.AddSpans();
  }
  IterateBooker booker(context, &problem.state());
  ceres::Solver::Options ceres_options;
  ceres_options.minimizer_type = ceres::LINE_SEARCH;
  ceres_options.num_threads = CeresThreads(*context);
  SetOptions(&ceres_options);
  LeaveStoppingToRunControl(&booker, &ceres_options);
  ceres::Solver::Summary summary;
  ceres::Solve(ceres_options, problem.problem(), &summary);
  context->Note(kOptionsThatRan, RanWith(summary));
  const Status status = booker.Finish(summary.IsSolutionUsable(), x);
  if (problem.stopped() || status != Status::kOk) return {context->stop_reason(), ""};
  return OwnEnd(summary);
}

}  // namespace batten
