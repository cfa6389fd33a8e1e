// FunctorFamily with functors that are not in the library: what a researcher's own term goes
// through.
#include "cost_functions/functor_family.h"

#include <gtest/gtest.h>

#include <string>

#include "cost_functions/interpolation.h"
#include "tests/cost_functions/example_fit.h"

namespace batten {
namespace {

/// The interpolation residual, changed: three times as large and shifted.
struct Changed {
  static TermInfo Info() { return {"changed", "", "", kAffine, {}}; }
  static constexpr bool kAffine = true;
  static constexpr int kDerivatives = 0;
  static constexpr int NumResiduals(int dimension) { return dimension; }
  explicit Changed(const OptionValues& options) : original(options) {}
  std::shared_ptr<const Sites> MakeSites(const FitSetting& setting) const {
    return original.MakeSites(setting);
  }
  template <typename SiteType, typename T>
  bool operator()(const SiteType& site, const T* const* control_points, T* residuals) const {
    if (!original(site, control_points, residuals)) return false;
    for (int c = 0; c < site.dimension(); ++c) residuals[c] = 3.0 * residuals[c] + 0.25;
    return true;
  }
  InterpolationResidual original;
};

/// Affine, but with other rows for each coordinate, though it claims one row for all.
struct Uneven : Changed {
  using Changed::Changed;
  template <typename SiteType, typename T>
  bool operator()(const SiteType& site, const T* const* control_points, T* residuals) const {
    for (int c = 0; c < site.dimension(); ++c) {
      residuals[c] = (1.0 + c) * site.Curve(control_points, c);
    }
    return true;
  }
};

/// One row for all coordinates, but a right-hand side that tells them apart.
struct ShiftedByCoordinate : Changed {
  using Changed::Changed;
  template <typename SiteType, typename T>
  bool operator()(const SiteType& site, const T* const* control_points, T* residuals) const {
    for (int c = 0; c < site.dimension(); ++c) {
      residuals[c] = site.Curve(control_points, c) - 0.5 * c;
    }
    return true;
  }
};

/// Two residuals, however many coordinates there are: it cannot be shown one at a time.
struct AlwaysTwo : Changed {
  using Changed::Changed;
  static constexpr int NumResiduals(int /*dimension*/) { return 2; }
  template <typename SiteType, typename T>
  bool operator()(const SiteType& site, const T* const* control_points, T* residuals) const {
    const int last = site.dimension() - 1;
    residuals[0] = site.Curve(control_points, 0) - site.point(0);
    residuals[1] = site.Curve(control_points, last) - site.point(last);
    return true;
  }
};

/// C'' of the curve minus the data: rows from derivatives of the basis.
struct SecondDerivative : Changed {
  using Changed::Changed;
  static constexpr int kDerivatives = 2;
  template <typename SiteType, typename T>
  bool operator()(const SiteType& site, const T* const* control_points, T* residuals) const {
    for (int c = 0; c < site.dimension(); ++c) {
      residuals[c] =
          site.root_weight() * (0.1 * site.Derivative(2, control_points, c) - site.point(c));
    }
    return true;
  }
};

/// Products of variables: |C|^2 - |Q|^2 and, curved further, exp(C_0 / 2) with C'.
struct Curved {
  static TermInfo Info() { return {"curved", "", "", kAffine, {}}; }
  static constexpr bool kAffine = false;
  static constexpr int kDerivatives = 1;
  static constexpr int NumResiduals(int /*dimension*/) { return 2; }
  explicit Curved(const OptionValues& /*options*/) {}
  std::shared_ptr<const Sites> MakeSites(const FitSetting& setting) const {
    return std::shared_ptr<const Sites>(std::shared_ptr<const Sites>(), setting.data);
  }
  template <typename SiteType, typename T>
  bool operator()(const SiteType& site, const T* const* control_points, T* residuals) const {
    using std::exp;
    const T first = site.Curve(control_points, 0);
    if (first > T(50.0)) return false;
    residuals[0] = T(0.0);
    for (int c = 0; c < site.dimension(); ++c) {
      const T value = site.Curve(control_points, c);
      residuals[0] += value * value - site.point(c) * site.point(c);
    }
    residuals[1] = site.root_weight() * exp(0.5 * first) -
                   0.1 * first * site.Derivative(1, control_points, site.dimension() - 1);
    return true;
  }
};

template <typename Functor>
FunctorFamily<Functor> MakeFamily(const FitSetting& setting, double weight,
                                  std::shared_ptr<const ceres::LossFunction> loss) {
  return FunctorFamily<Functor>(setting, Functor(OptionValues()), weight, std::move(loss));
}

/// Compiled sizes (2, 2), (3, 1), (3, 3) and run-time ones, open and periodic, also n <= p.
class AnyFunctor : public ::testing::TestWithParam<std::tuple<int, int>> {
 protected:
  template <typename Test>
  void ForEachFit(Test test) {
    const auto [degree, dimension] = GetParam();
    for (const EndKnots ends : {EndKnots::kFloating, EndKnots::kPeriodic}) {
      const SplineKind kind = {degree, ends, false};
      for (const int n : SizesOf(kind)) {
        SCOPED_TRACE(kind.Name() + " n = " + std::to_string(n));
        test(ExampleFit(MakeBasis(kind, n, &random_), dimension, 9, true, &random_));
      }
    }
  }
  std::mt19937 random_{20240702};
};

TEST_P(AnyFunctor, IsSeenByEveryPath) {
  ForEachFit([&](const ExampleFit& fit) {
    const auto original = MakeFamily<InterpolationResidual>(fit.setting, 0.6, nullptr);
    const auto changed = MakeFamily<Changed>(fit.setting, 0.6, nullptr);
    const Eigen::VectorXd x = fit.RandomVariables(&random_);
    const double tolerance = 1e3 * kEpsilon;  // sums of some ten terms, at most about 30 each

    const Eigen::VectorXd residuals = 3.0 * ResidualsAt(original, x).array() + 0.25;
    EXPECT_LT((ResidualsAt(changed, x) - residuals).norm(), tolerance);
    EXPECT_NEAR(EnergyAt(changed, x), 0.6 * residuals.squaredNorm(), 10 * tolerance);
    const Eigen::MatrixXd jacobian = 3.0 * JacobianAt(original, x);
    EXPECT_LT((JacobianAt(changed, x) - jacobian).norm(), tolerance);
    const Eigen::VectorXd gradient = 1.2 * jacobian.transpose() * residuals;
    EXPECT_LT((GradientAt(changed, x) - gradient).norm(), 10 * tolerance);
    const Eigen::VectorXd direction = fit.RandomVariables(&random_);
    EXPECT_LT(
        (HessianTimes(changed, x, direction) - 9.0 * HessianTimes(original, x, direction)).norm(),
        10 * tolerance);

    const DenseRows rows(*original.rows());
    const DenseRows changed_rows(*changed.rows());
    const double shift = std::sqrt(0.6) * 0.25;
    EXPECT_LT((changed_rows.matrix - 3.0 * rows.matrix).norm(), tolerance);
    const Eigen::MatrixXd right = 3.0 * rows.right_hand_sides.array() - shift;
    EXPECT_LT((changed_rows.right_hand_sides - right).norm(), tolerance);

    for (int block = 0; block < changed.size(); ++block) {
      std::vector<int> offsets, sizes;
      std::vector<const double*> parameters;
      changed.Bind(x, block, &offsets, &sizes);
      for (const int offset : offsets) parameters.push_back(x.data() + offset);
      Eigen::VectorXd from_ceres(changed.num_residuals());
      ASSERT_TRUE(changed.MakeCeresCostFunction(x, block)->Evaluate(parameters.data(),
                                                                    from_ceres.data(), nullptr));
      const auto d = changed.num_residuals();
      EXPECT_EQ(from_ceres, ResidualsAt(changed, x).segment(block * d, d));
    }
  });
}

TEST_P(AnyFunctor, HasRowsEqualToItsJacobianIfItIsAffine) {
  ForEachFit([&](const ExampleFit& fit) {
    const Eigen::VectorXd x = fit.RandomVariables(&random_);
    ExpectRowsOf(MakeFamily<Changed>(fit.setting, 1.7, nullptr), fit, x);
    ExpectRowsOf(MakeFamily<SecondDerivative>(fit.setting, 1.7, nullptr), fit, x);
  });
}

TEST_P(AnyFunctor, HasNoRowsThatWouldBeWrong) {
  ForEachFit([&](const ExampleFit& fit) {
    const auto uneven = MakeFamily<Uneven>(fit.setting, 1.0, nullptr);
    const auto shifted = MakeFamily<ShiftedByCoordinate>(fit.setting, 1.0, nullptr);
    const auto curved = MakeFamily<Curved>(fit.setting, 1.0, nullptr);
    EXPECT_EQ(uneven.rows() == nullptr, fit.setting.dimension > 1);
    EXPECT_EQ(curved.rows(), nullptr);
    if (fit.setting.dimension >= 2) {
      EXPECT_EQ(MakeFamily<AlwaysTwo>(fit.setting, 1.0, nullptr).rows(), nullptr);
    }
    EXPECT_EQ(shifted.rows() == nullptr, fit.setting.dimension > 1);
  });
}

TEST_P(AnyFunctor, HasTheDerivativesOfItsEnergyAlsoIfItIsCurved) {
  const std::shared_ptr<const ceres::LossFunction> losses[] = {
      nullptr, std::make_shared<ceres::CauchyLoss>(0.8), std::make_shared<ceres::HuberLoss>(0.5)};
  ForEachFit([&](const ExampleFit& fit) {
    for (const auto& loss : losses) {
      const auto family = MakeFamily<Curved>(fit.setting, 0.4, loss);
      ExpectDerivativesOf(family, 0.5 * fit.RandomVariables(&random_), &random_);
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Sizes, AnyFunctor,
                         ::testing::Values(std::tuple(2, 2), std::tuple(3, 1), std::tuple(3, 3),
                                           std::tuple(2, 4), std::tuple(7, 2)),
                         [](const auto& sizes) {
                           return "Degree" + std::to_string(std::get<0>(sizes.param)) +
                                  "Dimension" + std::to_string(std::get<1>(sizes.param));
                         });

TEST(FunctorWithoutValue, IsNonFiniteOnEveryPath) {
  std::mt19937 random(11);
  const SplineKind kind = {3, EndKnots::kPeriodic, true};
  const ExampleFit fit(MakeBasis(kind, 6, &random), 2, 5, false, &random);
  const auto family = MakeFamily<Curved>(fit.setting, 1.0, nullptr);
  const Eigen::VectorXd x = Eigen::VectorXd::Constant(fit.num_variables(), 60.0);
  double energy = 0.0;
  Eigen::VectorXd vector = Eigen::VectorXd::Zero(x.size());
  std::vector<Eigen::Triplet<double>> entries;
  EXPECT_EQ(family.Evaluate(x, 0, 5, &energy, nullptr), Status::kNonFinite);
  EXPECT_EQ(family.Evaluate(x, 0, 5, &energy, &vector), Status::kNonFinite);
  EXPECT_EQ(family.AddHessianTimes(x, x, &vector), Status::kNonFinite);
  EXPECT_EQ(family.Jacobian(x, 0, &entries), Status::kNonFinite);
  EXPECT_EQ(family.Residuals(x, &vector), Status::kNonFinite);
}

}  // namespace
}  // namespace batten
