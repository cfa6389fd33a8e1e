#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "problems/test_functions.h"
#include "tests/roundoff.h"
#include "tests/solvers/contract_cases.h"

namespace batten {
namespace {

std::unique_ptr<Problem> ClosedFit() {
  return MakeFit(MakeNoisyLoop(50, 2, 1), MakeSpec(3, true, 17));
}

TEST_P(EverySolver, RunsOrRefusesLosses) {
  for (const char* terms : {"interpolation/loss=cauchy/loss_scale=0.01",
                            "interpolation,interpolation/loss=huber/loss_scale=0.02"}) {
    SCOPED_TRACE(terms);
    ExpectRunsOrRefuses(*MakeFit(MakeNoisyLoop(50, 2, 1), MakeSpec(3, true, 17, terms)), name());
  }
}

TEST_P(EverySolver, RunsOrRefusesWeightsAndSeveralTerms) {
  ExpectRunsOrRefuses(*MakeFit(WithoutWeights(MakeNoisyLoop(20, 3, 1)),
                               MakeSpec(3, true, 20, "interpolation/weight=0.25")),
                      name());
  ExpectRunsOrRefuses(*MakeFit(MakeNoisyLoop(20, 1, 1),
                               MakeSpec(2, false, 20, "interpolation,interpolation/weight=3")),
                      name());
}

TEST_P(EverySolver, RunsOrRefusesUncompiledTerms) {
  ExpectRunsOrRefuses(*ClosedFit(), name(), false);
  ExpectRunsOrRefuses(*InterpolationProblems()[5].make(), name(), false);
}

TEST_P(EverySolver, RunsOrRefusesProblemsWithoutACurve) {
  for (const TestFunction& function : TestFunctions()) {
    SCOPED_TRACE(function.name);
    ExpectRunsOrRefuses(*MakeTestProblem(function.name), name());
  }
}

TEST_P(EverySolver, RunsOrRefusesConstraintsOnOneCoordinate) {
  const auto problem = ClosedFit();
  std::string error;
  ASSERT_TRUE(problem->SetLinearConstraints(
      {{"y of P_2 is twice that of P_3", {{5, 1.0}, {7, -2.0}}, 0.1}}, &error))
      << error;
  ExpectRunsOrRefuses(*problem, name());
  const std::vector<std::string> supports = SolverRegistry::Global().Find(GetParam())->supports;
  const bool claims =
      std::find(supports.begin(), supports.end(), "linear constraints") != supports.end();
  if (!claims || needs_free_parameters()) return;
  ASSERT_EQ(WhyUnsupported(*problem, name()), "");
  const SolverTrial trial(*problem, name());
  EXPECT_NEAR(trial.all[5] - 2.0 * trial.all[7], 0.1, 16 * kEpsilon);
  // The gradient along the constraint, from the dense matrix: x_7, whose coefficient is the larger
  // one, is given up and goes half the way of x_5.
  const DenseFit dense(*problem);
  const Points g = 2.0 * dense.a.transpose() * (dense.a * dense.PointsOf(trial.all) - dense.q);
  double squared = 0.0;
  for (Eigen::Index i = 0; i < g.size(); ++i) {
    if (i != 7) squared += std::pow(g.data()[i] + (i == 5 ? 0.5 * g.data()[7] : 0.0), 2);
  }
  const double rounding = 256 * kEpsilon * dense.a.norm() * dense.condition();
  EXPECT_LE(std::sqrt(squared), 1.01 * trial.context.gradient_norms().back() + rounding)
      << ToString(trial.outcome.reason) << " " << trial.outcome.message;
}

TEST_P(EverySolver, HoldsNonlinearConstraintsOrRefusesThem) {
  std::string error;
  for (const char* constraint :
       {"curvature/t=0.4/kappa=-3", "tangent/t=0.4/x=1/y=2", "point/free=1/x=0.1/y=0.2"}) {
    for (const bool through_all : {false, true}) {
      SCOPED_TRACE(constraint);
      FitSpec spec = MakeSpec(3, true, through_all ? 50 : 17);
      ASSERT_TRUE(ParseNameSpecList(constraint, &spec.constraints, &error)) << error;
      const auto problem = MakeFit(WithoutWeights(MakeNoisyLoop(50, 2, 1)), spec);
      const std::string why = WhyUnsupported(*problem, name());
      if (GetParam() == "augmented_lagrangian") {
        EXPECT_EQ(why, "");
      } else {
        ExpectOneSentenceWithAWayOut(why, name());
      }
    }
    FitSpec spec = MakeFreeSpec(3, true, 12);
    ASSERT_TRUE(ParseNameSpecList(constraint, &spec.constraints, &error)) << error;
    const auto problem = MakeFit(WithoutWeights(MakeNoisyBean(60, 2, 301)), spec);
    const std::string why = WhyUnsupported(*problem, free_name());
    if (GetParam() == "augmented_lagrangian") {
      EXPECT_EQ(why, "");
    } else {
      ExpectOneSentenceWithAWayOut(why, free_name());
    }
  }
}

TEST_P(EverySolver, HonoursBoundsOrRefusesThem) {
  const auto problem = ClosedFit();
  // The box of the data is about [-0.5, 0.5]^2: some control points want to be outside.
  const Eigen::VectorXd upper = Eigen::VectorXd::Constant(problem->num_variables(), 0.3);
  problem->SetBounds(-upper, upper);
  const std::string why = WhyUnsupported(*problem, name());
  if (!why.empty()) {
    ExpectOneSentenceWithAWayOut(why, name());
    return;
  }
  const SolverTrial trial(*problem, name());
  const DenseFit dense(*problem);
  const auto dense_energy = [&dense](const Eigen::VectorXd& x) {
    return (dense.a * dense.PointsOf(x) - dense.q).squaredNorm();
  };
  for (const Eigen::VectorXd& x : trial.context.iterates()) {
    ASSERT_LE(x.cwiseAbs().maxCoeff(), 0.3);
  }
  EXPECT_LT(dense_energy(trial.x), dense_energy(problem->start().cwiseMax(-upper).cwiseMin(upper)));
  if (!IsSuccess(trial.outcome.reason)) return;
  // At the minimum g pushes against the bounds that hold, and vanishes elsewhere.
  const Points g = 2.0 * dense.a.transpose() * (dense.a * dense.PointsOf(trial.x) - dense.q);
  const double small = 1e-6 * trial.context.gradient_norms().front();
  for (Eigen::Index i = 0; i < g.size(); ++i) {
    const double x = trial.x[i], slope = g.data()[i];
    if (std::abs(x) == 0.3) {
      EXPECT_LE(slope * x, small) << i;
    } else {
      EXPECT_NEAR(slope, 0.0, small) << i;
    }
  }
}

/// sum_j N_j(u) P_j = target, coordinate by coordinate.
std::vector<LinearConstraint> ThroughPoint(const CurveFit& fit, double u,
                                           const Eigen::RowVectorXd& target) {
  std::vector<LinearConstraint> constraints;
  for (int c = 0; c < fit.dimension(); ++c) {
    LinearConstraint constraint;
    constraint.name = "coordinate " + std::to_string(c) + " at " + NumberText(u);
    for (int j = 0; j < fit.basis().num_control_points(); ++j) {
      const double coefficient = DenseFit::Coefficient(fit.basis(), u, j);
      if (coefficient != 0.0) {
        constraint.coefficients.emplace_back(j * fit.dimension() + c, coefficient);
      }
    }
    constraint.value = target[c];
    constraints.push_back(constraint);
  }
  return constraints;
}

/// Minimiser of ||A P - Q|| subject to C P = targets, from the conditions of Karush, Kuhn and
/// Tucker.
Points KktSolution(const DenseFit& dense, const Eigen::MatrixXd& c, const Points& targets) {
  const auto n = dense.a.cols();
  const auto k = c.rows();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n + k, n + k);
  matrix.topLeftCorner(n, n) = dense.a.transpose() * dense.a;
  matrix.topRightCorner(n, k) = c.transpose();
  matrix.bottomLeftCorner(k, n) = c;
  Eigen::MatrixXd right(n + k, targets.cols());
  right << dense.a.transpose() * dense.q, targets;
  return matrix.fullPivLu().solve(right).topRows(n);
}

void ExpectHoldsCurveAt(const std::string& solver, int degree, bool closed, int dimension,
                        const std::vector<double>& parameters) {
  const auto problem = MakeFit(MakeNoisyLoop(50, dimension, 11), MakeSpec(degree, closed, 16));
  const CurveFit& fit = *problem->curve_fit();
  const DenseFit dense(*problem);
  std::vector<LinearConstraint> constraints;
  Eigen::MatrixXd c(parameters.size(), dense.a.cols());
  Points targets(parameters.size(), dimension);
  std::mt19937 random(20240503);
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    for (int j = 0; j < c.cols(); ++j) {
      c(static_cast<Eigen::Index>(k), j) = DenseFit::Coefficient(fit.basis(), parameters[k], j);
    }
    const Points drawn = RandomPoints(1, dimension, &random);
    for (int i = 0; i < dimension; ++i)
      targets(static_cast<Eigen::Index>(k), i) = 0.3 * drawn(0, i);
    for (auto& constraint :
         ThroughPoint(fit, parameters[k], targets.row(static_cast<Eigen::Index>(k)))) {
      constraints.push_back(std::move(constraint));
    }
  }
  std::string error;
  ASSERT_TRUE(problem->SetLinearConstraints(constraints, &error)) << error;
  if (!WhyUnsupported(*problem, solver).empty()) return;
  const SolverTrial trial(*problem, solver);
  const Points expected = KktSolution(dense, c, targets);
  // x - x* = Z (y - y*), and no direction that the constraints leave is flatter than A's flattest.
  const double z_norm = problem->elimination().z().norm();
  const double rounding = 256 * kEpsilon * z_norm * dense.condition() * dense.condition();
  EXPECT_LT((dense.PointsOf(trial.all) - expected).norm(),
            z_norm * dense.DistanceFor(trial.context.gradient_norms().back()) + rounding)
      << ToString(trial.outcome.reason) << " " << trial.outcome.message;
  EXPECT_LT((c * dense.PointsOf(trial.all) - targets).cwiseAbs().maxCoeff(), 16 * kEpsilon);
}

TEST_P(EverySolver, HoldsTheCurveAtAPointAsTheKktConditionsSay) {
  const auto problem = ClosedFit();
  std::string error;
  ASSERT_TRUE(problem->SetLinearConstraints(
      ThroughPoint(*problem->curve_fit(), 0.37, Eigen::RowVector2d(0.1, 0.2)), &error))
      << error;
  const std::string why = WhyUnsupported(*problem, name());
  if (!why.empty()) {
    ExpectOneSentenceWithAWayOut(why, name());
    return;
  }
  ExpectHoldsCurveAt(name(), 3, true, 2, {0.37});
  ExpectHoldsCurveAt(name(), 3, true, 1, {0.99, 0.02});  // across the joint
  ExpectHoldsCurveAt(name(), 2, false, 3, {0.0, 0.55});
  ExpectHoldsCurveAt(name(), 5, false, 2, {0.41, 0.43});
}

}  // namespace
}  // namespace batten
