#include "experiments/comparison_reference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "problems/fit_problem.h"
#include "splines/banded_cholesky.h"
#include "splines/nearest_solution.h"

namespace batten {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

}  // namespace

DirectReference::DirectReference(const Problem& problem)
    : problem_(&problem), objective_(&problem, nullptr) {
  CurveView* view = objective_.curve_view();
  if (view == nullptr || problem.has_bounds()) return;
  const Eigen::VectorXd start = objective_.start();
  const Points start_points =
      Eigen::Map<const Points>(start.data(), view->num_points(), view->dimension());
  const NearestSolution solution = SolveNearest(view->row_source(), start_points);
  if (!solution.control_points.allFinite()) return;
  known_ = true;
  unique_ = solution.unique;
  minimum_ = Eigen::Map<const Eigen::VectorXd>(solution.control_points.data(), start.size());
  if (const CurveFit* fit = problem.curve_fit()) {
    scaled_size_ = fit->size() * fit->setting().scale;
  }
}

double DirectReference::StartProduct() const {
  if (start_product_ >= 0.0) return start_product_;
  const Eigen::VectorXd v = objective_.start() - minimum_;
  const double product = objective_.curve_view()->rows().SquaredNormOfProduct(v.data());
  start_product_ = product > SquaredProductFloor() ? product : 0.0;
  return start_product_;
}

double DirectReference::GradientAtMinimum() const {
  if (gradient_at_minimum_ >= 0.0) return gradient_at_minimum_;
  Eigen::VectorXd gradient;
  double energy = 0.0;
  objective_.EnergyAndGradient(minimum_, &energy, &gradient);
  gradient_at_minimum_ = gradient.norm() + objective_.GradientRoundingFloor(minimum_);
  return gradient_at_minimum_;
}

/// ||A(P - P*)||^2 below this is rounding of P and P*: some 16 roundings of every product.
double DirectReference::SquaredProductFloor() const {
  const Eigen::VectorXd size = minimum_.cwiseAbs() + objective_.start().cwiseAbs();
  constexpr double kRoundings = 16.0;
  return std::pow(kRoundings * kEpsilon, 2) *
         objective_.curve_view()->rows().SquaredNormOfProduct(size.data());
}

double DirectReference::minimum_energy() const {
  if (!known_) return NAN;
  return objective_.curve_view()->rows().Evaluate(minimum_.data(), nullptr) *
         problem_->units().energy;
}

Eigen::VectorXd DirectReference::FromMinimum(const Eigen::VectorXd& x) const {
  const LinearElimination& elimination = problem_->elimination();
  return (elimination.trivial() ? x : elimination.FreeVariables(x)) - minimum_;
}

double DirectReference::Gap(const Eigen::VectorXd& x) const {
  if (!known_ || x.size() != problem_->num_variables() || StartProduct() == 0.0) return NAN;
  const Eigen::VectorXd v = FromMinimum(x);
  return objective_.curve_view()->rows().SquaredNormOfProduct(v.data()) / StartProduct();
}

double DirectReference::Excess(const Eigen::VectorXd& x) const {
  if (!known_) return NAN;
  const Eigen::VectorXd v = FromMinimum(x);
  Eigen::VectorXd product(v.size());
  objective_.curve_view()->normal_band().Multiply(v.data(), product.data());
  const double square = v.dot(product);
  // A sum of rounded products can fall below zero; NaN stays.
  return (square < 0.0 ? 0.0 : square) * problem_->units().energy;
}

double DirectReference::LargestRowProduct(const Eigen::VectorXd& v) const {
  const CurveView& view = *objective_.curve_view();
  Points at_v(view.num_rows(), view.dimension());
  Points at_zero(view.num_rows(), view.dimension());
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(v.size());
  view.rows().Residuals(v.data(), at_v.data());
  view.rows().Residuals(zero.data(), at_zero.data());
  return (at_zero - at_v).rowwise().norm().maxCoeff();
}

double DirectReference::Distance(const Eigen::VectorXd& x) const {
  if (!known_ || x.size() != problem_->num_variables()) return NAN;
  const Eigen::VectorXd v = FromMinimum(x);
  if (!unique_) return LargestRowProduct(v) / scaled_size_;
  const Eigen::VectorXd moved = problem_->elimination().ExpandDirection(v);
  const CurveFit* const fit = problem_->curve_fit();
  const int d = fit == nullptr ? objective_.curve_view()->dimension() : fit->dimension();
  double largest = 0.0;
  for (Eigen::Index j = 0; j + d <= moved.size(); j += d) {
    const double distance = moved.segment(j, d).norm();
    if (!(distance <= largest)) largest = distance;  // keeps NaN
  }
  return largest / scaled_size_;
}

/// Inverse power iteration. It comes from above and need not settle on one vector: any in the space
/// of the small eigenvalues gives a quotient near them.
double DirectReference::SmallestEigenvalue() const {
  if (smallest_eigenvalue_ >= 0.0) return smallest_eigenvalue_;
  smallest_eigenvalue_ = 0.0;
  const NormalBand& band = objective_.curve_view()->normal_band();
  BandedCholesky factor;
  if (!factor.Factor(band)) return 0.0;
  constexpr int kIterations = 30;
  std::mt19937 random(20240319);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Eigen::VectorXd v(band.size());
  for (double& entry : v) entry = uniform(random);
  for (int i = 0; i < kIterations; ++i) {
    v.normalize();
    const Eigen::VectorXd before = v;
    factor.Solve(v.data(), 1);
    smallest_eigenvalue_ = 1.0 / before.dot(v);
  }
  if (!(smallest_eigenvalue_ > 0.0)) smallest_eigenvalue_ = 0.0;
  return smallest_eigenvalue_;
}

// g(P) - g(P*) = 2 N (P - P*), with both gradients known as far as they are not rounding. Hence
//   ||P - P*|| <= (|g(P)| + |g(P*)|) / (2 lambda_min(N)),
// and, where N is singular, ||A(P - P*)||^2 = (g(P) - g(P*))'(P - P*) / 2
//   <= (|g(P)| + |g(P*)|) ||P - P*|| / 2.
// Both are doubled, because lambda_min is found from above, and a few roundings of P added.
double DirectReference::AllowedDistance(const RunResult& run) const {
  constexpr double kSafety = 2.0;
  constexpr double kRoundings = 16.0;
  if (!known_) return std::numeric_limits<double>::infinity();
  const double gradient =
      (run.gradient_norm + run.gradient_floor) / problem_->units().gradient + GradientAtMinimum();
  const double rounding = kRoundings * kEpsilon * (minimum_.norm() + scaled_size_);
  if (unique_) {
    const double eigenvalue = SmallestEigenvalue();
    if (eigenvalue == 0.0) return std::numeric_limits<double>::infinity();
    // Through constraints' elimination a moved free variable can move others, as far as Z says.
    const LinearElimination& elimination = problem_->elimination();
    const double stretch = elimination.trivial() ? 1.0 : std::max(1.0, elimination.z().norm());
    return (kSafety * stretch * gradient / (2.0 * eigenvalue) + rounding) / scaled_size_;
  }
  const double moved = FromMinimum(run.x).norm();
  const double row_rounding = rounding * std::sqrt(objective_.curve_view()->num_rows());
  return (kSafety * std::sqrt(gradient * moved / 2.0) + row_rounding) / scaled_size_;
}

}  // namespace batten
