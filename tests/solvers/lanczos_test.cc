#include "solvers/lanczos.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <functional>

#include "problems/objective.h"
#include "tests/roundoff.h"
#include "tests/solvers/circulant_fit.h"

namespace batten {
namespace {

using Multiply = std::function<Status(const Eigen::VectorXd&, Eigen::VectorXd*)>;

Multiply Diagonal(const Eigen::VectorXd& diagonal) {
  return [diagonal](const Eigen::VectorXd& v, Eigen::VectorXd* product) {
    *product = diagonal.cwiseProduct(v);
    return Status::kOk;
  };
}

TEST(Lanczos, FindsTheEndsOfACirculantSpectrum) {
  for (const int n : {6, 40, 200}) {
    const auto problem = MakeCirculantFit(n, 1);
    Objective objective(problem.get(), nullptr);
    const Multiply multiply = [&](const Eigen::VectorXd& v, Eigen::VectorXd* product) {
      return objective.curve_view()->NormalProduct(v, product);
    };
    Spectrum spectrum;
    ASSERT_EQ(EstimateSpectrum(multiply, RandomStart(2 * n, 1), 1e-3, 300, &spectrum), Status::kOk);
    // N = A'A: squares of 1 and, for even n, of 1/3.
    EXPECT_NEAR(spectrum.largest, 1.0, 1e-3);
    EXPECT_NEAR(spectrum.smallest, 1.0 / 9.0, 1e-3 / 9.0);
    EXPECT_LE(spectrum.largest, 1.0 + 8 * kEpsilon);
    EXPECT_GE(spectrum.smallest, 1.0 / 9.0 - 8 * kEpsilon);
    EXPECT_LT(spectrum.products, 300) << "it saw by itself that it had come close enough";
  }
}

TEST(Lanczos, AnEigenvalueLiesWithinTheErrorItStates) {
  const Eigen::VectorXd eigenvalues = Eigen::VectorXd::LinSpaced(500, 0.1, 40.0).array().square();
  for (const int max_products : {1, 2, 5, 20, 80}) {
    Spectrum spectrum;
    ASSERT_EQ(
        EstimateSpectrum(Diagonal(eigenvalues), RandomStart(500, 3), 0.0, max_products, &spectrum),
        Status::kOk);
    EXPECT_EQ(spectrum.products, max_products);
    const auto distance = [&](double value) {
      return (eigenvalues.array() - value).abs().minCoeff();
    };
    const double rounding = 64 * kEpsilon * eigenvalues.maxCoeff();
    EXPECT_LE(distance(spectrum.smallest), spectrum.smallest_error + rounding);
    EXPECT_LE(distance(spectrum.largest), spectrum.largest_error + rounding);
  }
}

TEST(Lanczos, StopsWhereTheStartReachesNoFurther) {
  Eigen::VectorXd diagonal(4), start(4);
  diagonal << 1.0, 2.0, 5.0, 9.0;
  start << 0.0, 3.0, 0.0, 0.0;
  Spectrum spectrum;
  ASSERT_EQ(EstimateSpectrum(Diagonal(diagonal), start, 1e-3, 300, &spectrum), Status::kOk);
  EXPECT_EQ(spectrum.products, 1);
  EXPECT_EQ(spectrum.smallest, 2.0);
  EXPECT_EQ(spectrum.largest, 2.0);
  start << 0.0, 1.0, 1.0, 0.0;
  ASSERT_EQ(EstimateSpectrum(Diagonal(diagonal), start, 1e-3, 300, &spectrum), Status::kOk);
  EXPECT_LE(spectrum.products, 8);
  EXPECT_NEAR(spectrum.smallest, 2.0, 64 * kEpsilon);
  EXPECT_NEAR(spectrum.largest, 5.0, 64 * kEpsilon);
}

TEST(Lanczos, OfNothingIsNothing) {
  Spectrum spectrum;
  const Eigen::VectorXd diagonal = Eigen::VectorXd::Ones(3);
  EXPECT_EQ(EstimateSpectrum(Diagonal(diagonal), Eigen::VectorXd::Zero(3), 1e-3, 9, &spectrum),
            Status::kOk);
  EXPECT_EQ(spectrum.products, 0);
}

TEST(Lanczos, LeavesWhenAProductIsRefused) {
  for (int allowed = 0; allowed < 12; ++allowed) {
    int asked = 0;
    const Multiply multiply = [&](const Eigen::VectorXd& v, Eigen::VectorXd* product) {
      *product = Eigen::VectorXd::LinSpaced(v.size(), 1.0, 2.0).cwiseProduct(v);
      return asked++ < allowed ? Status::kOk : Status::kStop;
    };
    Spectrum spectrum;
    EXPECT_EQ(EstimateSpectrum(multiply, RandomStart(50, 1), 0.0, 30, &spectrum), Status::kStop);
    EXPECT_EQ(asked, allowed + 1);
  }
}

TEST(RandomStart, IsUniformOnItsIntervalAndFollowsTheSeed) {
  const Eigen::VectorXd start = RandomStart(10000, 5);
  EXPECT_EQ(start, RandomStart(10000, 5));
  EXPECT_NE(start, RandomStart(10000, 6));
  EXPECT_LE(start.cwiseAbs().maxCoeff(), 1.0);
  // Of 1e4 uniform numbers: mean 0, mean square 1/3, four standard deviations around each.
  EXPECT_NEAR(start.mean(), 0.0, 4.0 * std::sqrt(1.0 / 3.0) / 100.0);
  EXPECT_NEAR(start.squaredNorm() / 1e4, 1.0 / 3.0, 4.0 * std::sqrt(4.0 / 45.0) / 100.0);
}

}  // namespace
}  // namespace batten
