#include "solvers/ceres_lm.h"

#include <algorithm>
#include <cctype>

#include "problems/fit_problem.h"
#include "solvers/ceres_problem.h"
#include "solvers/options_note.h"

namespace batten {
namespace {

/// The first sparse library that Ceres was built with, NO_SPARSE if none.
ceres::SparseLinearAlgebraLibraryType SparseLibrary() {
  for (const auto library : {ceres::SUITE_SPARSE, ceres::EIGEN_SPARSE}) {
    if (ceres::IsSparseLinearAlgebraLibraryTypeAvailable(library)) return library;
  }
  return ceres::NO_SPARSE;
}

bool HasFreeParameters(const Problem& problem) {
  return problem.curve_fit() != nullptr && problem.curve_fit()->has_free_parameters();
}

std::string LinearSolverWord(const OptionValues& options, const Problem& problem) {
  const std::string& word = options.Word("linear_solver");
  if (word != "auto") return word;
  if (SparseLibrary() == ceres::NO_SPARSE) return "dense_qr";
  return HasFreeParameters(problem) ? "sparse_schur" : "sparse_normal_cholesky";
}

ceres::LinearSolverType LinearSolverType(const std::string& word) {
  if (word == "dense_qr") return ceres::DENSE_QR;
  if (word == "dense_normal_cholesky") return ceres::DENSE_NORMAL_CHOLESKY;
  if (word == "sparse_schur") return ceres::SPARSE_SCHUR;
  return word == "cgnr" ? ceres::CGNR : ceres::SPARSE_NORMAL_CHOLESKY;
}

constexpr double kLeastRadius = 1e-20;  // Ceres gives up at 1e-32

/// The outlines in data/animals need 13 at most; only a run that goes to and fro gets there.
constexpr int kMostRebindings = 1000;

/// Where E is quadratic one undamped step solves it. A first radius of 1e12 damps that step by
/// 1e-12 only, and still holds the directions that a rank-deficient problem leaves open near the
/// start. Where parameters are free, a step far from the minimum is cut off at the windows of many
/// of them, and the control points that were to go with them fly off: from a circle, rhino_100 with
/// 20 control points is at E = 675 after 10000 iterations with 1e4, at 232 after 269 with 1.
double FirstRadius(const OptionValues& options, const Problem& problem) {
  constexpr double kCeresDefault = 1e4;
  constexpr double kForQuadratics = 1e12;
  constexpr double kForFreeParameters = 1.0;
  if (options.Real("radius") > 0.0) return std::max(options.Real("radius"), kLeastRadius);
  if (HasFreeParameters(problem)) return kForFreeParameters;
  const bool is_quadratic =
      std::all_of(problem.terms().begin(), problem.terms().end(),
                  [](const Problem::TermInstance& term) { return term.family->rows() != nullptr; });
  return is_quadratic && !problem.has_bounds() ? kForQuadratics : kCeresDefault;
}

std::string LowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// As Ceres itself says after the solve; "auto" is answered by any.
std::string RanWith(const ceres::Solver::Summary& summary, const OptionValues& options) {
  std::string text =
      "ceres_lm/strategy=" +
      LowerCase(ceres::TrustRegionStrategyTypeToString(summary.trust_region_strategy_type));
  if (options.Word("linear_solver") == "auto") return text;
  return text + "/linear_solver=" +
         LowerCase(ceres::LinearSolverTypeToString(summary.linear_solver_type_used));
}

/// Ends a solve once a free parameter has come to a bound that is there for its blocks' sake.
class ArrivalWatch final : public ceres::IterationCallback {
 public:
  explicit ArrivalWatch(const CeresProblem* problem) : problem_(problem) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& /*summary*/) override {
    has_arrived_ = problem_->moving().AnyHasArrived(problem_->state());
    return has_arrived_ ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }
  bool has_arrived() const { return has_arrived_; }

 private:
  const CeresProblem* problem_;
  bool has_arrived_ = false;
};

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
          "what solves for a step; auto: sparse_normal_cholesky, where parameters are free "
          "sparse_schur, if Ceres has it, else dense_qr"),
      OptionInfo::Real(
          "radius", 0.0, 0.0, 1e16,
          "first size of the trust region; 0: 1e12 where E is quadratic and nothing is "
          "bounded, 1 where parameters are free, else 1e4, the default of Ceres"),
  };
  return info;
}

