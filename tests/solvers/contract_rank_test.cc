#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/solvers/contract_cases.h"

namespace batten {
namespace {

using ::testing::HasSubstr;

constexpr double kEps = std::numeric_limits<double>::epsilon();

/// Points of a loop at given parameters.
std::unique_ptr<Problem> AtParameters(const std::vector<double>& parameters, FitSpec spec,
                                      int dimension) {
  DataSet data =
      MakeNoisyLoop(static_cast<int>(parameters.size()), dimension, 31);
  data.parameters = Eigen::Map<const Eigen::VectorXd>(parameters.data(),
                                                      static_cast<Eigen::Index>(parameters.size()));
  spec.parameters.reset();
  spec.domain = {0.0, 1.0};
  return MakeFit(std::move(data), spec);
}

/// num_groups parameters inside (0, 1), each `times` times.
std::vector<double> Repeated(int num_groups, int times) {
  std::vector<double> parameters;
  for (int i = 0; i < num_groups * times; ++i) {
    parameters.push_back((i / times + 0.5) / num_groups);
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
       [] { return AtParameters(Repeated(9, 5), MakeSpec(3, false, 13), 2); }},
      {"even degree, knots half way between the parameters",
       [] { return AtParameters(Repeated(10, 2), MakeSpec(2, true, 10), 4); }},
  };
}

class NearestToTheStart : public ::testing::TestWithParam<const char*> {};

TEST_P(NearestToTheStart, AmongTheMinimisersOfADeficientFit) {
  const std::string solver = GetParam();
  const bool direct = SolverRegistry::Global().Find(solver)->native_rule == NativeRule::kDirect;
  for (const ContractProblem& row : DeficientProblems()) {
    SCOPED_TRACE(row.name);
    const auto problem = row.make();
    const DenseFit dense(*problem);
    ASSERT_LT(dense.rank, dense.a.cols());
    const SolverTrial trial(*problem, solver, {5000});
    EXPECT_TRUE(IsSuccess(trial.outcome.reason)) << ToString(trial.outcome.reason);
    const double rounding = 256 * kEps * dense.condition() * dense.condition();
    EXPECT_LT((trial.x - dense.solution_x()).norm(),
              dense.DistanceFor(trial.context.gradient_norms().back()) + rounding)
        << trial.outcome.message;
    if (direct) {
      EXPECT_THAT(trial.outcome.message, HasSubstr("nearest to the start"));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Solvers, NearestToTheStart,
                         ::testing::Values("banded_qr", "banded_cholesky", "cg", "lspia",
                                           "lspia/step=optimal"),
                         [](const auto& solver) {
                           std::string name = solver.param;
                           std::replace_if(
                               name.begin(), name.end(),
                               [](char c) { return std::isalnum(c) == 0; }, '_');
                           return name;
                         });

TEST(SolutionNearestToTheStart, OfManyControlPointsIsFoundByIteration) {
  // Above 500 columns the direct solvers iterate.
  const auto problem = MakeFit(MakeNoisyLoop(300, 2, 7), MakeSpec(3, true, 600));
  const SolverTrial qr(*problem, "banded_qr");
  const SolverTrial cg(*problem, "cg", {5000});
  EXPECT_THAT(qr.outcome.message, HasSubstr("nearest to the start (LSQR"));
  EXPECT_TRUE(IsSuccess(cg.outcome.reason));
  // Two iterations that stop at 1e-10 of their gradients, on rows whose singular values lie above
  // 0.1: found in a run.
  EXPECT_LT((qr.x - cg.x).norm(), 1e-7 * (qr.x - problem->start()).norm());
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
    // E falls to the least one as far as differences of E can be seen.
    const double energy = (dense.a * dense.solution - dense.q).squaredNorm();
    EXPECT_LT(dense.Gap(trial.x), 1e3 * kEps * (energy + dense.Gap(problem->start())))
        << ToString(trial.outcome.reason);
  }
}

}  // namespace
}  // namespace batten
