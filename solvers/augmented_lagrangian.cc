#include "solvers/augmented_lagrangian.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>

#include "problems/constraint_projection.h"
#include "problems/curve_constraints.h"
#include "problems/fit_problem.h"
#include "solvers/options_note.h"

namespace batten {
namespace {

/// Lets the run's own monitor count what is evaluated of another objective.
class ForwardingMonitor final : public EvaluationMonitor {
 public:
  explicit ForwardingMonitor(Objective* counted) : counted_(counted) {}
  bool Allow(Evaluation kind, const Eigen::VectorXd* x) override {
    return counted_->Allow(kind, x);
  }

 private:
  Objective* counted_;
};

/// One run of the base: its iterates are the run's, but for the first where that is booked already;
/// it ends where the gradient of the augmented Lagrangian has fallen so far that the multipliers
/// can be told better.
class RoundContext final : public RunContext {
 public:
  RoundContext(const Problem& augmented, double reduction, bool books_first, RunContext* outer)
      : judge_(&augmented, nullptr),
        reduction_(reduction),
        books_first_(books_first),
        outer_(outer) {}

  Status Iterate(const Eigen::VectorXd& x) override {
    if ((iterations_ > 0 || books_first_) && outer_->Iterate(x) != Status::kOk) {
      return Status::kStop;
    }
    double norm = 0.0;
    double floor = 0.0;
    outer_->OffTheClock([&] {
      double energy = 0.0;
      Eigen::VectorXd gradient;
      const bool ok = judge_.EnergyAndGradient(x, &energy, &gradient) == Status::kOk;
      norm = ok ? gradient.norm() : std::nan("");
      if (iterations_ % kPerFloor == 0) floor_ = judge_.GradientRoundingFloor(x);
      floor = floor_;
    });
    if (iterations_ == 0) first_norm_ = norm;
    ++iterations_;
    if (norm <= reduction_ * first_norm_) reason_ = StopReason::kGradientSmall;
    if (norm <= floor) reason_ = StopReason::kRoundingFloor;
    return reason_ == StopReason::kNotRun ? Status::kOk : Status::kStop;
  }
  StopReason stop_reason() const override {
    return reason_ == StopReason::kNotRun ? outer_->stop_reason() : reason_;
  }
  /// With what options it ran is of the whole run, other notes are of this part alone.
  void Note(const std::string& name, const std::string& value) override {
    if (name == kOptionsThatRan) outer_->Note(name, value);
  }
  void OffTheClock(const std::function<void()>& work) override { outer_->OffTheClock(work); }
  std::uint64_t seed() const override { return outer_->seed(); }
  int threads() const override { return outer_->threads(); }

 private:
  static constexpr int kPerFloor = 16;  // the floor hardly changes, and costs a Jacobian
  Objective judge_;
  double reduction_;
  bool books_first_;
  RunContext* outer_;
  int iterations_ = 0;
  double first_norm_ = 0.0;
  double floor_ = 0.0;
  StopReason reason_ = StopReason::kNotRun;
};

/// Brings parameters of constraints that are past an end of the curve, where h does not change with
/// them, back inside: the point that is looked for may be reached by bending the curve. False if
/// none is.
bool BringInside(const Objective& objective, Eigen::VectorXd* x) {
  constexpr double kInside = 0.1;  // of the domain
  const Problem& problem = objective.problem();
  Eigen::VectorXd all = objective.Expand(*x);
  bool any = false;
  for (const VariableRange& range : problem.ranges()) {
    if (range.name != kConstraintParameters) continue;
    const BsplineBasis& basis = problem.curve_fit()->basis();
    for (double& t : all.segment(range.begin, range.size)) {
      if (PlaceOnCurve(basis, t).moves) continue;
      any = true;
      const double inside = kInside * basis.domain_length();
      t = t < basis.domain_begin() ? basis.domain_begin() + inside : basis.domain_end() - inside;
    }
  }
  *x = problem.elimination().FreeVariables(all);
  return any;
}

constexpr char kPenaltyName[] = "the penalty of the constraints";
constexpr double kRaise = 10.0;
constexpr int kMostRaises = 8;
constexpr int kMostRounds = 200;
constexpr int kMostIdleRounds = 4;

}  // namespace

SolverInfo AugmentedLagrangianSolver::ClassInfo() {
  SolverInfo info;
  info.name = "augmented_lagrangian";
  info.summary = "a solver under constraints that are not linear, by the method of multipliers";
  info.source =
      "Hestenes, JOTA 4, 1969; Powell 1969; Nocedal & Wright, Numerical Optimization, ch. 17";
  info.needs = {"a base that takes any smooth term"};
  info.supports = {"what its base supports", "nonlinear constraints"};
  info.native_rule = NativeRule::kGradient;
  info.wraps_solver = true;
  info.usual_base = "lbfgs";
  info.options = {
      OptionInfo::Real("penalty", 10.0, 0.1, 1e6,
                       "first weight of the penalty, in units of what E costs the constraints"),
      OptionInfo::Real("reduction", 1e-2, 1e-8, 0.5,
                       "a round of the base ends where its gradient has fallen to this part")};
  return info;
}

AugmentedLagrangianSolver::AugmentedLagrangianSolver(const OptionValues& options,
                                                     std::unique_ptr<Solver> base)
    : penalty_(options.Real("penalty")),
      reduction_(options.Real("reduction")),
      base_(std::move(base)) {}

std::string AugmentedLagrangianSolver::WhyUnsupported(const Objective& objective) const {
  const Problem& problem = objective.problem();
  const ConstraintFamily* const constraints = problem.nonlinear_constraints();
  if (constraints == nullptr) {
    const std::string why = base_->WhyUnsupported(objective);
    return why.empty() ? "" : "augmented_lagrangian:" + why;
  }
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(constraints->size());
  const Problem augmented =
      problem.WithPenalty(kPenaltyName, constraints->MakePenalty(1.0, ones, 0.0 * ones));
  const std::string why =
      base_->WhyUnsupported(Objective(&augmented, nullptr, objective.options()));
  return why.empty() ? "" : "augmented_lagrangian:" + why;
}

Outcome AugmentedLagrangianSolver::DoMinimize(Objective* objective, RunContext* context,
                                              Eigen::VectorXd* x) {
  if (objective->problem().nonlinear_constraints() == nullptr) {
    return base_->Minimize(objective, context, x);
  }
  Multipliers multipliers;
  const Status status = Multipliers::Make(objective, *x, penalty_, &multipliers);
  if (status == Status::kStop) return {context->stop_reason(), ""};
  if (status == Status::kNonFinite) {
    return {StopReason::kNumericalFailure, "a constraint has no finite value at the start"};
  }
  Progress progress;
  progress.violation = std::numeric_limits<double>::infinity();
  progress.least_gradient = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kMostRounds; ++round) {
    const auto outcome = Round(objective, context, round == 0, &multipliers, &progress, x);
    if (!outcome.has_value()) continue;
    context->Note("rounds of the multipliers", std::to_string(round + 1));
    return *outcome;
  }
  return {StopReason::kStalled,
          "the multipliers still change after " + std::to_string(kMostRounds) + " rounds"};
}

