#include "solvers/joint_descent.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "problems/fit_problem.h"
#include "solvers/foot_projection.h"

namespace batten {
namespace {

constexpr double kFirstDamping = 1e-3;
constexpr double kLeastDamping = 1e-12;
constexpr int kMostTries = 40;
constexpr double kMeasurable = 8.0;  // fall of E, in what rounding may leave of a difference
// A step that lowers E by a smaller part of it is late in a run: the first ones Gauss and Newton's
// equations are best at.
constexpr double kLateFall = 1e-6;

}  // namespace

std::string WhyNoFreeView(const Objective& objective, const std::string& name) {
  if (objective.free_view() != nullptr) return "";
  std::string why = WhyNoNonlinearConstraints(objective.problem(), name);
  if (!why.empty()) return why;
  const CurveFit* fit = objective.problem().curve_fit();
  if (fit == nullptr) return name + " needs a curve with free parameters; use lbfgs";
  if (!fit->has_free_parameters() && !fit->is_projected()) {
    return name + " needs free parameters; here they are fixed, use banded_cholesky or lbfgs";
  }
  if (objective.problem().has_bounds()) return WhyNoBounds(objective, name);
  std::string why_no_order = WhyNoOrder(objective.problem(), name);
  if (!why_no_order.empty()) return why_no_order;
  return name +
         " takes one free_parameter or foot_point term, terms in control points, and constraints "
         "that are linear in the control points or hold parameters; use lbfgs";
}

std::string WhyNoFreeParameters(const Objective& objective, const std::string& name) {
  std::string why = WhyNoFreeView(objective, name);
  if (!why.empty() || !objective.free_view()->projected()) return why;
  return name + " moves parameters by itself, but here they are projected; use newton or lm_schur";
}

std::string JointDescent::WhyUnsupported(const Objective& objective) const {
  return WhyNoFreeView(objective, Info().name);
}

std::vector<double> JointDescent::State() const {
  return {damping_, growth_, fall_, here_->parameter_damping()};
}

void JointDescent::Restore(const std::vector<double>& state) {
  damping_ = state[0];
  growth_ = state[1];
  fall_ = state[2];
  // The run that was left stood where this one's start was given: no move of set-up belongs to it.
  all_ = given_;
  here_->Sum(all_, kind_, state[3]);
}

/// What rounding leaves of a difference of E.
double JointDescent::Noise(double energy) const {
  return Objective::EnergyRoundingFloor(energy, 2.0 * std::sqrt(here_->scale()));
}

bool JointDescent::AllowSum(FootModelKind kind, const Eigen::VectorXd& free) {
  if (!objective()->Allow(Evaluation::kJacobian, &free)) return false;
  for (int k = here_->NumProducts(kind); k > 0; --k) {
    if (!objective()->Allow(Evaluation::kProduct, nullptr)) return false;
  }
  return true;
}

Status JointDescent::SumHere(FootModelKind kind) {
  FreeVariablesOf(*objective(), all_, &free_);
  if (!AllowSum(kind, free_)) return Status::kStop;
  return here_->Sum(all_, kind, damping_) ? Status::kOk : Status::kNonFinite;
}

/// For the sums at a point that is not taken yet: as if the step were as good as can be.
double JointDescent::ParameterDamping() const { return std::max(damping_ / 3.0, kLeastDamping); }

std::optional<Outcome> JointDescent::DoStart(Eigen::VectorXd* x) {
  const FreeView& view = *objective()->free_view();
  here_ = std::make_unique<FootModel>(view, context()->threads());
  there_ = std::make_unique<FootModel>(view, context()->threads());
  damping_ = kFirstDamping;
  growth_ = 2.0;
  fall_ = 1.0;
  given_ = AllWithParameters(*objective(), *x);
  Status status = Project(&given_);
  if (status != Status::kOk) return Ended(status);
  Eigen::VectorXd all = given_;
  if (!view.projected()) status = CompleteStart(*x, &all);
  if (status == Status::kOk) status = GoTo(all, x);
  if (status != Status::kOk) return Ended(status);
  return std::nullopt;
}

Status JointDescent::GoTo(const Eigen::VectorXd& all, Eigen::VectorXd* x) {
  all_ = all;
  const Status status = SumHere(kind_);
  if (status == Status::kOk) *x = free_;  // as SumHere has left them
  return status;
}

Status JointDescent::Project(Eigen::VectorXd* all) {
  if (!objective()->free_view()->projected()) return Status::kOk;
  const Eigen::VectorXd free = FreeVariablesOf(*objective(), *all);
  // Not from where the last step leaves them: what is found is a function of the control points.
  *all = AllWithParameters(*objective(), free);
  return ProjectParameters(objective(), context()->threads(), free, all);
}

/// Late in a run a Hessian that is not positive definite is that of a saddle, whose directions of
/// descent Gauss and Newton's does not know: its steps crawl away from there. As much damping as
/// makes the Hessian positive definite leads along them.
bool JointDescent::Factor() {
  at_saddle_ = false;
  if (here_->Factor(damping_)) return true;
  if (here_->kind() != FootModelKind::kNewton || fall_ > kLateFall) return false;
  constexpr double kFirstOfSaddle = 1e-9, kMostOfSaddle = 1e3, kMore = 10.0;
  double damping = std::max(kMore * damping_, kFirstOfSaddle);
  while (damping < kMostOfSaddle && !here_->Factor(damping)) damping *= kMore;
  if (damping >= kMostOfSaddle) return false;
  damping_ = damping;
  at_saddle_ = true;
  return true;
}

/// Where the step goes hardly along the direction in which the Hessian is least, it would end in
/// the saddle.
void JointDescent::LeaveSaddle() {
  constexpr double kLeast = 1e-3;  // of the data's size
  here_->LeastDirection(&away_);
  const double along = step_.dot(away_);
  if (std::abs(along) < kLeast) step_ += (along < 0.0 ? -kLeast : kLeast) * away_;
}

Status JointDescent::Propose() {
  if (!Factor()) return Status::kNonFinite;
  here_->Solve(&step_);
  if (at_saddle_) LeaveSaddle();
  if (!step_.allFinite()) return Status::kNonFinite;
  decrease_ = here_->Move(all_, step_, &next_);
  if (!next_.allFinite()) return Status::kNonFinite;
  if (objective()->free_view()->projected()) return Project(&next_);
  const Status status = Complete(&next_);
  if (status != Status::kOk) return status;
  // The bits of a run that is resumed here: a sum of steps leaves the constraints by rounding.
  objective()->problem().elimination().Determine(&next_);
  return Status::kOk;
}

void JointDescent::Take(Eigen::VectorXd* x) {
  growth_ = 2.0;
  all_.swap(next_);
  here_.swap(there_);
  *x = free_;
}

std::optional<Outcome> JointDescent::DoStep(Eigen::VectorXd* x) {
  for (int tried = 0; tried < kMostTries; ++tried) {
    const Status proposed = Propose();
    if (proposed == Status::kStop) return Ended(proposed);
    if (proposed == Status::kNonFinite) {
      // Newton's Hessian need not be positive definite; Gauss and Newton's is.
      const bool falls_back =
          kind_ == FootModelKind::kNewton && here_->kind() == FootModelKind::kNewton;
      if (!falls_back) damping_ = std::max(10.0 * damping_, kFirstDamping);
      const Status status = SumHere(falls_back ? FootModelKind::kTangent : here_->kind());
      if (status != Status::kOk) return Ended(status);
      continue;
    }
    FreeVariablesOf(*objective(), next_, &free_);
    if (!AllowSum(kind_, free_)) return Ended(Status::kStop);
    const double before = here_->energy();
    const bool finite = there_->Sum(next_, kind_, ParameterDamping());
    const double fall = before - there_->energy();
    const double noise = Noise(before);
    // Where differences of E are rounding, the gradient tells whether a step was good.
    const bool is_noise = std::abs(fall) <= noise && decrease_ <= noise;
    const bool is_better =
        is_noise ? there_->free_half_gradient().norm() < here_->free_half_gradient().norm()
                 : fall > 0.0;
    if (finite && is_better) {
      if (!is_noise) {
        const double change = std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * fall / decrease_ - 1.0, 3));
        damping_ = std::max(damping_ * change, kLeastDamping);
      }
      fall_ = fall / before;
      Take(x);
      return std::nullopt;
    }
    damping_ = std::max(damping_ * growth_, kLeastDamping);
    growth_ *= 2.0;
    const Status status = SumHere(kind_);
    if (status != Status::kOk) return Ended(status);
  }
  const Status status = GoAlongGradient(x);
  if (status == Status::kOk) return std::nullopt;
  if (status == Status::kStop) return Ended(status);
  return Outcome{StopReason::kLineSearchEnded, "no step lowers E measurably"};
}