std::string CeresLmSolver::WhyUnsupported(const Objective& objective) const {
  const std::string word = LinearSolverWord(options_, objective.problem());
  if (word == "sparse_normal_cholesky" && SparseLibrary() == ceres::NO_SPARSE) {
    return "ceres_lm finds no sparse library in this Ceres; use linear_solver=dense_qr";
  }
  if (word == "cgnr" && options_.Word("strategy") == "dogleg") {
    return "ceres_lm/strategy=dogleg needs a factorization; use another linear_solver than cgnr";
  }
  return WhyNoCeresProblem(objective.problem(), "ceres_lm");
}

ceres::Solver::Options CeresLmSolver::CeresOptions(const Objective& objective,
                                                   const RunContext& context) const {
  ceres::Solver::Options ceres_options;
  ceres_options.minimizer_type = ceres::TRUST_REGION;
  ceres_options.trust_region_strategy_type =
      options_.Word("strategy") == "dogleg" ? ceres::DOGLEG : ceres::LEVENBERG_MARQUARDT;
  ceres_options.linear_solver_type =
      LinearSolverType(LinearSolverWord(options_, objective.problem()));
  ceres_options.sparse_linear_algebra_library_type = SparseLibrary();
  ceres_options.initial_trust_region_radius = FirstRadius(options_, objective.problem());
  ceres_options.num_threads = CeresThreads(context);
  return ceres_options;
}

Outcome CeresLmSolver::DoMinimize(Objective* objective, RunContext* context, Eigen::VectorXd* x) {
  if (const auto outcome = RunWithoutVariables(*objective, context, *x)) return *outcome;
  ceres::Solver::Options ceres_options = CeresOptions(*objective, *context);
  IterateBooker booker(context, x);
  std::optional<Outcome> outcome;
  std::string ran;
  int rebindings = 0;
  while (true) {
    outcome = SolveBoundAt(objective, context, &ceres_options, &booker, x, &ran);
    if (outcome.has_value() || rebindings == kMostRebindings) break;
    ++rebindings;
  }
  context->Note("linear solver", LinearSolverWord(options_, objective->problem()));
  context->Note(kOptionsThatRan, ran);
  if (HasFreeParameters(objective->problem())) {
    context->Note("re-bindings", std::to_string(rebindings));
  }
  if (outcome.has_value()) return *outcome;
  return {StopReason::kStalled,
          "parameters still change spans after " + std::to_string(rebindings) + " re-bindings"};
}

std::optional<Outcome> CeresLmSolver::SolveBoundAt(Objective* objective, RunContext* context,
                                                   ceres::Solver::Options* ceres_options,
                                                   IterateBooker* booker, Eigen::VectorXd* x,
                                                   std::string* ran) const {
  CeresProblem problem(objective, Evaluation::kJacobian, *x);
  problem.AddTerms();
  booker->GoOnFrom(&problem.state());
  problem.HoldPressed();
  LeaveStoppingToRunControl(booker, ceres_options);
  ArrivalWatch watch(&problem);
  if (!problem.moving().empty()) {
    ceres_options->callbacks.push_back(&watch);
    ceres_options->linear_solver_ordering = problem.MovingFirst();
  }
  const Eigen::VectorXd start = problem.state();
  ceres::Solver::Summary summary;
  ceres::Solve(*ceres_options, problem.problem(), &summary);
  *ran = RanWith(summary, options_);
  const Status status = booker->Finish(summary.IsSolutionUsable(), x);
  if (problem.stopped() || status != Status::kOk) return Outcome{context->stop_reason(), ""};
  if (summary.IsSolutionUsable() && problem.state() != start) {
    if (watch.has_arrived()) {
      ceres_options->initial_trust_region_radius =
          std::max(summary.iterations.back().trust_region_radius, kLeastRadius);
      return std::nullopt;
    }
    if (problem.PressedHaveChanged()) {
      // Steps with other variables: the region has shrunk until none of the old ones helped.
      ceres_options->initial_trust_region_radius = FirstRadius(options_, objective->problem());
      return std::nullopt;
    }
    if (problem.stopped()) return Outcome{context->stop_reason(), ""};
  }
  // "Residual and Jacobian evaluation failed", "Linear solver failed due to unrecoverable ...".
  const bool no_number = summary.termination_type == ceres::FAILURE &&
                         summary.message.find("failed") != std::string::npos;
  return Outcome{no_number ? StopReason::kNumericalFailure : StopReason::kNativeStop,
                 ShortReason(summary.message)};
}

}  // namespace batten