std::optional<Outcome> AugmentedLagrangianSolver::Round(Objective* objective, RunContext* context,
                                                        bool first, Multipliers* multipliers,
                                                        Progress* progress, Eigen::VectorXd* x) {
  const Problem& problem = objective->problem();
  const ConstraintFamily& constraints = *problem.nonlinear_constraints();
  const Problem augmented =
      problem.WithPenalty(kPenaltyName, multipliers->MakePenalty(constraints));
  ForwardingMonitor monitor(objective);
  Objective inner(&augmented, &monitor, objective->options());
  RoundContext round(augmented, reduction_, first, context);
  const Outcome outcome = base_->Minimize(&inner, &round, x);
  if (context->stop_reason() != StopReason::kNotRun) {
    // The run may book nothing more, but what it gives back is to meet the constraints.
    const bool is_met =
        x->allFinite() &&
        MeasureViolation(problem, objective->Expand(*x)).largest <= kConstraintTolerance;
    if (!is_met && x->allFinite()) ProjectOntoConstraints(problem, multipliers->values(), x);
    return Outcome{context->stop_reason(), ""};
  }
  if (outcome.reason == StopReason::kNumericalFailure) return outcome;

  const Violation missed = MeasureViolation(problem, objective->Expand(*x));
  Eigen::VectorXd h;
  if (constraints.Residuals(objective->Expand(*x), &h) != Status::kOk) {
    return Outcome{StopReason::kNumericalFailure, "a constraint has no finite value"};
  }
  multipliers->Update(constraints, h);
  const double before = progress->violation;
  progress->violation = missed.largest;
  const bool meets = BookProjected(objective, context, *multipliers, progress, x);
  if (context->stop_reason() != StopReason::kNotRun) {
    return Outcome{context->stop_reason(), ""};
  }
  // Nocedal & Wright, framework 17.4: heavier where the constraints do not come nearer.
  constexpr double kNearer = 0.25;
  if (missed.largest > kConstraintTolerance && missed.largest > kNearer * before) {
    if (++progress->raises > kMostRaises && !meets) {
      return Outcome{StopReason::kInfeasible,
                     "no way is found from here to meet constraint " +
                         constraints.name(missed.constraint) + ", which is missed by " +
                         NumberText(missed.largest * problem.units().length)};
    }
    if (progress->raises <= kMostRaises) multipliers->Raise(kRaise);
    if (!meets && BringInside(*objective, x) && context->Iterate(*x) != Status::kOk) {
      return Outcome{context->stop_reason(), ""};
    }
  }
  if (meets && progress->idle_rounds >= kMostIdleRounds) {
    return Outcome{StopReason::kLineSearchEnded,
                   "the gradient of the Lagrangian no longer falls measurably"};
  }
  return std::nullopt;
}

bool AugmentedLagrangianSolver::BookProjected(Objective* objective, RunContext* context,
                                              const Multipliers& multipliers, Progress* progress,
                                              Eigen::VectorXd* x) const {
  const Problem& problem = objective->problem();
  Eigen::VectorXd projected = *x;
  if (!ProjectOntoConstraints(problem, multipliers.values(), &projected)) return false;
  double energy = 0.0;
  Eigen::VectorXd gradient;
  LagrangianGradient lagrangian;
  if (objective->EnergyAndGradient(projected, &energy, &gradient) != Status::kOk ||
      !MakeLagrangianGradient(problem, objective->Expand(projected), gradient, &lagrangian)) {
    return false;
  }
  x->swap(projected);
  const double norm = lagrangian.gradient.norm();
  progress->idle_rounds = norm < 0.5 * progress->least_gradient ? 0 : progress->idle_rounds + 1;
  progress->least_gradient = std::min(progress->least_gradient, norm);
  context->Iterate(*x);
  return true;
}

SolverEntry AugmentedLagrangianEntry() {
  return {AugmentedLagrangianSolver::ClassInfo(),
          [](const OptionValues& options, std::unique_ptr<Solver> base) -> std::unique_ptr<Solver> {
            return std::make_unique<AugmentedLagrangianSolver>(options, std::move(base));
          }};
}

}  // namespace batten
