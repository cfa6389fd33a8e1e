#ifndef BATTEN_TESTS_COST_FUNCTIONS_EXAMPLE_FIT_H_
#define BATTEN_TESTS_COST_FUNCTIONS_EXAMPLE_FIT_H_

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include "cost_functions/block_family.h"
#include "cost_functions/fit_setting.h"
#include "splines/parameterization.h"
#include "tests/splines/example_splines.h"

namespace batten {

/// Central differences: h^2 by truncation and eps / h by rounding are alike at this step.
inline const double kStep = std::cbrt(kEpsilon);
/// What they miss, for values and third derivatives of size 1.
inline const double kDifferenceTolerance = 10.0 * kStep * kStep;

/// Data without any symmetry around a spline, and where its control points stand in x: behind three
/// other variables and before one, which the data's parameters follow.
class ExampleFit {
 public:
  static constexpr int kOffset = 3;
  static constexpr double kRadius = 20.0;  ///< Of a round curve.

  ExampleFit(BsplineBasis spline, int dimension, int num_points, bool weighted,
             std::mt19937* random)
      : basis(std::move(spline)), points(RandomPoints(num_points, dimension, random)) {
    for (int i = 0; i < num_points; ++i) {
      parameters.push_back(i == 1 ? basis.domain_begin() : RandomParameter(basis, random));
      weights.push_back(i == 2 ? 0.0 : RandomBetween(0.2, 3.0, random));
    }
    const double centers[] = {0.15, -0.4, 0.33, 0.07};
    for (int c = 0; c < dimension; ++c) setting.center[c] = centers[c];
    setting.scale = 0.5;
    setting.basis = &basis;
    setting.dimension = dimension;
    setting.control_point_offset = kOffset;
    setting.parameter_offset = kOffset + basis.num_control_points() * dimension + 1;
    setting.data = &sites;
    sites.size = num_points;
    sites.parameters = parameters.data();
    sites.points = points.data();
    sites.weights = weighted ? weights.data() : nullptr;
    GroupBySpan(basis, IsNondecreasing(sites.parameters, sites.size), &sites);
  }
  ExampleFit(const ExampleFit&) = delete;
  ExampleFit& operator=(const ExampleFit&) = delete;

  int num_variables() const { return setting.parameter_offset + sites.size; }
  Eigen::VectorXd RandomVariables(std::mt19937* random) const {
    Eigen::VectorXd x(num_variables());
    for (double& entry : x) entry = RandomBetween(-1.0, 1.0, random);
    // Inside spans: at knots a curve of degree 1 or 2 has no second derivative.
    const std::vector<int> spans = NonEmptySpans(basis);
    for (int i = 0; i < sites.size; ++i) {
      const int span = spans[(*random)() % spans.size()];
      x[setting.parameter_offset + i] = InSpan(basis, span, RandomBetween(0.05, 0.95, random));
    }
    return x;
  }
  /// A wide and nearly round curve that passes the data, which are outside of it: each foot is the
  /// only one, and far from centres of curvature. In more than two dimensions it is a flat one; in
  /// one it runs over the data, so that distances are 0.
  Eigen::VectorXd RoundVariables(std::mt19937* random) const {
    // The data are within 1 of the origin.
    const double beside = setting.dimension == 1 ? -kRadius : 2.0;
    Eigen::VectorXd x = RandomVariables(random);
    for (int j = 0; j < basis.num_control_points(); ++j) {
      const double part = (basis.Greville(j) - basis.domain_begin()) / basis.domain_length();
      const double place[] = {kRadius * (1.0 + std::cos(2.0 * M_PI * part)) + beside,
                              kRadius * std::sin(2.0 * M_PI * part), 0.0, 0.0};
      for (int c = 0; c < setting.dimension; ++c) {
        double& entry = x[kOffset + j * setting.dimension + c];
        entry = place[c] + 0.2 * entry;
      }
    }
    return x;
  }
  /// Bound of the third derivative of a curve with control points of size 1, at least 1.
  double Bend() const {
    double shortest = 1.0;
    for (const int span : NonEmptySpans(basis)) {
      shortest = std::min(shortest, basis.knots()[span + 1] - basis.knots()[span]);
    }
    return std::pow(2.0 * basis.degree() / shortest, 3);
  }
  double weight(int item) const { return sites.weights == nullptr ? 1.0 : weights[item]; }
  /// Q of one item, scaled.
  double Datum(int item, int c) const {
    return (points(item, c) - setting.center[c]) * setting.scale;
  }
  /// Coefficient of control point j in C(t) of one item, by the recursive definition.
  double Coefficient(int item, int j) const {
    const int n = basis.num_control_points();
    const int num_functions = basis.periodic() ? n + basis.degree() : n;
    long double sum = 0.0L;
    for (int function = j; function < num_functions; function += n) {
      sum += BasisByDefinition(basis.knots(), function, basis.degree(), parameters[item]);
    }
    return static_cast<double>(sum);
  }

