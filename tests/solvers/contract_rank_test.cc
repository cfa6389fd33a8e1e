#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/roundoff.h"
#include "tests/solvers/contract_cases.h"

namespace batten {
namespace {

using ::testing::HasSubstr;

/// Points of a loop at given parameters.
std::unique_ptr<Problem> AtParameters(const std::vector<double>& parameters, FitSpec spec,
                                      int dimension) {
  DataSet data = MakeNoisyLoop(static_cast<int>(parameters.size()), dimension, 31);
  data.parameters = Eigen::Map<const Eigen::VectorXd>(parameters.data(),
                                                      static_cast<Eigen::Index>(parameters.size()));
  spec.parameters.reset();
  spec.domain = {0.0, 1.0};
  return MakeFit(std::move(data), spec);
}

/// num_groups parameters in [0, 1), at a fraction of their steps, each `times` times.
std::vector<double> Repeated(int num_groups, int times, double fraction) {
  std::vector<double> parameters;
  for (int i = 0; i < num_groups * times; ++i) {
    parameters.push_back((i / times + fraction) / num_groups);
  }
  return parameters;
}

/// Even in (0, 1) but for the middle fifth, which is empty.
std::vector<double> WithAHole(int num_points) {
  std::vector<double> parameters;
  for (int i = 0; i < num_points; ++i) {
    const double t = 0.8 * (i + 0.5) / num_points;
    parameters.push_back(t < 0.4 ? t : t + 0.2);
  }
  return parameters;
}

std::vector<ContractProblem> DeficientProblems() {
  return {
      {"fewer points than control points, closed",
       [] { return MakeFit(MakeNoisyLoop(12, 2, 5), MakeSpec(3, true, 17)); }},
      {"fewer points than control points, clamped",
       [] { return MakeFit(MakeNoisyLoop(8, 3, 6), MakeSpec(2, false, 20)); }},
      {"spans without data, closed",
       [] { return AtParameters(WithAHole(60), MakeSpec(3, true, 30), 2); }},
      {"spans without data, clamped",
       [] { return AtParameters(WithAHole(60), MakeSpec(1, false, 24), 1); }},
      {"several points on one parameter",
       [] { return AtParameters(Repeated(9, 5, 0.5), MakeSpec(3, false, 13), 2); }},
      {"even degree and parameters at the knots",
       [] { return AtParameters(Repeated(10, 2, 0.0), MakeSpec(2, true, 10), 4); }},
  };
}

struct NearestCase {
  const char* solver;
  /// Distances count by the column sums of A'A: the diagonal step moves by their inverses.
  bool by_column_sums = false;
};

class NearestToTheStart : public ::testing::TestWithParam<NearestCase> {};

TEST_P(NearestToTheStart, AmongTheMinimisersOfADeficientFit) {
  const NearestCase& nearest = GetParam();
  const bool direct = MakeSolver(nearest.solver)->Info().native_rule == NativeRule::kDirect;
  for (const ContractProblem& row : DeficientProblems()) {
    SCOPED_TRACE(row.name);
    const auto problem = row.make();
    const DenseFit dense(*problem);
    ASSERT_LT(dense.rank, dense.a.cols());
    const SolverTrial trial(*problem, nearest.solver, {5000});
    // Fixed steps are slow where a control point is hardly touched by data.
    EXPECT_TRUE(IsSuccess(trial.outcome.reason) ||
                trial.outcome.reason == StopReason::kIterationLimit)
        << ToString(trial.outcome.reason);
    Eigen::VectorXd weights = Eigen::VectorXd::Ones(dense.a.cols());
    if (nearest.by_column_sums) {
      weights = (dense.a.transpose() * dense.a).cwiseAbs().colwise().sum();
      // A control point without data stays: any weight does.
      for (double& weight : weights) weight = weight > 0.0 ? weight : 1.0;
    }
    const Points expected = dense.NearestMinimiser(dense.PointsOf(problem->start()), weights);
    const double skew = std::sqrt(weights.maxCoeff() / weights.minCoeff());
    const double rounding = 256 * kEpsilon * dense.condition() * dense.condition();
    EXPECT_LT((dense.PointsOf(trial.x) - expected).norm(),
              skew * dense.DistanceFor(trial.context.gradient_norms().back()) + rounding)
        << trial.outcome.message;
    if (direct) {
      EXPECT_THAT(trial.outcome.message, HasSubstr("nearest to the start"));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Solvers, NearestToTheStart,
                         ::testing::Values(NearestCase{"banded_qr"}, NearestCase{"banded_cholesky"},
                                           NearestCase{"cg"}, NearestCase{"lspia/step=optimal"},
                                           NearestCase{"lspia", true}),
                         [](const auto& nearest) {
                           std::string name = nearest.param.solver;
                           std::replace_if(
                               name.begin(), name.end(),
                               [](char c) { return std::isalnum(c) == 0; }, '_');
                           return name;
                         });

TEST(SolutionNearestToTheStart, OfManyControlPointsIsTheOneThatConjugateGradientsFind) {
  // A point at every second knot: A A' is circulant
  // with 1/2 on its diagonal and 1/36 beside it, so that singular values of A are above 2/3.
  FitSpec spec = MakeSpec(3, true, 600);
  spec.parameters = Parameterization::kUniform;
  const auto problem = MakeFit(WithoutWeights(MakeNoisyLoop(300, 2, 7)), spec);
  const SolverTrial qr(*problem, "banded_qr");
  const SolverTrial cg(*problem, "cg");
  EXPECT_THAT(qr.outcome.message, HasSubstr("nearest to the start (minimum norm"));
  EXPECT_TRUE(IsSuccess(cg.outcome.reason));
  // g(P) = 2 A'A (P - P*) on the row space, where P - P* is.
  const double gradients = qr.context.gradient_norms().back() + cg.context.gradient_norms().back();
  const double rounding = 16 * kEpsilon * qr.x.norm();
  EXPECT_LT((qr.x - cg.x).norm(), 0.5 * gradients / (4.0 / 9.0) + rounding);
  const Eigen::VectorXd moved = qr.x - problem->start();
  EXPECT_GT(moved.norm(), 1e3 * (qr.x - cg.x).norm());
}

TEST(SolutionNearestToTheStart, IsFoundWhereNoPivotIsSmall) {
  // 99 distinct parameters for 100 control points; the null vector alternates and decays from the
  // one that lacks data, so that every diagonal entry of R stays above the tolerance.
  FitSpec spec = MakeSpec(3, true, 100);
  DataSet data = WithoutWeights(MakeNoisyLoop(100, 2, 9));
  data.parameters = Eigen::VectorXd(100);
  for (int i = 0; i < 100; ++i) (*data.parameters)[i] = (i == 11 ? 10 : i) / 100.0;
  spec.parameters.reset();
  spec.domain = {0.0, 1.0};
  const auto problem = MakeFit(data, spec);
  const SolverTrial cg(*problem, "cg", {5000});
  EXPECT_TRUE(IsSuccess(cg.outcome.reason));
  const DenseFit dense(*problem);
  ASSERT_EQ(dense.rank, 99);
  for (const char* solver : {"banded_qr", "banded_cholesky", "newton"}) {
    const SolverTrial direct(*problem, solver);
    EXPECT_THAT(direct.outcome.message, HasSubstr("minimum norm"));
    const double gradients =
        direct.context.gradient_norms().back() + cg.context.gradient_norms().back();
    EXPECT_LT((direct.x - cg.x).norm(),
              dense.DistanceFor(gradients) + 256 * kEpsilon * dense.condition() * dense.condition())
        << solver;
  }
}

TEST(SolutionNearestToTheStart, OfARealCoastWithUnevenPointsHasTheLeastEnergy) {
  // Spans with none, one and many of 3,697 points side by side, points next to knots: singular
  // values at every size down to the tolerance. The reference goes another way: cg, never above it.
  for (const Parameterization rule : {Parameterization::kUniform, Parameterization::kChordLength,
                                      Parameterization::kCentripetal}) {
    for (const int n : {3000, 5000}) {
      FitSpec spec = MakeSpec(3, true, n);
      spec.parameters = rule;
      const auto problem = MakeFileFit("coasts/great_britain_10m.csv", spec);
      const SolverTrial qr(*problem, "banded_qr");
      const SolverTrial cg(*problem, "cg", {3000});
      SCOPED_TRACE(n);
      TestContext context(*problem);
      Objective objective(problem.get(), nullptr);
      const double energy = context.Energy(qr.x);
      EXPECT_LE(energy, context.Energy(cg.x) + 1e-15 * context.Energy(problem->start()));
      // The audit's bound on what rounding leaves of |g|.
      EXPECT_LE(qr.context.gradient_norms().back(), 8 * objective.GradientRoundingFloor(qr.x));
    }
  }
}

TEST_P(EverySolver, EndsADeficientFitAtTheLeastEnergy) {
  for (const ContractProblem& row : DeficientProblems()) {
    const auto problem = row.make();
    if (!WhyUnsupported(*problem, name()).empty()) continue;
    SCOPED_TRACE(row.name);
    const DenseFit dense(*problem);
    const SolverTrial trial(*problem, name(), {5000});
    ASSERT_TRUE(trial.x.allFinite());
    EXPECT_NE(trial.outcome.reason, StopReason::kNumericalFailure) << trial.outcome.message;
    if (HasItsOwnLimit(trial)) continue;
    // E falls to the least one as far as differences of E can be seen; slow ones at half the pace
    // of a step of 1 / (the largest row sum of N) at least.
    const double energy = (dense.a * dense.solution - dense.q).squaredNorm();
    const double start_gap = dense.Gap(problem->start());
    double slowest = 0.0;
    if (trial.outcome.reason == StopReason::kIterationLimit) {
      const double largest = (dense.a.transpose() * dense.a).cwiseAbs().rowwise().sum().maxCoeff();
      slowest = std::pow(1.0 - dense.smallest * dense.smallest / largest, trial.iterations());
    }
    EXPECT_LT(dense.Gap(trial.x), 1e3 * kEpsilon * (energy + start_gap) + slowest * start_gap)
        << ToString(trial.outcome.reason);
  }
}

}  // namespace
}  // namespace batten
