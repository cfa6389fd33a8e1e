#include "solvers/exact_newton.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solvers/newton.h"

namespace batten {
namespace {

constexpr double kFirstDamping = 1e-3;
constexpr int kMostTries = 40;

}  // namespace

SolverInfo ExactNewton::Info() const { return NewtonSolver::ClassInfo(); }

std::string ExactNewton::WhyNot(const Objective& objective, const std::string& name) {
  const Problem& problem = objective.problem();
  std::string why = WhyNoBounds(objective, name);
  if (!why.empty()) return why;
  const CurveFit* fit = problem.curve_fit();
  if (fit == nullptr) return name + " needs a curve, whose Hessian is a band; use lbfgs";
  if (problem.num_variables() != fit->basis().num_control_points() * fit->dimension()) {
    return name + " needs terms in control points alone; use lbfgs";
  }
  return "";
}

std::optional<Outcome> ExactNewton::DoStart(Eigen::VectorXd* x) {
  const Problem& problem = objective()->problem();
  std::vector<const BlockFamily*> terms;
  for (const Problem::TermInstance& term : problem.terms()) terms.push_back(term.family.get());
  const CurveFit& fit = *problem.curve_fit();
  hessian_.emplace(fit.basis(), fit.dimension(), fit.setting().control_point_offset,
                   std::move(terms), problem.start());
  free_band_.reset();
  if (!problem.elimination().trivial()) {
    free_band_.emplace(hessian_->shape(), hessian_->dimension(), &problem.elimination().z());
  }
  damping_ = 0.0;
  const Status status = objective()->EnergyAndGradient(*x, &energy_, &gradient_);
  if (status != Status::kOk) return Ended(status);
  return std::nullopt;
}

void ExactNewton::RaiseDamping() { damping_ = std::max(10.0 * damping_, kFirstDamping); }

bool ExactNewton::FindStep(Eigen::VectorXd* step) {
  damped_ = hessian_->band();
  const auto width = static_cast<std::size_t>(damped_.width());
  double mean = 0.0;
  for (int k = 0; k < damped_.size(); ++k) mean += std::abs(damped_.band()[k * width]);
  mean /= damped_.size();
  for (int k = 0; k < damped_.size(); ++k) {
    double& entry = damped_.band()[k * width];
    // What no term sees has no diagonal of its own.
    constexpr double kLeast = 1e-3;
    entry += damping_ * std::max(std::abs(entry), kLeast * mean);
  }
  *step = -gradient_;
  if (step->size() == 0) return true;
  if (free_band_.has_value()) free_band_->Sum(damped_);
  if (!factor_.Factor(free_band_.has_value() ? free_band_->band() : damped_)) return false;
  factor_.Solve(step->data(), 1);
  return step->allFinite();
}

std::optional<Outcome> ExactNewton::DoStep(Eigen::VectorXd* x) {
  Status status = hessian_->Sum(objective()->Expand(*x), [this] {
    return objective()->Allow(Evaluation::kProduct, nullptr);
  });
  if (status != Status::kOk) return Ended(status);
  const double size = objective()->ResidualSize(*x);
  Eigen::VectorXd step, next_gradient;
  for (int tried = 0; tried < kMostTries; ++tried) {
    if (!FindStep(&step)) {
      RaiseDamping();
      continue;
    }
    const Eigen::VectorXd next = *x + step;
    double energy = 0.0;
    status = objective()->EnergyAndGradient(next, &energy, &next_gradient);
    if (status == Status::kStop) return Ended(status);
    const double fall = energy_ - energy;
    // E(x) - E(x + s) of the quadratic model, less what damping keeps back: -g's / 2 and more.
    const double foretold = -0.5 * gradient_.dot(step);
    const double noise = Objective::EnergyRoundingFloor(energy_, size);
    const bool is_noise = std::abs(fall) <= noise && foretold <= noise;
    const bool is_better = is_noise ? next_gradient.norm() < gradient_.norm() : fall > 0.0;
    if (status == Status::kOk && is_better) {
      constexpr double kAsForetold = 0.75;
      if (is_noise || fall > kAsForetold * foretold) {
        damping_ = damping_ <= kFirstDamping ? 0.0 : 0.1 * damping_;
      }
      *x = next;
      energy_ = energy;
      gradient_.swap(next_gradient);
      return std::nullopt;
    }
    RaiseDamping();
  }
  return Outcome{StopReason::kLineSearchEnded, "no step lowers E measurably"};
}

}  // namespace batten