/// Where the curve is a point, or at another saddle that no model leads away from, long steps may
/// lower E though g is small.
Status JointDescent::GoAlongGradient(Eigen::VectorXd* x) {
  constexpr double kLongest = 0.1, kShorter = 0.1;  // of the data's size
  constexpr int kLengths = 6;
  const double before = here_->energy();
  FreeVariablesOf(*objective(), all_, &free_);
  const Eigen::VectorXd from = free_;
  double energy = 0.0;
  Eigen::VectorXd gradient;
  Status status = objective()->EnergyAndGradient(from, &energy, &gradient);
  if (status != Status::kOk) return status;
  double length = kLongest;
  for (int k = 0; k < kLengths; ++k, length *= kShorter) {
    free_ = from - length * gradient.stableNormalized();
    next_ = AllWithParameters(*objective(), free_);
    status = Project(&next_);
    if (status == Status::kOk && !AllowSum(kind_, free_)) status = Status::kStop;
    if (status != Status::kOk) return status;
    if (!there_->Sum(next_, kind_, ParameterDamping())) continue;
    if (!(before - there_->energy() > kMeasurable * Noise(before))) continue;
    damping_ = kFirstDamping;
    Take(x);
    return Status::kOk;
  }
  return Status::kNonFinite;
}

}  // namespace batten
