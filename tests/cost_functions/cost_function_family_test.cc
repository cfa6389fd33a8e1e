#include "cost_functions/cost_function_family.h"

#include <ceres/autodiff_cost_function.h>
#include <ceres/problem.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/cost_functions/example_fit.h"
#include "tests/roundoff.h"

namespace batten {
namespace {

using ::testing::ElementsAre;

// Central differences at cbrt(eps): h^2 by truncation and eps / h by rounding, times values and
// derivatives that are below 50 for the functions here.
const double kFunctorsTolerance = 50.0 * kStep * kStep;

/// Two residuals in a point a and a number b, curved in both.
struct CurvedPair {
  template <typename T>
  bool operator()(const T* a, const T* b, T* residuals) const {
    using std::exp;
    residuals[0] = a[0] * a[0] * b[0] - shift;
    residuals[1] = exp(0.5 * a[1]) + b[0] * a[0];
    return true;
  }
  double shift;
};

struct Quadratic {
  template <typename T>
  bool operator()(const T* a, T* residuals) const {
    residuals[0] = 2.0 * a[0] - 1.0;
    residuals[1] = a[0] - 3.0 * a[1];
    return true;
  }
};

struct Failing {
  template <typename T>
  bool operator()(const T* a, T* residuals) const {
    residuals[0] = a[0];
    residuals[1] = a[1];
    return a[0] < T(0.0);
  }
};

std::unique_ptr<ceres::CostFunction> MakeCurvedPair(double shift) {
  return std::make_unique<ceres::AutoDiffCostFunction<CurvedPair, 2, 2, 1>>(new CurvedPair{shift});
}

/// x = (b, a, a'): three blocks, of which two share b.
std::unique_ptr<CostFunctionFamily> MakeFamily(double weight,
                                               std::shared_ptr<const ceres::LossFunction> loss) {
  auto family = std::make_unique<CostFunctionFamily>(weight, std::move(loss));
  family->AddBlock(MakeCurvedPair(0.7), {1, 0});
  family->AddBlock(MakeCurvedPair(-1.1), {3, 0});
  family->AddBlock(std::make_unique<ceres::AutoDiffCostFunction<Quadratic, 2, 2>>(new Quadratic),
                   {3});
  return family;
}

Eigen::VectorXd SomePoint() {
  Eigen::VectorXd x(5);
  x << 0.8, -0.6, 1.3, 0.45, -0.9;
  return x;
}

std::vector<std::shared_ptr<const ceres::LossFunction>> Losses() {
  return {nullptr, std::make_shared<ceres::HuberLoss>(0.5),
          std::make_shared<ceres::CauchyLoss>(1.5)};
}

TEST(CostFunctionFamily, BindsTheVariablesOfEachBlock) {
  const auto family = MakeFamily(1.0, nullptr);
  std::vector<int> offsets, sizes;
  family->Bind(SomePoint(), 1, &offsets, &sizes);
  EXPECT_EQ(family->size(), 3);
  EXPECT_EQ(family->num_residuals(), 2);
  EXPECT_THAT(offsets, ElementsAre(3, 0));
  EXPECT_THAT(sizes, ElementsAre(2, 1));
  EXPECT_EQ(family->rows(), nullptr);
}

TEST(CostFunctionFamily, SumsSquaresWithoutAFactorOfOneHalf) {
  const auto family = MakeFamily(3.0, nullptr);
  const Eigen::VectorXd x = SomePoint();
  // The formulas of the functors above, written out.
  const double first =
      std::pow(x[1] * x[1] * x[0] - 0.7, 2) + std::pow(std::exp(0.5 * x[2]) + x[0] * x[1], 2);
  const double second =
      std::pow(x[3] * x[3] * x[0] + 1.1, 2) + std::pow(std::exp(0.5 * x[4]) + x[0] * x[3], 2);
  const double third = std::pow(2.0 * x[3] - 1.0, 2) + std::pow(x[3] - 3.0 * x[4], 2);
  EXPECT_NEAR(EnergyAt(*family, x), 3.0 * (first + second + third), 64 * kEpsilon * third);

  double part = 0.0;
  ASSERT_EQ(family->Evaluate(x, 1, 2, &part, nullptr), Status::kOk);
  EXPECT_NEAR(part, 3.0 * second, 64 * kEpsilon * second);
}

TEST(CostFunctionFamily, GradientIsThatOfTheEnergyWithEachLoss) {
  for (const auto& loss : Losses()) {
    const auto family = MakeFamily(0.25, loss);
    const Eigen::VectorXd x = SomePoint();
    const Eigen::VectorXd gradient = GradientAt(*family, x);
    for (int i = 0; i < x.size(); ++i) {
      const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(x.size(), i);
      const double difference =
          (EnergyAt(*family, x + step) - EnergyAt(*family, x - step)) / (2.0 * kStep);
      EXPECT_NEAR(gradient[i], difference, kFunctorsTolerance) << i;
    }
  }
}

TEST(CostFunctionFamily, JacobianAndResidualsStandWhereTheirBlocksDo) {
  const auto family = MakeFamily(2.0, std::make_shared<ceres::HuberLoss>(0.1));
  const Eigen::VectorXd x = SomePoint();
  std::vector<Eigen::Triplet<double>> entries;
  ASSERT_EQ(family->Jacobian(x, 4, &entries), Status::kOk);
  SparseRows jacobian(10, x.size());
  jacobian.setFromTriplets(entries.begin(), entries.end());
  EXPECT_EQ(jacobian.topRows(4).nonZeros(), 0) << "rows are numbered from first_row";
  for (int i = 0; i < x.size(); ++i) {
    const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(x.size(), i);
    Eigen::VectorXd after, before;
    ASSERT_EQ(family->Residuals(x + step, &after), Status::kOk);
    ASSERT_EQ(family->Residuals(x - step, &before), Status::kOk);
    const Eigen::VectorXd difference = (after - before) / (2.0 * kStep);
    EXPECT_LT((jacobian.col(i).bottomRows(6) - difference).norm(), kFunctorsTolerance) << i;
  }
}

TEST(CostFunctionFamily, GivesCeresTheSameEnergyAndGradient) {
  for (const auto& loss : Losses()) {
    const auto family = MakeFamily(0.3, loss);
    Eigen::VectorXd x = SomePoint();
    ceres::Problem problem;
    for (const auto& [offset, size] : {std::pair(0, 1), std::pair(1, 2), std::pair(3, 2)}) {
      problem.AddParameterBlock(x.data() + offset, size);
    }
    for (int block = 0; block < family->size(); ++block) {
      std::vector<int> offsets, sizes;
      family->Bind(x, block, &offsets, &sizes);
      std::vector<double*> parameters;
      for (const int offset : offsets) parameters.push_back(x.data() + offset);
      problem.AddResidualBlock(family->MakeCeresCostFunction(x, block).release(),
                               family->MakeCeresLoss().release(), parameters);
    }
    double cost = 0.0;
    std::vector<double> gradient;
    ASSERT_TRUE(
        problem.Evaluate(ceres::Problem::EvaluateOptions(), &cost, nullptr, &gradient, nullptr));
    EXPECT_EQ(2.0 * cost, EnergyAt(*family, x));
    const Eigen::VectorXd ours = GradientAt(*family, x);
    const double tolerance = 32 * kEpsilon * ours.norm();  // sums of up to six products
    for (int i = 0; i < x.size(); ++i) EXPECT_NEAR(2.0 * gradient[i], ours[i], tolerance) << i;
  }
}

TEST(CostFunctionFamily, CeresCostFunctionsOutliveTheFamily) {
  auto family = MakeFamily(1.0, nullptr);
  const std::unique_ptr<ceres::CostFunction> cost = family->MakeCeresCostFunction(SomePoint(), 2);
  family.reset();
  const double a[] = {0.3, -1.7};
  const double* parameters[] = {a};
  double residuals[2];
  ASSERT_TRUE(cost->Evaluate(parameters, residuals, nullptr));
  EXPECT_THAT(cost->parameter_block_sizes(), ElementsAre(2));
  EXPECT_EQ(residuals[0], 2.0 * 0.3 - 1.0);
}

/// r = x^2 and x^3: the Hessian of x^4 + x^6 is 12 x^2 + 30 x^4.
struct Powers {
  template <typename T>
  bool operator()(const T* x, T* residuals) const {
    residuals[0] = x[0] * x[0];
    residuals[1] = x[0] * x[0] * x[0];
    return true;
  }
};

TEST(CostFunctionFamily, HessianProductsHoldTwoThirdsOfTheDigits) {
  CostFunctionFamily family(0.5);
  family.AddBlock(std::make_unique<ceres::AutoDiffCostFunction<Powers, 2, 1>>(new Powers), {1});
  // The last direction is far too small for a step of its own; outside variables do not matter.
  for (const double length : {1.0, -250.0, 1e-12, 1e-310}) {
    const Eigen::Vector3d x(1e9, 0.9, -1e9);
    const Eigen::VectorXd direction = Eigen::Vector3d(0.0, length, 1e20 * length);
    Eigen::VectorXd product = Eigen::Vector3d(1.0, 0.0, 1.0);
    ASSERT_EQ(family.AddHessianTimes(x, direction, &product), Status::kOk);
    const double expected = 0.5 * (12.0 * std::pow(0.9, 2) + 30.0 * std::pow(0.9, 4)) * length;
    EXPECT_NEAR(product[1] / length, expected / length, kFunctorsTolerance) << length;
    EXPECT_EQ(product[0], 1.0);
    EXPECT_EQ(product[2], 1.0);
  }
}

TEST(CostFunctionFamily, HessianProductsKeepTheirDigitsForLargeVariables) {
  CostFunctionFamily family;
  family.AddBlock(std::make_unique<ceres::AutoDiffCostFunction<Powers, 2, 1>>(new Powers), {0});
  const double x = 4e6;
  Eigen::VectorXd product = Eigen::VectorXd::Zero(1);
  ASSERT_EQ(family.AddHessianTimes(Eigen::VectorXd::Constant(1, x),
                                   Eigen::VectorXd::Constant(1, 2.0), &product),
            Status::kOk);
  const double expected = 2.0 * (12.0 * std::pow(x, 2) + 30.0 * std::pow(x, 4));
  EXPECT_NEAR(product[0] / expected, 1.0, kFunctorsTolerance);
}

TEST(CostFunctionFamily, HessianOfADirectionOfZeroIsZero) {
  const auto family = MakeFamily(1.0, nullptr);
  Eigen::VectorXd product = SomePoint();
  ASSERT_EQ(family->AddHessianTimes(SomePoint(), Eigen::VectorXd::Zero(5), &product), Status::kOk);
  EXPECT_EQ(product, SomePoint());
}

TEST(CostFunctionFamily, AFailedCostFunctionIsNonFinite) {
  CostFunctionFamily family;
  family.AddBlock(std::make_unique<ceres::AutoDiffCostFunction<Failing, 2, 2>>(new Failing), {0});
  const Eigen::Vector2d defined(-1.0, 2.0), undefined(1.0, 2.0);
  double energy = 0.0;
  Eigen::VectorXd vector = Eigen::VectorXd::Zero(2);
  std::vector<Eigen::Triplet<double>> entries;
  EXPECT_EQ(family.Evaluate(defined, 0, 1, &energy, nullptr), Status::kOk);
  EXPECT_EQ(family.Evaluate(undefined, 0, 1, &energy, nullptr), Status::kNonFinite);
  EXPECT_EQ(family.Residuals(undefined, &vector), Status::kNonFinite);
  EXPECT_EQ(family.Jacobian(undefined, 0, &entries), Status::kNonFinite);
  EXPECT_EQ(family.AddHessianTimes(undefined, defined, &vector), Status::kNonFinite);
}

TEST(CostFunctionFamily, NoLossHidesAResidualThatIsNoNumber) {
  const auto family = MakeFamily(1.0, std::make_shared<ceres::TukeyLoss>(1.0));
  Eigen::VectorXd x = SomePoint();
  x[0] = std::nan("");
  double energy = 0.0;
  EXPECT_EQ(family->Evaluate(x, 0, family->size(), &energy, nullptr), Status::kNonFinite);
}

TEST(CostFunctionFamilyDeathTest, RefusesBlocksThatDoNotFit) {
  CostFunctionFamily family;
  EXPECT_EQ(family.num_residuals(), 0);
  family.AddBlock(MakeCurvedPair(0.0), {0, 2});
  EXPECT_DEATH(family.AddBlock(MakeCurvedPair(0.0), {0, 1}), "overlap");
  EXPECT_DEATH(family.AddBlock(MakeCurvedPair(0.0), {0}), "offsets");
  EXPECT_DEATH(
      family.AddBlock(std::make_unique<ceres::AutoDiffCostFunction<Quadratic, 2, 2>>(new Quadratic),
                      {-1}),
      "offsets");
  // One residual only, where the family has two.
  using OneResidual = ceres::AutoDiffCostFunction<Quadratic, ceres::DYNAMIC, 2>;
  EXPECT_DEATH(family.AddBlock(std::make_unique<OneResidual>(new Quadratic, 1), {0}),
               "num_residuals");
}

}  // namespace
}  // namespace batten
