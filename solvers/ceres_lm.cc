#include "solvers/ceres_lm.h"

#include <algorithm>

#include "solvers/ceres_adapter.h"
#include "solvers/ceres_problem.h"

namespace batten {
namespace {

/// The first sparse library that Ceres was built with, NO_SPARSE if none.
ceres::SparseLinearAlgebraLibraryType SparseLibrary() {
  for (const auto library : {ceres::SUITE_SPARSE, ceres::EIGEN_SPARSE}) {
    if (ceres::IsSparseLinearAlgebraLibraryTypeAvailable(library)) return library;
  }
  return ceres::NO_SPARSE;
}

std::string LinearSolverWord(const OptionValues& options) {
  const std::string& word = options.Word("linear_solver");
  if (word != "auto") return word;
  return SparseLibrary() == ceres::NO_SPARSE ? "dense_qr" : "sparse_normal_cholesky";
}

ceres::LinearSolverType LinearSolverType(const std::string& word) {
  if (word == "dense_qr") return ceres::DENSE_QR;
  if (word == "dense_normal_cholesky") return ceres::DENSE_NORMAL_CHOLESKY;
  return word == "cgnr" ? ceres::CGNR : ceres::SPARSE_NORMAL_CHOLESKY;
}

/// Where E is quadratic one undamped step solves it. A first radius of 1e12 damps that step by
/// 1e-12 only, and still holds the directions that a rank-deficient problem leaves open near the
/// start.
double FirstRadius(const OptionValues& options, const Problem& problem) {
  constexpr double kCeresDefault = 1e4;
  constexpr double kForQuadratics = 1e12;
  constexpr double kLeast = 1e-20;  // Ceres gives up at 1e-32
  if (options.Real("radius") > 0.0) return std::max(options.Real("radius"), kLeast);
  const bool is_quadratic =
      std::all_of(problem.terms().begin(), problem.terms().end(),
                  [](const Problem::TermInstance& term) { return term.family->rows() != nullptr; });
  return is_quadratic && !problem.has_bounds() ? kForQuadratics : kCeresDefault;
}

}  // namespace

SolverInfo CeresLmSolver::ClassInfo() {
  SolverInfo info;
  info.name = "ceres_lm";
  info.summary = "Levenberg-Marquardt of Ceres, or its dogleg, on Ceres' own problem";
  info.source = "Ceres Solver 2.1, trust_region_minimizer.cc; Marquardt, J. SIAM 1963";
  info.supports = {"bounds", "linear constraints", "losses", "weights", "any rank", "threads"};
  info.native_rule = NativeRule::kGradient;
  info.options = {
      OptionInfo::Word("strategy", "levenberg_marquardt", {"levenberg_marquardt", "dogleg"},
                       "how a step is held inside the trust region"),
      OptionInfo::Word(
          "linear_solver", "auto",
          {"auto", "sparse_normal_cholesky", "dense_normal_cholesky", "dense_qr", "cgnr"},
          "what solves for a step; auto: sparse_normal_cholesky if Ceres has it, else "
          "dense_qr"),
      OptionInfo::Real(
          "radius", 0.0, 0.0, 1e16,
          "first size of the trust region; 0: 1e12 where E is quadratic and nothing is "
          "bounded, else 1e4, the default of Ceres"),
  };
  return info;
}

std::string CeresLmSolver::WhyUnsupported(const Objective& objective) const {
  const std::string word = LinearSolverWord(options_);
  if (word == "sparse_normal_cholesky" && SparseLibrary() == ceres::NO_SPARSE) {
    return "ceres_lm finds no sparse library in this Ceres; use linear_solver=dense_qr";
  }
  if (word == "cgnr" && options_.Word("strategy") == "dogleg") {
    return "ceres_lm/strategy=dogleg needs a factorization; use another linear_solver than cgnr";
  }
  return WhyNoCeresProblem(objective.problem(), "ceres_lm");
}

Outcome CeresLmSolver::DoMinimize(Objective* objective, RunContext* context, Eigen::VectorXd* x) {
  if (const auto outcome = RunWithoutVariables(*objective, context, *x)) return *outcome;
  CeresProblem problem(objective, Evaluation::kJacobian, *x);
  problem.AddTerms();
  IterateBooker booker(context, &problem.state());
  ceres::Solver::Options ceres_options;
  ceres_options.minimizer_type = ceres::TRUST_REGION;
  ceres_options.trust_region_strategy_type =
      options_.Word("strategy") == "dogleg" ? ceres::DOGLEG : ceres::LEVENBERG_MARQUARDT;
  ceres_options.linear_solver_type = LinearSolverType(LinearSolverWord(options_));
  ceres_options.sparse_linear_algebra_library_type = SparseLibrary();
  ceres_options.initial_trust_region_radius = FirstRadius(options_, objective->problem());
  ceres_options.num_threads = CeresThreads(*context);
  LeaveStoppingToRunControl(&booker, &ceres_options);
  ceres::Solver::Summary summary;
  ceres::Solve(ceres_options, problem.problem(), &summary);
  context->Note("linear solver", LinearSolverWord(options_));
  const Status status = booker.Finish(summary.IsSolutionUsable(), x);
  if (problem.stopped() || status != Status::kOk) return {context->stop_reason(), ""};
  // "Residual and Jacobian evaluation failed", "Linear solver failed due to unrecoverable ...".
  const bool no_number = summary.termination_type == ceres::FAILURE &&
                         summary.message.find("failed") != std::string::npos;
  return {no_number ? StopReason::kNumericalFailure : StopReason::kNativeStop,
          ShortReason(summary.message)};
}

}  // namespace batten