  BsplineBasis basis;
  Points points;
  std::vector<double> parameters;
  std::vector<double> weights;
  Sites sites;
  FitSetting setting;
};

inline double EnergyAt(const BlockFamily& family, const Eigen::VectorXd& x) {
  double energy = 0.0;
  EXPECT_EQ(family.Evaluate(x, 0, family.size(), &energy, nullptr), Status::kOk);
  return energy;
}

inline Eigen::VectorXd GradientAt(const BlockFamily& family, const Eigen::VectorXd& x) {
  double energy = 0.0;
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(x.size());
  EXPECT_EQ(family.Evaluate(x, 0, family.size(), &energy, &gradient), Status::kOk);
  EXPECT_NEAR(energy, EnergyAt(family, x), 1e-13 * (1.0 + std::abs(energy)));
  return gradient;
}

inline Eigen::VectorXd ResidualsAt(const BlockFamily& family, const Eigen::VectorXd& x) {
  Eigen::VectorXd residuals;
  EXPECT_EQ(family.Residuals(x, &residuals), Status::kOk);
  return residuals;
}

inline Eigen::MatrixXd JacobianAt(const BlockFamily& family, const Eigen::VectorXd& x) {
  std::vector<Eigen::Triplet<double>> entries;
  EXPECT_EQ(family.Jacobian(x, 0, &entries), Status::kOk);
  SparseRows jacobian(family.size() * family.num_residuals(), x.size());
  jacobian.setFromTriplets(entries.begin(), entries.end());
  return jacobian;
}

inline Eigen::VectorXd HessianTimes(const BlockFamily& family, const Eigen::VectorXd& x,
                                    const Eigen::VectorXd& direction) {
  Eigen::VectorXd product = Eigen::VectorXd::Zero(x.size());
  EXPECT_EQ(family.AddHessianTimes(x, direction, &product), Status::kOk);
  return product;
}

/// Derivative of `function` along `direction`, by central differences.
inline Eigen::VectorXd Difference(
    const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& function,
    const Eigen::VectorXd& x, const Eigen::VectorXd& direction) {
  return (function(x + kStep * direction) - function(x - kStep * direction)) / (2.0 * kStep);
}

/// Gradient, Jacobian and Hessian products of a family against central differences at x.
inline void ExpectDerivativesOf(const BlockFamily& family, const Eigen::VectorXd& x,
                                std::mt19937* random, double third_derivative = 1.0) {
  const double size = third_derivative * (1.0 + EnergyAt(family, x));
  // A loss bounds E, but not the residuals.
  const double residual_size = size + third_derivative * ResidualsAt(family, x).norm();
  const Eigen::VectorXd gradient = GradientAt(family, x);
  const Eigen::MatrixXd jacobian = JacobianAt(family, x);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Eigen::VectorXd axis = Eigen::VectorXd::Unit(x.size(), i);
    const auto energy = [&](const Eigen::VectorXd& at) {
      return Eigen::VectorXd::Constant(1, EnergyAt(family, at));
    };
    const auto residuals = [&](const Eigen::VectorXd& at) { return ResidualsAt(family, at); };
    EXPECT_NEAR(gradient[i], Difference(energy, x, axis)[0], size * kDifferenceTolerance) << i;
    EXPECT_LT((jacobian.col(i) - Difference(residuals, x, axis)).norm(),
              residual_size * kDifferenceTolerance)
        << i;
  }
  Eigen::VectorXd direction(x.size());
  for (double& entry : direction) entry = RandomBetween(-1.0, 1.0, random);
  const auto gradients = [&](const Eigen::VectorXd& at) { return GradientAt(family, at); };
  // The direction is longer than 1, and third derivatives grow with its square.
  const double tolerance = size * direction.squaredNorm() * kDifferenceTolerance;
  EXPECT_LT((HessianTimes(family, x, direction) - Difference(gradients, x, direction)).norm(),
            tolerance);
}

