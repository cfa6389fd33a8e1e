#include "cost_functions/interpolation.h"

#include <ceres/problem.h>
#include <gtest/gtest.h>

#include <string>
#include <tuple>

#include "tests/cost_functions/example_fit.h"

namespace batten {
namespace {

std::unique_ptr<BlockFamily> MakeInterpolation(const FitSetting& setting,
                                               const std::string& options) {
  NameSpec spec;
  const Term* term = nullptr;
  OptionValues values;
  std::string error;
  EXPECT_TRUE(ParseNameSpec("interpolation" + options, &spec, &error)) << error;
  EXPECT_TRUE(TermRegistry::Global().Resolve(spec, &term, &values, &error)) << error;
  return term->MakeFamily(setting, values, &error);
}

// Residuals here are about 1, so that each loss has blocks on either side of its scale.
const std::vector<std::string> kOptions = {"",
                                           "/weight=0.7",
                                           "/weight=0.7/loss=huber/loss_scale=0.6",
                                           "/weight=1.9/loss=cauchy/loss_scale=0.6",
                                           "/loss=tukey/loss_scale=1.1",
                                           "/loss=soft_l1/loss_scale=0.6"};

class Interpolation : public ::testing::TestWithParam<std::tuple<int, int>> {
 protected:
  int degree() const { return std::get<0>(GetParam()); }
  int dimension() const { return std::get<1>(GetParam()); }
  std::mt19937 random_{20240701u + 10u * static_cast<unsigned>(degree()) +
                       static_cast<unsigned>(dimension())};

