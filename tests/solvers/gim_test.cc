#include "solvers/gim.h"

#include <gtest/gtest.h>

#include <complex>

#include "tests/solvers/circulant_fit.h"
#include "tests/solvers/contract_cases.h"

namespace batten {
namespace {

double NotedRadius(const SolverTrial& trial) {
  double radius = 0.0;
  EXPECT_TRUE(ParseNumber(trial.context.notes().at("spectral radius of I - A"), &radius));
  return radius;
}

TEST(Gim, ConvergesByTwoThirdsOnAClosedUniformCubic) {
  // The smallest eigenvalue of A is 1/3, at (+1, -1, +1, ...), which even n has.
  const auto problem = MakeCirculantFit(8, 1);
  const SolverTrial trial(*problem, "gim");
  EXPECT_NEAR(NotedRadius(trial), 2.0 / 3.0, 1e-14);
  const std::vector<double>& norms = trial.context.gradient_norms();
  ASSERT_GT(norms.size(), 41U);
  // The next eigenvalue of I - A is (1 - cos(3 pi / 4)) / 3 = 0.569: its part of |g|^2 has fallen
  // by (0.569 / 0.667)^80 = 3e-6.
  EXPECT_NEAR(norms[41] / norms[40], 2.0 / 3.0, 1e-4);
}

TEST(Gim, EachComponentDecaysByItsOwnEigenvalue) {
  const int n = 16;
  const auto problem = MakeCirculantFit(n, 1, 1);
  const DenseFit dense(*problem);
  const SolverTrial trial(*problem, "gim", {5});
  for (int k = 0; k <= n / 2; ++k) {
    const auto component = [&](const Eigen::VectorXd& x) {
      std::complex<double> sum = 0.0;
      for (int j = 0; j < n; ++j) {
        sum += std::polar(1.0, 2.0 * M_PI * k * j / n) * (x[j] - dense.solution(j, 0));
      }
      return std::abs(sum);
    };
    const double decay = 1.0 - CirculantEigenvalue(k, n);
    EXPECT_NEAR(component(trial.context.iterates()[5]),
                std::pow(decay, 5) * component(trial.context.iterates()[0]), 1e-14)
        << k;
  }
}

TEST(Gim, MovesEachControlPointByTheResidualPairedWithIt) {
  for (const bool closed : {true, false}) {
    FitSpec spec = MakeSpec(3, closed, 14);
    spec.knots = KnotRule::kAveraged;
    const auto problem = MakeFit(WithoutWeights(MakeNoisyLoop(14, 2, 8)), spec);
    const CurveFit& fit = *problem->curve_fit();
    const DenseFit dense(*problem);
    const SolverTrial trial(*problem, "gim", {1});
    const Points start = dense.PointsOf(problem->start());
    const Points moves = dense.PointsOf(trial.context.iterates()[1]) - start;
    const Points residuals = dense.q - dense.a * start;
    const std::vector<double> parameters(fit.parameters().data(), fit.parameters().data() + 14);
    const std::vector<int> pairs = PairWithControlPoints(fit.basis(), parameters);
    for (int i = 0; i < 14; ++i) {
      EXPECT_LT((moves.row(pairs[i]) - residuals.row(i)).norm(), 64 * kEpsilon);
    }
  }
}

TEST(Gim, PairsOnUniformKnotsWithTheLargestBasisFunction) {
  for (const int degree : {1, 3, 5}) {
    std::vector<double> parameters;
    for (int i = 0; i < 12; ++i) parameters.push_back(i / 12.0);
    const BsplineBasis basis =
        BasisOf(degree, true, UniformKnots(degree, 12, EndKnots::kPeriodic, 0.0, 1.0));
    const std::vector<int> pairs = PairWithControlPoints(basis, parameters);
    for (int i = 0; i < 12; ++i) {
      for (int j = 0; j < 12; ++j) {
        EXPECT_LE(DenseFit::Coefficient(basis, parameters[i], j),
                  DenseFit::Coefficient(basis, parameters[i], pairs[i]))
            << degree;
      }
    }
  }
}

TEST(Gim, PairingIsOneToOneAndFollowsTheRowsInAnyOrder) {
  std::mt19937 random(20240605);
  for (const bool closed : {true, false}) {
    const SplineKind kind = {3, closed ? EndKnots::kPeriodic : EndKnots::kEndInterpolating, false};
    const BsplineBasis basis = MakeBasis(kind, 20, &random);
    std::vector<double> parameters;
    for (int i = 0; i < 20; ++i) parameters.push_back(RandomParameter(basis, &random));
    const std::vector<int> pairs = PairWithControlPoints(basis, parameters);
    std::vector<int> sorted = pairs;
    std::sort(sorted.begin(), sorted.end());
    for (int j = 0; j < 20; ++j) EXPECT_EQ(sorted[j], j);
    std::vector<double> backwards(parameters.rbegin(), parameters.rend());
    const std::vector<int> pairs_backwards = PairWithControlPoints(basis, backwards);
    for (int i = 0; i < 20; ++i) EXPECT_EQ(pairs[i], pairs_backwards[19 - i]);
  }
}

TEST(Gim, PairsByGrevilleAbscissaeWhereverTheFirstPointLies) {
  const int n = 15;
  const BsplineBasis basis = BasisOf(3, true, UniformKnots(3, n, EndKnots::kPeriodic, 0.0, 1.0));
  for (const double shift : {0.0, 0.01, 0.03, 0.5, 0.97, 0.99}) {
    std::vector<double> parameters;
    for (int i = 0; i < n; ++i) parameters.push_back(basis.Wrap(shift + i / 15.0));
    const std::vector<int> pairs = PairWithControlPoints(basis, parameters);
    for (int i = 0; i < n; ++i) {
      const double distance = std::abs(parameters[i] - basis.Greville(pairs[i]));
      EXPECT_LE(std::min(distance, 1.0 - distance), 0.5 / n + 1e-12) << shift;
    }
  }
}

TEST(Gim, TheRateItSeesIsTheSpectralRadiusItPrints) {
  struct Case {
    const char* knots;
    int first, last;
    double tolerance;
  };
  // Averaged: eigenvalues crowd at the radius, |g| falls like radius^k k^-a with a of about 1,
  // which over these iterations is worth (50 / 20)^(-1 / 30). Uniform knots and centripetal
  // parameters: I
  // - A is far from normal, and |g| falls by up to 0.86 an iteration before it falls by 0.714.
  for (const Case& c : {Case{"averaged", 20, 50, 0.03}, Case{"uniform", 90, 105, 0.05}}) {
    FitSpec spec = MakeSpec(3, true, 100);
    ASSERT_TRUE(FromString(c.knots, &spec.knots));
    const auto problem = MakeFileFit("animals/rhino_100.csv", spec);
    const SolverTrial trial(*problem, "gim", {c.last, -1.0});
    const std::vector<double>& norms = trial.context.gradient_norms();
    ASSERT_EQ(norms.size(), c.last + 1U) << c.knots;
    const double rate = std::pow(norms[c.last] / norms[c.first], 1.0 / (c.last - c.first));
    EXPECT_NEAR(rate, NotedRadius(trial), c.tolerance * NotedRadius(trial)) << c.knots;
  }
}

TEST(Gim, EstimatesTheSpectralRadiusOfManyPointsFromBelow) {
  // Above 300 points by a power iteration, whose growth is a mean.
  const auto problem = MakeCirculantFit(400, 1);
  const SolverTrial trial(*problem, "gim", {1});
  EXPECT_LE(NotedRadius(trial), 2.0 / 3.0 + 1e-12);
  EXPECT_GE(NotedRadius(trial), 2.0 / 3.0 - 1e-2);
}

TEST(Gim, SaysHowManyControlPointsItNeeds) {
  EXPECT_EQ(WhyUnsupported(*MakeFileFit("animals/rhino_100.csv", MakeSpec(3, true, 80)), "gim"),
            "gim needs 100 control points for 100 points");
}

}  // namespace
}  // namespace batten
