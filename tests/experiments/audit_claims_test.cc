// Small fits with moving parameters of every awkward kind, at random: whatever a method claims at
// the end, the audit finds.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "experiments/fit_report.h"
#include "tests/experiments/outlines.h"
#include "tests/solvers/test_fits.h"

namespace batten {
namespace {

/// Noise, points on a line, on a lattice, on a circle, or three times the same.
DataSet RandomData(std::mt19937* random) {
  constexpr int kSizes[] = {2, 3, 4, 5, 7, 12, 30};
  constexpr double kOrigins[] = {0.0, 0.0, 1e3, 1e7};
  const auto pick = [random](int count) { return static_cast<int>((*random)() % count); };
  std::normal_distribution<double> noise;
  const int m = kSizes[pick(7)], d = 1 + pick(4), kind = pick(5);
  const double origin = kOrigins[pick(4)];
  DataSet data;
  data.name = "random";
  data.points.resize(m, d);
  for (int i = 0; i < m; ++i) {
    for (int c = 0; c < d; ++c) {
      const double place = kind == 0   ? noise(*random)
                           : kind == 1 ? (c + 1) * i / 3.0
                           : kind == 2 ? pick(3)
                           : kind == 3 ? std::cos(2.0 * M_PI * i / m + 0.5 * M_PI * c)
                                       : i / 3 * (c + 1) % 5;
      data.points(i, c) = origin + place;
    }
  }
  return data;
}

FitSpec RandomSpec(int dimension, std::mt19937* random) {
  constexpr int kDegrees[] = {1, 2, 3, 3, 5};
  const auto pick = [random](int count) { return static_cast<int>((*random)() % count); };
  const int degree = kDegrees[pick(5)];
  const bool closed = pick(3) == 0;
  const int control_points = closed ? 1 + pick(8) : degree + 1 + pick(4);
  const bool projected = pick(3) == 0;
  const char* const starts[] = {"data", "circle", "ellipse", "centroid"};
  // All points are as near to a point, of which projected parameters make nothing.
  const std::string start = dimension > 1 ? starts[pick(projected ? 3 : 4)] : "data";
  FitSpec spec = projected ? MakeProjectedSpec(degree, closed, control_points, start)
                           : MakeFreeSpec(degree, closed, control_points, start);
  spec.hold_ends = !projected && !closed && pick(3) == 0;
  return spec;
}

class AuditOfClaims : public ::testing::TestWithParam<const char*> {};

TEST_P(AuditOfClaims, HoldsOnSmallFitsOfEveryKind) {
  std::mt19937 random(20261201);
  int num_runs = 0, num_successes = 0;
  for (int k = 0; k < 150; ++k) {
    const DataSet data = RandomData(&random);
    const FitSpec spec = RandomSpec(static_cast<int>(data.points.cols()), &random);
    std::string error;
    const auto problem = MakeFitProblem(data, spec, &error);
    if (problem == nullptr) continue;  // refused, with a sentence
    RunSpec limits;
    limits.max_iterations = 300;
    const RunResult run = RunSolver(*problem, GetParam(), limits);
    if (!run.skipped.empty()) continue;
    ++num_runs;
    num_successes += IsSuccess(run.outcome.reason) ? 1 : 0;
    const FitReport report = MeasureFit(*problem, run, limits);
    EXPECT_TRUE(!report.audited || report.verdict.holds) << k << ": " << report.verdict.failure;
  }
  EXPECT_GT(num_runs, 40);
  EXPECT_GT(num_successes, 10);
}

INSTANTIATE_TEST_SUITE_P(Solvers, AuditOfClaims,
                         ::testing::Values("lbfgs", "ceres_lbfgs", "ceres_lm", "newton", "lm_schur",
                                           "varpro", "foot_newton", "pdm", "tdm", "sdm", "gi"));

}  // namespace
}  // namespace batten
