#include <ceres/problem.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>

#include "cost_functions/term.h"
#include "tests/cost_functions/example_fit.h"

namespace batten {
namespace {

/// The suite that runs on every registered term.
class EveryTerm : public ::testing::TestWithParam<std::string> {
 protected:
  const Term& term() const { return *TermRegistry::Global().Find(GetParam()); }

  /// Null where the term says that it cannot be formed.
  std::unique_ptr<BlockFamily> Make(const FitSetting& setting, const std::string& options) const {
    NameSpec spec;
    const Term* found = nullptr;
    OptionValues values;
    std::string error;
    EXPECT_TRUE(ParseNameSpec(GetParam() + options, &spec, &error)) << error;
    EXPECT_TRUE(TermRegistry::Global().Resolve(spec, &found, &values, &error)) << error;
    error.clear();
    std::unique_ptr<BlockFamily> family = found->MakeFamily(setting, values, &error);
    EXPECT_EQ(family == nullptr, !error.empty()) << error;
    return family;
  }

  /// The term's defaults, each word of its own options, weights and losses.
  std::vector<std::string> OptionTexts() const {
    std::vector<std::string> texts = {"",
                                      "/weight=0.75",
                                      "/weight=1.5/loss=huber/loss_scale=0.6",
                                      "/loss=cauchy/loss_scale=0.4",
                                      "/loss=tukey/loss_scale=1.1",
                                      "/loss=soft_l1/loss_scale=0.7"};
    for (const OptionInfo& option : term().Info().options) {
      for (const std::string& word : option.words) {
        texts.push_back("/" + option.name + "=" + word);
      }
    }
    return texts;
  }

  /// Where E is as smooth as the term can be.
  Eigen::VectorXd Variables(const ExampleFit& fit) {
    const bool round = term().Info().foot_points || GetParam() == "curve_fairing";
    return round ? fit.RoundVariables(&random_) : fit.RandomVariables(&random_);
  }

  /// Calls test(fit, family, options) on splines of all kinds and dimensions.
  template <typename Test>
  void ForEachFamily(Test test) {
    int num_families = 0;
    int num_fits = 0;
    for (int degree = 1; degree <= kMaxDegree; ++degree) {
      for (const EndKnots ends :
           {EndKnots::kEndInterpolating, EndKnots::kFloating, EndKnots::kPeriodic}) {
        for (const bool uniform : {false, true}) {
          const SplineKind kind = {degree, ends, uniform};
          const int n = kind.periodic() && uniform ? 1 + degree / 2 : degree + 4 + (degree % 3) * 3;
          const int dimension = 1 + num_fits++ % kMaxDimension;
          const ExampleFit fit(MakeBasis(kind, n, &random_), dimension, 11, n % 2 == 0, &random_);
          for (const std::string& options : OptionTexts()) {
            SCOPED_TRACE(kind.Name() + " n = " + std::to_string(n) +
                         " d = " + std::to_string(dimension) + " " + options);
            const auto family = Make(fit.setting, options);
            if (family == nullptr) continue;
            ++num_families;
            test(fit, *family, options);
          }
        }
      }
    }
    EXPECT_GT(num_families, 0);
  }

