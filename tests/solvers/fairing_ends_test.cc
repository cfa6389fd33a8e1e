#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <cmath>

#include "tests/solvers/contract_cases.h"
#include "tests/solvers/dense_fit.h"

namespace batten {
namespace {

/// Rows of the problem's terms, dense.
struct DenseTerms {
  explicit DenseTerms(const Problem& problem) {
    const CurveFit& fit = *problem.curve_fit();
    n = fit.basis().num_control_points();
    for (const Problem::TermInstance& term : problem.terms()) {
      const NormalBand band = NormalBand::FromRows(*term.family->rows());
      grams.push_back(band.ToDense());
      right_sides.push_back(band.right_hand_side());
    }
  }
  int n = 0;
  std::vector<Eigen::MatrixXd> grams;
  std::vector<Points> right_sides;
};

/// Control points of the polynomials 1, t, .., t^(k-1): blossoms at the knots behind each.
Eigen::MatrixXd PolynomialControlPoints(const BsplineBasis& basis, int k) {
  const int n = basis.num_control_points();
  Eigen::MatrixXd columns = Eigen::MatrixXd::Ones(n, basis.periodic() ? 1 : k);
  for (int j = 0; j < n; ++j) {
    // Elementary symmetric sums of the p knots, over their number of products.
    double first = 0.0, second = 0.0;
    for (int i = 1; i <= basis.degree(); ++i) {
      second += first * basis.knots()[j + i];
      first += basis.knots()[j + i];
    }
    const int p = basis.degree();
    if (columns.cols() > 1) columns(j, 1) = first / p;
    if (columns.cols() > 2) columns(j, 2) = second / (p * (p - 1) / 2.0);
  }
  return columns;
}

struct FairEnd {
  Points limit;           ///< Nearest polynomial.
  double bias = 0.0;      ///< Largest move of a control point by the finite weight, first order.
  double rounding = 0.0;  ///< What roundings of the heavy rows are worth.
};

/// Of E = |A P - Q|^2 + weight |D P|^2, W = D'D.
FairEnd MakeFairEnd(const DenseTerms& dense, const Eigen::MatrixXd& null_space, double weight) {
  const Eigen::MatrixXd& normal = dense.grams[0];
  const Eigen::MatrixXd w = dense.grams[1] / weight;
  const Eigen::MatrixXd q = null_space.householderQr().householderQ() *
                            Eigen::MatrixXd::Identity(dense.n, null_space.cols());
  const Eigen::MatrixXd reduced = q.transpose() * normal * q;
  const auto solve = [&](const Eigen::MatrixXd& right) {
    return Eigen::MatrixXd(q * reduced.ldlt().solve(q.transpose() * right));
  };
  FairEnd end;
  end.limit = solve(dense.right_sides[0]);
  const Eigen::MatrixXd pull = dense.right_sides[0] - normal * end.limit;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(w);
  const int k = static_cast<int>(null_space.cols());
  const Eigen::VectorXd values = eigen.eigenvalues().tail(dense.n - k);
  const Eigen::MatrixXd vectors = eigen.eigenvectors().rightCols(dense.n - k);
  const Eigen::MatrixXd bent =
      vectors * (values.cwiseInverse().asDiagonal() * (vectors.transpose() * pull)) / weight;
  end.bias = (bent - solve(normal * bent)).cwiseAbs().maxCoeff();
  const double largest = values(values.size() - 1);
  // Entries of heavy rows carry some roundings: the curve bends by their product with the
  // condition of D; and what the rows are off on polynomials pulls at these as a penalty.
  const double relative = 32 * kEpsilon;
  const double lightest = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(reduced).eigenvalues()(0);
  end.rounding = relative * std::sqrt(largest / values(0)) +
                 std::pow(4 * kEpsilon, 2) * weight * largest / lightest;
  return end;
}

DataSet MakeOpenData(int num_points) {
  DataSet data = WithoutWeights(MakeNoisyLoop(num_points, 2, 77));
  for (int i = 0; i < num_points; ++i) data.points(i, 0) += 0.02 * i;
  return data;
}

std::unique_ptr<Problem> MakeSmoothing(bool closed, int m, int n, int k, double weight) {
  return MakeFit(MakeOpenData(m), MakeSpec(3, closed, n,
                                           "interpolation,fairing/derivative=" + std::to_string(k) +
                                               "/weight=" + NumberText(weight)));
}

TEST(FairingEnds, HeavyFairingLeadsToTheNearestPolynomialAndOfClosedCurvesToAPoint) {
  for (const bool closed : {false, true}) {
    for (const int k : {1, 2, 3}) {
      for (const auto& [m, n] : {std::pair(50, 20), std::pair(200, 200)}) {
        for (const double weight : {1e4, 1e8, 1e12, 1e16}) {
          SCOPED_TRACE((closed ? "closed k = " : "open k = ") + std::to_string(k) +
                       " n = " + std::to_string(n) + " weight " + NumberText(weight));
          const auto problem = MakeSmoothing(closed, m, n, k, weight);
          const SolverTrial trial(*problem, "banded_qr");
          EXPECT_EQ(trial.outcome.reason, StopReason::kSolved);
          EXPECT_EQ(trial.outcome.message, "");
          const Eigen::MatrixXd polynomials =
              PolynomialControlPoints(problem->curve_fit()->basis(), k);
          const FairEnd end = MakeFairEnd(DenseTerms(*problem), polynomials, weight);
          const Eigen::Map<const Points> found(trial.x.data(), n, 2);
          const double distance = (found - end.limit).cwiseAbs().maxCoeff();
          EXPECT_LE(distance, 1.5 * end.bias + end.rounding);
          EXPECT_LE(distance, k == 2 && weight == 1e16 ? 1e-7 : 1.0);
        }
      }
    }
  }
}

TEST(FairingEnds, FairingTooHeavyForTheLineIsSaidToBe) {
  // The weight at which what is found and the line part is where it has to be said.
  for (const double weight : {1e16, 1e20, 1e22, 1e24, 1e26, 1e28, 1e30}) {
    SCOPED_TRACE(weight);
    const auto problem = MakeSmoothing(false, 200, 200, 2, weight);
    const SolverTrial trial(*problem, "banded_qr");
    EXPECT_EQ(trial.outcome.reason, StopReason::kSolved);
    const FairEnd end = MakeFairEnd(
        DenseTerms(*problem), PolynomialControlPoints(problem->curve_fit()->basis(), 2), weight);
    const Eigen::Map<const Points> found(trial.x.data(), 200, 2);
    const double distance = (found - end.limit).cwiseAbs().maxCoeff();
    const bool is_said = trial.outcome.message.find("outweigh") != std::string::npos;
    EXPECT_TRUE(is_said || distance <= 1e-2) << distance;
    EXPECT_EQ(is_said, weight >= 1e24) << distance;
    if (weight >= 1e28) {
      EXPECT_THAT(trial.outcome.message, ::testing::HasSubstr("about 0 digits"));
    }
  }
}

TEST(FairingEnds, LightFairingLeadsToTheCurveWithoutIt) {
  for (const bool closed : {false, true}) {
    for (const int n : {40, 50}) {
      const auto plain = MakeFit(MakeOpenData(50), MakeSpec(3, closed, n));
      const SolverTrial without(*plain, "banded_qr");
      const DenseFit dense(*plain);
      for (const double weight : {1e-16, 1e-12, 1e-8}) {
        const auto problem = MakeSmoothing(closed, 50, n, 2, weight);
        const SolverTrial trial(*problem, "banded_qr");
        EXPECT_EQ(trial.outcome.reason, StopReason::kSolved);
        const DenseTerms terms(*problem);
        const Eigen::Map<const Points> start(without.x.data(), n, 2);
        const double bias =
            terms.grams[0].ldlt().solve(terms.grams[1] * start).cwiseAbs().maxCoeff();
        const double rounding = 64 * kEpsilon * dense.condition();
        EXPECT_LE((trial.x - without.x).cwiseAbs().maxCoeff(), 1.5 * bias + rounding)
            << n << " weight " << weight;
      }
    }
  }
}

TEST(FairingEnds, NormalEquationsSayWhereTheyLoseTheLineThatQrKeeps) {
  const auto problem = MakeSmoothing(false, 200, 200, 2, 1e16);
  const FairEnd end = MakeFairEnd(DenseTerms(*problem),
                                  PolynomialControlPoints(problem->curve_fit()->basis(), 2), 1e16);
  const SolverTrial trial(*problem, "banded_cholesky");
  EXPECT_THAT(trial.outcome.message,
              ::testing::HasSubstr("singular to working precision; solved by banded QR"));
  const Eigen::Map<const Points> found(trial.x.data(), 200, 2);
  EXPECT_LE((found - end.limit).cwiseAbs().maxCoeff(), 1e-7);
}

}  // namespace
}  // namespace batten
