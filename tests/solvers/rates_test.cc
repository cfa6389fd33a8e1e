// How fast methods converge, against the theory of their iteration matrices.

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "tests/solvers/circulant_fit.h"
#include "tests/solvers/contract_cases.h"

namespace batten {
namespace {

/// Between these parts of the start's gap slopes are measured: late enough that one eigenvalue is
/// left, before the rounding of P*, a square of some 1e-14.
constexpr double kHigh = 1e-16;
constexpr double kLow = 1e-24;
/// Of the logarithm of a rate. In it are what is left of the other eigenvalues, and eigenvalues of
/// A'A that the solvers estimate to 1e-3.
constexpr double kTolerance = 0.05;

/// ||A (P_k - P*)||^2 of a run's iterates over that of its start. The start is random, so that no
/// eigenvector is missing in it.
std::vector<double> Gaps(const Problem& problem, const DenseFit& dense, const std::string& solver) {
  TestContext context(problem, {2000, -1.0, false});
  Objective objective(&problem, &context);
  std::mt19937 random(20240710);
  const Points start = RandomPoints(static_cast<int>(dense.a.cols()), 2, &random);
  Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(start.data(), start.size());
  MakeSolver(solver)->Minimize(&objective, &context, &x);
  std::vector<double> gaps;
  for (const Eigen::VectorXd& iterate : context.iterates()) {
    gaps.push_back(dense.Gap(iterate) / dense.Gap(context.iterates().front()));
    if (gaps.back() < kLow) break;
  }
  EXPECT_LT(gaps.back(), kLow) << solver;
  return gaps;
}

/// Whole cycles between kHigh and kLow.
struct Stretch {
  Stretch(const std::vector<double>& gaps, int cycle) {
    while (gaps[static_cast<std::size_t>(first)] > kHigh) first += cycle;
    last = first + (static_cast<int>(gaps.size()) - 2 - first) / cycle * cycle;
    EXPECT_GT(last, first);
    slope = std::log(gaps[static_cast<std::size_t>(last)] / gaps[static_cast<std::size_t>(first)]) /
            (last - first);
  }
  int first = 0;
  int last = 0;
  double slope = 0.0;  // mean logarithm of the gap's factor per iteration
};

void ExpectSlope(const Problem& problem, const DenseFit& dense, const std::string& solver,
                 double log_rate, int cycle = 1) {
  const double slope = Stretch(Gaps(problem, dense, solver), cycle).slope;
  // The gap is a square: it falls with that of the error's rate.
  EXPECT_NEAR(slope, 2.0 * log_rate, -kTolerance * 2.0 * log_rate) << solver;
}

TEST(Rates, GimConvergesByTheSpectralRadiusOfOneMinusA) {
  // Closed uniform cubic, even n: 2/3.
  const auto circulant = MakeCirculantFit(16, 1);
  ExpectSlope(*circulant, DenseFit(*circulant), "gim", std::log(2.0 / 3.0));
  FitSpec spec = MakeSpec(3, true, 100);
  spec.parameters = Parameterization::kUniform;
  const auto rhino = MakeFileFit("animals/rhino_100.csv", spec);
  ExpectSlope(*rhino, DenseFit(*rhino), "gim", std::log(2.0 / 3.0));
}

TEST(Rates, LspiaWithTheOptimalStepConvergesByBothEndsOfTheSpectrum) {
  for (const auto& problem : {MakeCirculantFit(16, 1), Dolphin()}) {
    const DenseFit dense(*problem);
    const double l1 = dense.largest * dense.largest;
    const double ln = dense.smallest * dense.smallest;
    ExpectSlope(*problem, dense, "lspia/step=optimal", std::log((l1 - ln) / (l1 + ln)));
  }
}

TEST(Rates, ChebyshevConvergesPerCycleByItsPolynomial) {
  for (const auto& problem : {MakeCirculantFit(16, 1), Dolphin()}) {
    const DenseFit dense(*problem);
    const double l1 = dense.largest * dense.largest;
    const double ln = dense.smallest * dense.smallest;
    for (const int cycle : {2, 4, 8}) {
      // T_K(x) = cosh(K arcosh x).
      const double t = std::cosh(cycle * std::acosh((l1 + ln) / (l1 - ln)));
      ExpectSlope(*problem, dense, "chebyshev_lspia/cycle=" + std::to_string(cycle),
                  -std::log(t) / cycle, cycle);
    }
  }
}

TEST(Rates, SorConvergesByTheSpectralRadiusOfItsMatrix) {
  for (const auto& problem : {MakeCirculantFit(16, 1), Dolphin()}) {
    const DenseFit dense(*problem);
    const Eigen::MatrixXd n = dense.a.transpose() * dense.a;
    for (const double w : {0.5, 1.0, 1.5}) {
      // I - (L + D / w)^-1 N, D and L diagonal and strictly lower triangle of N.
      Eigen::MatrixXd triangle = n.triangularView<Eigen::StrictlyLower>();
      triangle.diagonal() = n.diagonal() / w;
      const Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(n.rows(), n.cols()) -
                                     triangle.triangularView<Eigen::Lower>().solve(n);
      const Eigen::VectorXcd values =
          Eigen::EigenSolver<Eigen::MatrixXd>(matrix, false).eigenvalues();
      ExpectSlope(*problem, dense, "sor_pia/w=" + NumberText(w),
                  std::log(values.cwiseAbs().maxCoeff()));
    }
  }
}

TEST(Rates, PolyakConvergesByTheRootsOfTheSpectrum) {
  for (const auto& problem : {MakeCirculantFit(16, 1), Dolphin()}) {
    const DenseFit dense(*problem);
    const double q = (dense.largest - dense.smallest) / (dense.largest + dense.smallest);
    const Stretch stretch(Gaps(*problem, dense, "polyak_lspia"), 1);
    // At both ends of the spectrum the root is double: the error falls like k q^k.
    const double growth = std::log(static_cast<double>(stretch.last) / stretch.first);
    const double theory = 2.0 * (std::log(q) + growth / (stretch.last - stretch.first));
    EXPECT_NEAR(stretch.slope, theory, -kTolerance * theory);
  }
}

TEST(Rates, ConjugateGradientsAreNeverSlowerThanTheirBound) {
  for (const auto& problem : {MakeCirculantFit(16, 1), Dolphin()}) {
    const DenseFit dense(*problem);
    // |P_k - P*|_N <= 2 q^k |P_0 - P*|_N, q from the root of N's condition, which is A's condition.
    const double q = (dense.condition() - 1.0) / (dense.condition() + 1.0);
    const std::vector<double> gaps = Gaps(*problem, dense, "cg");
    for (std::size_t k = 0; k < gaps.size(); ++k) {
      const double bound = 2.0 * std::pow(q, static_cast<double>(k));
      EXPECT_LE(gaps[k], bound * bound + kLow) << k;
    }
  }
}

}  // namespace
}  // namespace batten
