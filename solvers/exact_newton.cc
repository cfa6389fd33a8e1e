#include "solvers/exact_newton.h"

#include <algorithm>
#include <cmath>

#include "solvers/newton.h"

namespace batten {
namespace {

constexpr double kFirstDamping = 1e-3;
constexpr int kMostTries = 40;

RowShape BandShape(const BsplineBasis& basis, int dimension, int reach) {
  RowShape shape;
  shape.num_columns = basis.num_control_points() * dimension;
  shape.width = (std::min(reach, basis.num_control_points() - 1) + 1) * dimension;
  shape.dimension = 1;
  shape.cyclic = basis.periodic() && 2 * reach + 1 <= basis.num_control_points();
  return shape;
}

}  // namespace

HessianBand::HessianBand(const Problem& problem)
    : problem_(problem),
      basis_(problem.curve_fit()->basis()),
      dimension_(problem.curve_fit()->dimension()),
      reach_(LargestReach()),
      shape_(BandShape(basis_, dimension_, reach_)),
      band_(shape_) {
  MakeColours();
}

/// Of blocks on closed curves the way around counts where it is shorter. Where a curve has so few
/// control points that ways around meet, all of them meet.
int HessianBand::LargestReach() const {
  const int n = basis_.num_control_points();
  const Eigen::VectorXd& x = problem_.start();
  std::vector<int> offsets, sizes;
  int reach = 0;
  for (const Problem::TermInstance& term : problem_.terms()) {
    for (int block = 0; block < term.family->size(); ++block) {
      term.family->Bind(x, block, &offsets, &sizes);
      for (const int a : offsets) {
        for (const int b : offsets) {
          const int apart = std::abs(a - b) / dimension_;
          reach = std::max(reach, basis_.periodic() ? std::min(apart, n - apart) : apart);
        }
      }
    }
  }
  return basis_.periodic() && 2 * reach + 1 > n ? n - 1 : reach;
}

/// Runs of about equal length, each of as many control points as meet or more: points that have the
/// same place in their runs do not.
void HessianBand::MakeColours() {
  const int n = basis_.num_control_points();
  const int num_runs = std::max(1, n / (2 * reach_ + 1));
  colours_.resize(static_cast<std::size_t>(n));
  for (int run = 0; run < num_runs; ++run) {
    const int begin = static_cast<int>(static_cast<long long>(n) * run / num_runs);
    const int end = static_cast<int>(static_cast<long long>(n) * (run + 1) / num_runs);
    for (int j = begin; j < end; ++j) colours_[static_cast<std::size_t>(j)] = j - begin;
    num_colours_ = std::max(num_colours_, end - begin);
  }
}

/// From the rows at and before it: row i's entry k stands for column i + k.
void HessianBand::SetColumn(int j, int c, const Eigen::VectorXd& product) {
  const int n = basis_.num_control_points(), d = dimension_, width = band_.width();
  for (int back = 0; back <= reach_; ++back) {
    const int i = j - back >= 0 || !band_.cyclic() ? j - back : j - back + n;
    if (i < 0) break;
    for (int e = 0; e < d; ++e) {
      const int row = i * d + e;
      const int k = back * d + c - e;
      if (k >= 0) band_.band()[static_cast<std::size_t>(row) * width + k] = product[row];
    }
  }
}

bool HessianBand::Sum(Objective* objective, const Eigen::VectorXd& all, Status* status) {
  const int n = basis_.num_control_points(), d = dimension_;
  Eigen::VectorXd direction(all.size()), product(all.size());
  std::fill(band_.band().begin(), band_.band().end(), 0.0);
  for (int colour = 0; colour < num_colours_; ++colour) {
    for (int c = 0; c < d; ++c) {
      direction.setZero();
      product.setZero();
      for (int j = 0; j < n; ++j) {
        if (colours_[static_cast<std::size_t>(j)] == colour) direction[j * d + c] = 1.0;
      }
      *status = objective->Allow(Evaluation::kProduct, nullptr) ? Status::kOk : Status::kStop;
      for (const Problem::TermInstance& term : problem_.terms()) {
        if (*status != Status::kOk) return false;
        *status = term.family->AddHessianTimes(all, direction, &product);
      }
      if (*status == Status::kOk && !product.allFinite()) *status = Status::kNonFinite;
      if (*status != Status::kOk) return false;
      for (int j = 0; j < n; ++j) {
        if (colours_[static_cast<std::size_t>(j)] == colour) SetColumn(j, c, product);
      }
    }
  }
  return true;
}

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
  hessian_.emplace(problem);
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
  Status status = Status::kOk;
  if (!hessian_->Sum(objective(), objective()->Expand(*x), &status)) return Ended(status);
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
