#include "solvers/joint_descent.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "problems/fit_problem.h"

namespace batten {
namespace {

constexpr double kFirstDamping = 1e-3;
constexpr double kLeastDamping = 1e-12;
constexpr int kMostTries = 40;

}  // namespace

std::string WhyNoFreeView(const Objective& objective, const std::string& name) {
  if (objective.free_view() != nullptr) return "";
  const CurveFit* fit = objective.problem().curve_fit();
  if (fit == nullptr || !fit->has_free_parameters()) {
    return name + " needs free parameters; here they are fixed, use banded_cholesky or lbfgs";
  }
  return name + " takes one free_parameter term without loss and terms that are affine; use lbfgs";
}

std::string JointDescent::WhyUnsupported(const Objective& objective) const {
  return WhyNoFreeView(objective, Info().name);
}

std::vector<double> JointDescent::State() const {
  return {damping_, growth_, least_gradient_, static_cast<double>(waited_),
          here_->kind() == kind_ ? 0.0 : 1.0};
}

void JointDescent::Restore(const std::vector<double>& state) {
  damping_ = state[0];
  growth_ = state[1];
  least_gradient_ = state[2];
  waited_ = static_cast<int>(state[3]);
}

/// Where differences of E are rounding, steps are taken as long as they bring the gradient down.
bool JointDescent::GradientNoLongerFalls() {
  constexpr int kPatience = 50;
  const double norm = there_->half_gradient().norm();
  if (norm < least_gradient_) {
    least_gradient_ = norm;
    waited_ = 0;
  }
  return ++waited_ > kPatience;
}

bool JointDescent::SumHere(FootModelKind kind) { return here_->Sum(all_, kind, damping_); }

/// For the sums at a point that is not taken yet: as if the step were as good as can be.
double JointDescent::ParameterDamping() const { return std::max(damping_ / 3.0, kLeastDamping); }

std::optional<Outcome> JointDescent::DoStart(Eigen::VectorXd* x) {
  const FreeView& view = *objective()->free_view();
  here_ = std::make_unique<FootModel>(view, context()->threads());
  there_ = std::make_unique<FootModel>(view, context()->threads());
  damping_ = kFirstDamping;
  growth_ = 2.0;
  least_gradient_ = std::numeric_limits<double>::infinity();
  waited_ = 0;
  all_ = objective()->Expand(*x);
  if (!Complete(&all_)) return Ended(Status::kNonFinite);
  *x = objective()->problem().elimination().FreeVariables(all_);
  if (!objective()->Allow(Evaluation::kJacobian, x)) return Ended(Status::kStop);
  if (!SumHere(kind_)) return Ended(Status::kNonFinite);
  return std::nullopt;
}

bool JointDescent::Propose() {
  if (!here_->Factor(damping_)) return false;
  here_->Solve(&step_);
  if (!step_.allFinite()) return false;
  decrease_ = here_->Move(all_, step_, &next_);
  return next_.allFinite() && Complete(&next_);
}

std::optional<Outcome> JointDescent::DoStep(Eigen::VectorXd* x) {
  for (int tried = 0; tried < kMostTries; ++tried) {
    if (!Propose()) {
      // Newton's Hessian need not be positive definite; Gauss and Newton's is.
      if (kind_ == FootModelKind::kNewton && here_->kind() == FootModelKind::kNewton) {
        if (!SumHere(FootModelKind::kTangent)) return Ended(Status::kNonFinite);
      } else {
        damping_ = std::max(10.0 * damping_, kFirstDamping);
        if (!SumHere(here_->kind())) return Ended(Status::kNonFinite);
      }
      continue;
    }
    const Eigen::VectorXd free = objective()->problem().elimination().FreeVariables(next_);
    if (!objective()->Allow(Evaluation::kJacobian, &free)) return Ended(Status::kStop);
    const double before = here_->energy();
    const bool finite = there_->Sum(next_, kind_, ParameterDamping());
    const double fall = before - there_->energy();
    // What rounding leaves of a difference of E.
    const double noise = 64.0 * std::numeric_limits<double>::epsilon() * (before + here_->scale());
    const bool is_noise = std::abs(fall) <= noise && decrease_ <= noise;
    if (finite && (fall > 0.0 || is_noise)) {
      if (is_noise && GradientNoLongerFalls()) break;
      const double ratio = is_noise ? 1.0 : fall / decrease_;
      damping_ = std::max(damping_ * std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * ratio - 1.0, 3)),
                          kLeastDamping);
      growth_ = 2.0;
      all_.swap(next_);
      here_.swap(there_);
      *x = free;
      return std::nullopt;
    }
    damping_ = std::max(damping_ * growth_, kLeastDamping);
    growth_ *= 2.0;
    if (!SumHere(kind_)) return Ended(Status::kNonFinite);
  }
  return Outcome{StopReason::kLineSearchEnded, "no step lowers E measurably"};
}

}  // namespace batten
