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

void JointDescent::Restore(const std::vector<double>& state) {
  damping_ = state[0];
  growth_ = state[1];
  SumHere(kind_);
}

bool JointDescent::SumHere(FootModelKind kind) { return here_->Sum(all_, kind, damping_); }

std::optional<Outcome> JointDescent::DoStart(Eigen::VectorXd* x) {
  const FreeView& view = *objective()->free_view();
  here_ = std::make_unique<FootModel>(view, context()->threads());
  there_ = std::make_unique<FootModel>(view, context()->threads());
  damping_ = kFirstDamping;
  growth_ = 2.0;
  all_ = objective()->Expand(*x);
  if (!objective()->Allow(Evaluation::kJacobian, x)) return Ended(Status::kStop);
  if (!SumHere(kind_)) return Ended(Status::kNonFinite);
  return std::nullopt;
}

bool JointDescent::Propose() {
  if (!here_->Factor(damping_)) return false;
  here_->Solve(&step_);
  if (!step_.allFinite()) return false;
  decrease_ = here_->Move(all_, step_, &next_);
  return next_.allFinite();
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
    const bool finite = there_->Sum(next_, kind_, std::max(damping_ / 3.0, kLeastDamping));
    const double fall = before - there_->energy();
    // What rounding leaves of a difference of E.
    const double noise = 64.0 * std::numeric_limits<double>::epsilon() * (before + here_->scale());
    const bool is_noise = std::abs(fall) <= noise && decrease_ <= noise;
    const bool taken = finite && (fall > 0.0 || (is_noise && there_->half_gradient().norm() <=
                                                                 here_->half_gradient().norm()));
    if (taken) {
      const double ratio = is_noise ? 1.0 : fall / decrease_;
      damping_ = std::max(damping_ * std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * ratio - 1.0, 3)),
                          kLeastDamping);
      growth_ = 2.0;
      all_.swap(next_);
      here_.swap(there_);
      *x = free;
      return std::nullopt;
    }
    if (is_noise) break;
    damping_ = std::max(damping_ * growth_, kLeastDamping);
    growth_ *= 2.0;
    if (!SumHere(kind_)) return Ended(Status::kNonFinite);
  }
  return Outcome{StopReason::kLineSearchEnded, "no step lowers E measurably"};
}

}  // namespace batten