/// The rows of a family, dense, over the control points.
class DenseRows : public RowConsumer {
 public:
  explicit DenseRows(const RowSource& source) : shape_(source.shape()) {
    matrix = Eigen::MatrixXd::Zero(shape_.num_rows, shape_.num_columns);
    right_hand_sides.resize(shape_.num_rows, shape_.dimension);
    source.Stream(this);
    EXPECT_EQ(next_row_, shape_.num_rows);
  }
  void Consume(const RowBlock& block) override {
    EXPECT_GE(block.first_column, last_column_);
    last_column_ = block.first_column;
    EXPECT_EQ(block.stride % kRowPack, 0);
    for (int i = 0; i < block.stride; ++i) {
      for (int j = 0; j < shape_.width; ++j) {
        const double entry = block.coefficients[j * block.stride + i];
        if (i < block.num_rows) {
          matrix(next_row_ + i, (block.first_column + j) % shape_.num_columns) += entry;
        } else {
          EXPECT_EQ(entry, 0.0) << "padding";
        }
      }
      for (int c = 0; c < shape_.dimension && i < block.num_rows; ++c) {
        right_hand_sides(next_row_ + i, c) = block.right_hand_sides[c * block.stride + i];
      }
    }
    next_row_ += block.num_rows;
  }
  Eigen::MatrixXd matrix;
  Eigen::MatrixXd right_hand_sides;

 private:
  RowShape shape_;
  int next_row_ = 0;
  int last_column_ = 0;
};

/// sqrt(weight) * residuals = A P - Q, and sqrt(weight) * Jacobian = A for every coordinate.
inline void ExpectRowsOf(const BlockFamily& family, const ExampleFit& fit,
                         const Eigen::VectorXd& x) {
  ASSERT_NE(family.rows(), nullptr);
  const DenseRows rows(*family.rows());
  const int d = fit.setting.dimension;
  const int n = fit.basis.num_control_points();
  const double root = std::sqrt(family.weight());
  const Eigen::Map<const Points> control_points(x.data() + ExampleFit::kOffset, n, d);
  const Points residuals = rows.matrix * control_points - rows.right_hand_sides;
  const Eigen::VectorXd expected = root * ResidualsAt(family, x);
  const Eigen::MatrixXd jacobian = root * JacobianAt(family, x);
  ASSERT_EQ(residuals.size(), expected.size());
  // Sums of p + 1 products, and the basis in packs instead of one by one.
  const double tolerance = 32 * (fit.basis.degree() + 1) * kEpsilon * (1.0 + jacobian.norm());
  EXPECT_LT((Eigen::Map<const Eigen::VectorXd>(residuals.data(), residuals.size()) - expected)
                .lpNorm<Eigen::Infinity>(),
            tolerance);
  for (Eigen::Index row = 0; row < jacobian.rows(); ++row) {
    for (int j = 0; j < n; ++j) {
      for (int c = 0; c < d; ++c) {
        const double alike = c == row % d ? rows.matrix(row / d, j) : 0.0;
        EXPECT_NEAR(jacobian(row, ExampleFit::kOffset + j * d + c), alike, tolerance);
      }
    }
  }
}

}  // namespace batten

#endif  // BATTEN_TESTS_COST_FUNCTIONS_EXAMPLE_FIT_H_