  /// Calls test(fit) for open and periodic splines, also with n <= p, weighted or not.
  template <typename Test>
  void ForEachFit(Test test) {
    bool weighted = false;
    for (const EndKnots ends : {EndKnots::kEndInterpolating, EndKnots::kPeriodic}) {
      const SplineKind kind = {degree(), ends, false};
      for (const int n : SizesOf(kind)) {
        weighted = !weighted;
        const ExampleFit fit(MakeBasis(kind, n, &random_), dimension(), 7, weighted, &random_);
        SCOPED_TRACE(kind.Name() + " n = " + std::to_string(n) + (weighted ? " weighted" : ""));
        test(fit);
      }
    }
  }
};

TEST_P(Interpolation, IsTheWeightedDistanceFromTheData) {
  ForEachFit([&](const ExampleFit& fit) {
    const auto family = MakeInterpolation(fit.setting, "/weight=0.7");
    const Eigen::VectorXd x = fit.RandomVariables(&random_);
    const Eigen::VectorXd residuals = ResidualsAt(*family, x);
    const int d = dimension();
    double energy = 0.0;
    // A value of the basis is a sum of products with p factors; control points are below 1.
    const double tolerance = 32 * (degree() + 1) * kEpsilon;
    for (int s = 0; s < fit.sites.size; ++s) {
      const int item = fit.sites.item(s);
      for (int c = 0; c < d; ++c) {
        double value = -fit.Datum(item, c);
        for (int j = 0; j < fit.basis.num_control_points(); ++j) {
          value += fit.Coefficient(item, j) * x[ExampleFit::kOffset + j * d + c];
        }
        EXPECT_NEAR(residuals[s * d + c], std::sqrt(fit.weight(item)) * value, 2 * tolerance);
        energy += 0.7 * fit.weight(item) * value * value;
      }
    }
    EXPECT_NEAR(EnergyAt(*family, x), energy, fit.sites.size * d * 10 * tolerance);
  });
}

TEST_P(Interpolation, DerivativesAreThoseOfItsEnergyWithEachLoss) {
  ForEachFit([&](const ExampleFit& fit) {
    for (const std::string& options : kOptions) {
      SCOPED_TRACE(options);
      ExpectDerivativesOf(*MakeInterpolation(fit.setting, options), fit.RandomVariables(&random_),
                          &random_);
    }
  });
}

TEST_P(Interpolation, RowsAreItsJacobian) {
  ForEachFit([&](const ExampleFit& fit) {
    for (const std::string& options : kOptions) {
      const auto family = MakeInterpolation(fit.setting, options);
      if (family->loss() != nullptr) {
        EXPECT_EQ(family->rows(), nullptr) << options;
      } else {
        ExpectRowsOf(*family, fit, fit.RandomVariables(&random_));
      }
    }
  });
}

TEST_P(Interpolation, StaticSizesChangeNothing) {
  ForEachFit([&](const ExampleFit& fit) {
    FitSetting dynamic = fit.setting;
    dynamic.use_static_sizes = false;
    const Eigen::VectorXd x = fit.RandomVariables(&random_);
    const Eigen::VectorXd direction = fit.RandomVariables(&random_);
    for (const std::string& options : kOptions) {
      const auto a = MakeInterpolation(fit.setting, options);
      const auto b = MakeInterpolation(dynamic, options);
      // The compiler may order sums of up to 7 * 2 terms of size 1 and weight 6 in another way.
      const double tolerance = 512 * kEpsilon;
      EXPECT_NEAR(EnergyAt(*a, x), EnergyAt(*b, x), tolerance);
      EXPECT_LT((GradientAt(*a, x) - GradientAt(*b, x)).norm(), tolerance);
      EXPECT_LT((ResidualsAt(*a, x) - ResidualsAt(*b, x)).norm(), tolerance);
      EXPECT_LT((JacobianAt(*a, x) - JacobianAt(*b, x)).norm(), tolerance);
      EXPECT_LT((HessianTimes(*a, x, direction) - HessianTimes(*b, x, direction)).norm(),
                8 * tolerance);
    }
  });
}

TEST_P(Interpolation, GivesCeresTheSameEnergyAndGradientToTheLastBit) {
  ForEachFit([&](const ExampleFit& fit) {
    for (const std::string& options : kOptions) {
      const auto family = MakeInterpolation(fit.setting, options);
      Eigen::VectorXd x = fit.RandomVariables(&random_);
      ceres::Problem problem;
      for (int block = 0; block < family->size(); ++block) {
        std::vector<int> offsets, sizes;
        std::vector<double*> parameters;
        family->Bind(x, block, &offsets, &sizes);
        for (const int offset : offsets) parameters.push_back(x.data() + offset);
        const auto id = problem.AddResidualBlock(family->MakeCeresCostFunction(x, block).release(),
                                                 family->MakeCeresLoss().release(), parameters);
        double cost = 0.0;
        double energy = 0.0;
        ASSERT_TRUE(problem.EvaluateResidualBlock(id, true, &cost, nullptr, nullptr));
        ASSERT_EQ(family->Evaluate(x, block, block + 1, &energy, nullptr), Status::kOk);
        EXPECT_EQ(2.0 * cost, energy);
      }
      double cost = 0.0;
      std::vector<double> gradient;
      ASSERT_TRUE(problem.Evaluate({}, &cost, nullptr, &gradient, nullptr));
      EXPECT_EQ(2.0 * cost, EnergyAt(*family, x));
      const Eigen::VectorXd ours = GradientAt(*family, x);
      std::vector<double*> order;
      problem.GetParameterBlocks(&order);
      // Where a block meets a control point twice, Ceres adds up its derivatives first.
      const bool repeated = fit.basis.num_control_points() < fit.basis.order();
      const double tolerance = repeated ? 64 * kEpsilon * (1.0 + ours.norm()) : 0.0;
      for (std::size_t g = 0; g < gradient.size(); ++g) {
        const auto variable = order[g / dimension()] - x.data() + g % dimension();
        EXPECT_NEAR(2.0 * gradient[g], ours[variable], tolerance);
      }
    }
  });
}

TEST_P(Interpolation, BindsExactlyTheVariablesOfItsJacobian) {
  ForEachFit([&](const ExampleFit& fit) {
    const auto family = MakeInterpolation(fit.setting, "");
    const Eigen::VectorXd x = fit.RandomVariables(&random_);
    const Eigen::MatrixXd jacobian = JacobianAt(*family, x);
    for (int block = 0; block < family->size(); ++block) {
      std::vector<int> offsets, sizes;
      family->Bind(x, block, &offsets, &sizes);
      Eigen::VectorXd outside =
          jacobian.middleRows(block * dimension(), dimension()).colwise().lpNorm<Eigen::Infinity>();
      for (std::size_t k = 0; k < offsets.size(); ++k) {
        EXPECT_EQ(sizes[k], dimension());
        outside.segment(offsets[k], sizes[k]).setZero();
      }
      EXPECT_EQ(outside.lpNorm<Eigen::Infinity>(), 0.0);
    }
  });
}

TEST_P(Interpolation, SumsOfRangesAreReproducible) {
  ForEachFit([&](const ExampleFit& fit) {
    const auto family = MakeInterpolation(fit.setting, "/loss=huber");
    const Eigen::VectorXd x = fit.RandomVariables(&random_);
    double pieces = 0.0;
    for (int block = 0; block < family->size(); ++block) {
      ASSERT_EQ(family->Evaluate(x, block, block + 1, &pieces, nullptr), Status::kOk);
    }
    EXPECT_EQ(pieces, EnergyAt(*family, x));
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(x.size());
    ASSERT_EQ(family->Evaluate(x, 0, 3, &pieces, &gradient), Status::kOk);
    ASSERT_EQ(family->Evaluate(x, 3, family->size(), &pieces, &gradient), Status::kOk);
    const double tolerance = 64 * kEpsilon * (1.0 + gradient.norm());
    EXPECT_LT((gradient - GradientAt(*family, x)).norm(), tolerance);
  });
}

INSTANTIATE_TEST_SUITE_P(Sizes, Interpolation,
                         ::testing::Combine(::testing::Range(1, kMaxDegree + 1),
                                            ::testing::Range(1, kMaxDimension + 1)),
                         [](const auto& sizes) {
                           return "Degree" + std::to_string(std::get<0>(sizes.param)) +
                                  "Dimension" + std::to_string(std::get<1>(sizes.param));
                         });

TEST(InterpolationAtOnePoint, IsNonFiniteWhereVariablesAre) {
  std::mt19937 random(7);
  const SplineKind kind = {3, EndKnots::kPeriodic, true};
  const ExampleFit fit(MakeBasis(kind, 6, &random), 2, 9, false, &random);
  const auto family = MakeInterpolation(fit.setting, "");
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e200}) {
    Eigen::VectorXd x = fit.RandomVariables(&random);
    x.setConstant(bad);
    double energy = 0.0;
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(x.size());
    EXPECT_EQ(family->Evaluate(x, 0, family->size(), &energy, nullptr), Status::kNonFinite);
    EXPECT_EQ(family->Evaluate(x, 0, family->size(), &energy, &gradient), Status::kNonFinite);
  }
}

}  // namespace
}  // namespace batten