  std::mt19937 random_{20240801};
};

TEST_P(EveryTerm, SaysWhatItIs) {
  const TermInfo info = term().Info();
  EXPECT_EQ(info.name, GetParam());
  EXPECT_FALSE(info.summary.empty());
  EXPECT_EQ(info.summary.find('\n'), std::string::npos);
  EXPECT_FALSE(info.source.empty());
  std::set<std::string> names;
  for (const OptionInfo& option : CommonTermOptions()) names.insert(option.name);
  for (const OptionInfo& option : info.options) {
    EXPECT_TRUE(names.insert(option.name).second) << option.name << " is there twice";
    EXPECT_FALSE(option.help.empty()) << option.name;
    if (option.kind == OptionInfo::Kind::kWord) {
      EXPECT_THAT(option.words, ::testing::Contains(option.default_word)) << option.name;
    } else {
      EXPECT_LE(option.lowest, option.default_number) << option.name;
      EXPECT_GE(option.highest, option.default_number) << option.name;
    }
  }
}

TEST_P(EveryTerm, HasAPageAndARowInTheTable) {
  const std::string folder = BATTEN_SOURCE_DIR "/docs/terms/";
  std::ifstream page(folder + GetParam() + ".md");
  std::string title;
  std::getline(page, title);
  EXPECT_EQ(title, "# " + GetParam());
  std::ifstream table(folder + "README.md");
  const std::string rows{std::istreambuf_iterator<char>(table), std::istreambuf_iterator<char>()};
  EXPECT_NE(rows.find("](" + GetParam() + ".md)"), std::string::npos);
}

/// Norm of the longest gradient of a residual, at least 1: second and third derivatives of a loss
/// grow with its square and cube, also where they cancel or E has stopped growing.
double Steepness(const BlockFamily& family, const Eigen::VectorXd& x) {
  return std::max(1.0, JacobianAt(family, x).rowwise().norm().maxCoeff());
}

TEST_P(EveryTerm, DerivativesAreThoseOfItsEnergy) {
  ForEachFamily([this](const ExampleFit& fit, const BlockFamily& family, const std::string&) {
    const Eigen::VectorXd x = Variables(fit);
    double third_derivative = std::pow(Steepness(family, x), 3);
    if (term().Info().free_parameters) third_derivative = fit.Bend();
    // A foot on a round curve is off by roundings of numbers of size kRadius at each level of the
    // recursion, where differences of numbers of size 1 are taken to have one.
    if (term().Info().foot_points) third_derivative = ExampleFit::kRadius * fit.basis.order();
    ExpectDerivativesOf(family, x, &random_, third_derivative);
  });
}

TEST_P(EveryTerm, HessianIsSymmetric) {
  ForEachFamily([this](const ExampleFit& fit, const BlockFamily& family, const std::string&) {
    const Eigen::VectorXd x = Variables(fit);
    const Eigen::VectorXd u = Variables(fit), v = Variables(fit);
    const Eigen::VectorXd hu = HessianTimes(family, x, u), hv = HessianTimes(family, x, v);
    const double steepness = term().Info().free_parameters ? 1.0 : Steepness(family, x);
    const double tolerance =
        256 * kEpsilon * (steepness * steepness + hu.norm() * v.norm() + hv.norm() * u.norm());
    EXPECT_NEAR(u.dot(hv), v.dot(hu), tolerance);
  });
}

TEST_P(EveryTerm, GradientIsThatOfItsResiduals) {
  ForEachFamily([this](const ExampleFit& fit, const BlockFamily& family, const std::string&) {
    const Eigen::VectorXd x = Variables(fit);
    const Eigen::VectorXd residuals = ResidualsAt(family, x);
    const Eigen::MatrixXd jacobian = JacobianAt(family, x);
    Eigen::VectorXd expected = Eigen::VectorXd::Zero(x.size());
    double energy = 0.0;
    const int k = family.num_residuals();
    for (int block = 0; block < family.size(); ++block) {
      const Eigen::VectorXd r = residuals.segment(block * k, k);
      double rho[3] = {r.squaredNorm(), 1.0, 0.0};
      if (family.loss() != nullptr) family.loss()->Evaluate(r.squaredNorm(), rho);
      energy += family.weight() * rho[0];
      expected +=
          2.0 * family.weight() * rho[1] * jacobian.middleRows(block * k, k).transpose() * r;
    }
    const double tolerance = 256 * kEpsilon * (1.0 + energy + expected.norm());
    EXPECT_NEAR(EnergyAt(family, x), energy, tolerance);
    EXPECT_LT((GradientAt(family, x) - expected).norm(), tolerance);
  });
}

TEST_P(EveryTerm, HasRowsWhereItSaysThatItIsAffine) {
  ForEachFamily([this](const ExampleFit& fit, const BlockFamily& family, const std::string&) {
    if (term().Info().affine && family.loss() == nullptr) {
      ExpectRowsOf(family, fit, Variables(fit));
    } else {
      EXPECT_EQ(family.rows(), nullptr);
    }
  });
}

TEST_P(EveryTerm, WeightIsAFactorOfItsEnergy) {
  ForEachFamily(
      [this](const ExampleFit& fit, const BlockFamily& family, const std::string& options) {
        if (options.find("weight") != std::string::npos) return;
        const auto heavier = Make(fit.setting, options + "/weight=4");
        const auto nothing = Make(fit.setting, options + "/weight=0");
        const Eigen::VectorXd x = Variables(fit);
        EXPECT_EQ(EnergyAt(*heavier, x), 4.0 * EnergyAt(family, x));
        EXPECT_EQ(GradientAt(*heavier, x), 4.0 * GradientAt(family, x));
        EXPECT_EQ(EnergyAt(*nothing, x), 0.0);
        EXPECT_TRUE(GradientAt(*nothing, x).isZero(0.0));
      });
}

/// E, its gradient and all blocks one by one, through a ceres::Problem.
void ExpectCeresAgrees(const BlockFamily& family, Eigen::VectorXd x) {
  ceres::Problem problem;
  std::vector<int> offsets, sizes;
  for (int block = 0; block < family.size(); ++block) {
    family.Bind(x, block, &offsets, &sizes);
    const auto cost_function = family.MakeCeresCostFunction(x, block);
    EXPECT_EQ(cost_function->num_residuals(), family.num_residuals());
    ASSERT_EQ(cost_function->parameter_block_sizes(),
              std::vector<int32_t>(sizes.begin(), sizes.end()));
  }
  std::map<double*, int> size_of;
  for (int block = 0; block < family.size(); ++block) {
    family.Bind(x, block, &offsets, &sizes);
    std::vector<double*> pointers;
    for (std::size_t k = 0; k < offsets.size(); ++k) {
      pointers.push_back(x.data() + offsets[k]);
      size_of[pointers.back()] = sizes[k];
    }
    problem.AddResidualBlock(family.MakeCeresCostFunction(x, block).release(),
                             family.MakeCeresLoss().release(), pointers);
  }
  double cost = 0.0;
  std::vector<double> gradient;
  ceres::Problem::EvaluateOptions options;
  for (const auto& entry : size_of) options.parameter_blocks.push_back(entry.first);
  ASSERT_TRUE(problem.Evaluate(options, &cost, nullptr, &gradient, nullptr));
  EXPECT_EQ(2.0 * cost, EnergyAt(family, x));
  // Variables of no block have no gradient.
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(x.size());
  std::size_t g = 0;
  for (const auto& [pointer, size] : size_of) {
    for (int i = 0; i < size; ++i) expected[pointer - x.data() + i] = 2.0 * gradient[g++];
  }
  const Eigen::VectorXd ours = GradientAt(family, x);
  EXPECT_LT((ours - expected).norm(), 256 * kEpsilon * (1.0 + ours.norm()));
}

TEST_P(EveryTerm, GivesCeresTheSameEnergyAndGradient) {
  ForEachFamily([this](const ExampleFit& fit, const BlockFamily& family, const std::string&) {
    ExpectCeresAgrees(family, Variables(fit));
  });
}

TEST_P(EveryTerm, BindsTheVariablesItDependsOn) {
  ForEachFamily([this](const ExampleFit& fit, const BlockFamily& family, const std::string&) {
    const Eigen::VectorXd x = Variables(fit);
    const Eigen::MatrixXd jacobian = JacobianAt(family, x);
    const int k = family.num_residuals();
    std::vector<int> offsets, sizes;
    for (int block = 0; block < family.size(); ++block) {
      family.Bind(x, block, &offsets, &sizes);
      ASSERT_EQ(offsets.size(), sizes.size());
      Eigen::RowVectorXd outside = jacobian.middleRows(block * k, k).cwiseAbs().colwise().sum();
      for (std::size_t g = 0; g < offsets.size(); ++g) {
        ASSERT_GE(offsets[g], 0);
        ASSERT_LE(offsets[g] + sizes[g], x.size());
        outside.segment(offsets[g], sizes[g]).setZero();
      }
      EXPECT_TRUE(outside.isZero(0.0)) << block;
    }
  });
}

TEST_P(EveryTerm, SumsItsRangesBlockByBlock) {
  ForEachFamily([this](const ExampleFit& fit, const BlockFamily& family, const std::string&) {
    const Eigen::VectorXd x = Variables(fit);
    double sum = 0.0;
    for (int block = 0; block < family.size(); ++block) {
      ASSERT_EQ(family.Evaluate(x, block, block + 1, &sum, nullptr), Status::kOk);
    }
    EXPECT_EQ(sum, EnergyAt(family, x));
  });
}

TEST_P(EveryTerm, SaysWhereItHasNoNumber) {
  ForEachFamily([](const ExampleFit& fit, const BlockFamily& family, const std::string&) {
    const Eigen::VectorXd x = Eigen::VectorXd::Constant(fit.num_variables(), std::nan(""));
    double energy = 0.0;
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(x.size());
    EXPECT_EQ(family.Evaluate(x, 0, family.size(), &energy, nullptr), Status::kNonFinite);
    EXPECT_EQ(family.Evaluate(x, 0, family.size(), &energy, &gradient), Status::kNonFinite);
  });
}

INSTANTIATE_TEST_SUITE_P(Registry, EveryTerm, ::testing::ValuesIn(TermRegistry::Global().Names()),
                         [](const auto& term) { return term.param; });

TEST(TermRegistry, KnowsTheInterpolationTerm) {
  EXPECT_THAT(TermRegistry::Global().Names(), ::testing::Contains("interpolation"));
  EXPECT_EQ(TermRegistry::Global().Find("interpolaton"), nullptr);
}

}  // namespace
}  // namespace batten
