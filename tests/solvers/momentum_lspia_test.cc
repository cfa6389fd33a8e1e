// The iterations with weights from the spectrum of A'A, against their recursions in dense algebra.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/solvers/circulant_fit.h"
#include "tests/solvers/contract_cases.h"

namespace batten {
namespace {

/// On a closed uniform cubic with one point per span and an even number of points: the squares of
/// (2 + 1) / 3 and (2 - 1) / 3.
constexpr double kLargest = 1.0;
constexpr double kSmallest = 1.0 / 9.0;
constexpr double kRootLargest = 1.0;
constexpr double kRootSmallest = 1.0 / 3.0;
/// With 8 control points N has 5 distinct eigenvalues and the Lanczos recursion ends with all of
/// them: the solvers' estimates are exact but for rounding, and so are the iterates.
constexpr int kControlPoints = 8;
constexpr double kRoundingOfIterates = 1e-12;

/// A'(Q - A P).
using Residual = std::function<Points(const Points&)>;

/// `next(residual, k, P_0..P_k)` gives P_(k+1); compared with the solver's `count` iterates.
void ExpectIterates(
    const Problem& problem, const std::string& solver, int count,
    const std::function<Points(const Residual&, int, const std::vector<Points>&)>& next) {
  const DenseFit dense(problem);
  const Residual residual = [&dense](const Points& p) {
    return Points(dense.a.transpose() * (dense.q - dense.a * p));
  };
  std::vector<Points> points = {dense.PointsOf(problem.start())};
  const SolverTrial trial(problem, solver, {count, -1.0, false});
  ASSERT_EQ(trial.iterations(), count) << solver;
  for (int k = 0; k < count; ++k) {
    points.push_back(next(residual, k, points));
    const Points found = dense.PointsOf(trial.context.iterates()[static_cast<std::size_t>(k) + 1]);
    EXPECT_LT((found - points.back()).norm(), kRoundingOfIterates) << solver << " " << k + 1;
  }
}

/// P_(k-1), or P_0.
const Points& Before(const std::vector<Points>& points) {
  return points[points.size() < 2 ? 0 : points.size() - 2];
}

TEST(PolyakLspia, IsTheHeavyBallWithTheWeightsOfTheSpectrum) {
  const double sum = kRootLargest + kRootSmallest;
  const double step = 4.0 / (sum * sum);                                      // 9 / 4
  const double momentum = std::pow((kRootLargest - kRootSmallest) / sum, 2);  // 1 / 4
  ExpectIterates(
      *MakeCirculantFit(kControlPoints, 1), "polyak_lspia", 30,
      [=](const Residual& residual, int, const std::vector<Points>& p) {
        return Points(p.back() + step * residual(p.back()) + momentum * (p.back() - Before(p)));
      });
}

TEST(NesterovLspia, StepsFromThePointAheadByOneOverTheLargestEigenvalue) {
  const double momentum = (kRootLargest - kRootSmallest) / (kRootLargest + kRootSmallest);  // 1 / 2
  ExpectIterates(*MakeCirculantFit(kControlPoints, 1), "nesterov_lspia", 30,
                 [=](const Residual& residual, int, const std::vector<Points>& p) {
                   const Points ahead = p.back() + momentum * (p.back() - Before(p));
                   return Points(ahead + residual(ahead) / kLargest);
                 });
}

TEST(Mlspia, MovesByWeightedSumsOfAllResidualsSoFar) {
  // As published, with one sum L per data point: L = w (Q - A P) at first.
  const auto problem = MakeCirculantFit(kControlPoints, 1);
  const DenseFit dense(*problem);
  const double weight =
      4.0 * kRootLargest * kRootSmallest / std::pow(kRootLargest + kRootSmallest, 2);  // 3 / 4
  const double step = 1.0 / (kRootLargest * kRootSmallest);                            // 3
  Eigen::MatrixXd sums = weight * (dense.q - dense.a * dense.PointsOf(problem->start()));
  ExpectIterates(*problem, "mlspia", 30, [&](const Residual&, int, const std::vector<Points>& p) {
    const Points next = p.back() + step * dense.a.transpose() * sums;
    sums = ((1.0 - weight) * sums - weight * step * dense.a * (dense.a.transpose() * sums) +
            weight * (dense.q - dense.a * p.back()))
               .eval();
    return next;
  });
}

TEST(ChebyshevLspia, StepsByTheInverseChebyshevRoots) {
  for (const int cycle : {1, 3, 8}) {
    ExpectIterates(
        *MakeCirculantFit(kControlPoints, 1), "chebyshev_lspia/cycle=" + std::to_string(cycle),
        2 * cycle + 1, [cycle](const Residual& residual, int k, const std::vector<Points>& p) {
          const double root = std::cos((2.0 * (k % cycle) + 1.0) * M_PI / (2.0 * cycle));
          const double step = 2.0 / (kLargest + kSmallest + (kLargest - kSmallest) * root);
          return Points(p.back() + step * residual(p.back()));
        });
  }
}

TEST(ChebyshevLspia, ACycleEndsWhereTheThreeTermRecurrenceDoes) {
  // Golub & Varga: P_(k+1) = P_(k-1) + w_(k+1) (P_k + 2 / (l1 + ln) D_k - P_(k-1)), w_1 = 1,
  // w_2 = 1 / (1 - r^2 / 2), w_(k+1) = 1 / (1 - r^2 w_k / 4), r = (l1 - ln) / (l1 + ln).
  const auto problem = MakeCirculantFit(kControlPoints, 1);
  const DenseFit dense(*problem);
  const double rho = (kLargest - kSmallest) / (kLargest + kSmallest);
  for (const int cycle : {1, 2, 5, 8}) {
    Points before = dense.PointsOf(problem->start());
    Points p = before;
    double w = 1.0;
    for (int k = 0; k < cycle; ++k) {
      if (k > 0) w = 1.0 / (1.0 - rho * rho * (k == 1 ? 0.5 : 0.25 * w));
      const Points direction = dense.a.transpose() * (dense.q - dense.a * p);
      const Points next = before + w * (p + 2.0 / (kLargest + kSmallest) * direction - before);
      before = p;
      p = next;
    }
    const SolverTrial trial(*problem, "chebyshev_lspia/cycle=" + std::to_string(cycle),
                            {cycle, -1.0, false});
    EXPECT_LT((dense.PointsOf(trial.x) - p).norm(), kRoundingOfIterates) << cycle;
  }
}

TEST(MomentumLspia, PolyakAndMlspiaAreOneIteration) {
  // N's spectrum bounds what a rounding of an iterate is worth in the next ones; 2 000 of them.
  constexpr double kRounding = 2000 * kEpsilon;
  for (const ContractProblem& contract : TwoProblems()) {
    const auto problem = contract.make();
    const SolverTrial polyak(*problem, "polyak_lspia", {60, -1.0, false});
    const SolverTrial mlspia(*problem, "mlspia", {60, -1.0, false});
    ASSERT_EQ(polyak.iterations(), 60);
    ASSERT_EQ(mlspia.iterations(), 60);
    for (std::size_t k = 0; k <= 60; ++k) {
      const Eigen::VectorXd& x = polyak.context.iterates()[k];
      EXPECT_LT((x - mlspia.context.iterates()[k]).norm(), kRounding * (1.0 + x.norm()))
          << contract.name << ", iteration " << k;
    }
  }
}

TEST(MomentumLspia, NotesTheRateThatItsTheoremGives) {
  const auto problem = MakeCirculantFit(kControlPoints, 1);
  const auto noted = [&](const std::string& solver) {
    return Noted(SolverTrial(*problem, solver, {1}), "predicted rate");
  };
  constexpr double kRounding = 1e-10;
  EXPECT_NEAR(noted("polyak_lspia"), 0.5, kRounding);
  EXPECT_NEAR(noted("mlspia"), 0.5, kRounding);
  // Roots of z^2 - (1 + e) (1 - l / l1) z + e (1 - l / l1): at ln in size (e (1 - ln / l1))^(1/2).
  EXPECT_NEAR(noted("nesterov_lspia"), std::sqrt(0.5 * 8.0 / 9.0), kRounding);
  // (1 / T_8(5/4))^(1/8), T_8(5/4) = (2^8 + 2^-8) / 2.
  EXPECT_NEAR(noted("chebyshev_lspia"), std::pow(2.0 / (256.0 + 1.0 / 256.0), 0.125), kRounding);
}

TEST(Lspia, CauchyStepIsTheBestOneOfEachIteration) {
  const auto problem = MakeFit(MakeNoisyLoop(60, 2, 31), MakeSpec(3, false, 14));
  const DenseFit dense(*problem);
  for (const double relaxation : {1.0, 0.7}) {
    const SolverTrial trial(*problem, "lspia/step=cauchy/relaxation=" + NumberText(relaxation),
                            {12, -1.0, false});
    for (std::size_t k = 0; k + 1 < trial.context.iterates().size(); ++k) {
      const Points p = dense.PointsOf(trial.context.iterates()[k]);
      const Points d = dense.a.transpose() * (dense.q - dense.a * p);
      const double step = d.squaredNorm() / (dense.a * d).squaredNorm();
      const Points move = dense.PointsOf(trial.context.iterates()[k + 1]) - p;
      EXPECT_LT((move - relaxation * step * d).norm(), kRoundingOfIterates) << k;
    }
  }
}

TEST(Lspia, BarzilaiBorweinStepIsThatOfTheLastMove) {
  const auto problem = MakeFit(MakeNoisyLoop(60, 2, 32), MakeSpec(3, true, 14));
  const DenseFit dense(*problem);
  const SolverTrial trial(*problem, "lspia/step=barzilai_borwein", {12, -1.0, false});
  const Eigen::MatrixXd n = dense.a.transpose() * dense.a;
  Points last_move;
  for (std::size_t k = 0; k + 1 < trial.context.iterates().size(); ++k) {
    const Points p = dense.PointsOf(trial.context.iterates()[k]);
    const Points d = dense.a.transpose() * (dense.q - dense.a * p);
    const double step = k == 0 ? 1.0 / n.cwiseAbs().rowwise().sum().maxCoeff()
                               : last_move.squaredNorm() / (dense.a * last_move).squaredNorm();
    last_move = dense.PointsOf(trial.context.iterates()[k + 1]) - p;
    // The step comes from differences of residuals, which lose digits as they shrink: here three.
    EXPECT_LT((last_move - step * d).norm(), 1e3 * kRoundingOfIterates * d.norm() + 1e-15) << k;
  }
}

}  // namespace
}  // namespace batten
