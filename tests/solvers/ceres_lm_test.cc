#include "solvers/ceres_lm.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "problems/test_functions.h"
#include "solvers/banded_qr.h"
#include "tests/roundoff.h"
#include "tests/solvers/test_fits.h"
#include "tests/solvers/trial.h"

namespace batten {
namespace {

using LmTrial = Trial<CeresLmSolver>;

/// With e the difference of two points and g that of their gradients, ||J e||^2 = e'g / 2; a
/// gradient at the direct answer is noise.
void ExpectNear(const Problem& problem, const Eigen::VectorXd& direct, LmTrial* trial,
                const std::string& name) {
  Objective objective(&problem, nullptr);
  Eigen::VectorXd residuals;
  SparseRows jacobian;
  ASSERT_EQ(objective.Jacobian(direct, &residuals, &jacobian), Status::kOk);
  const Eigen::VectorXd error = trial->x - direct;
  const double gradient_norm =
      trial->context.GradientNorm(trial->x) + objective.GradientRoundingFloor(direct);
  EXPECT_LE((jacobian * error).squaredNorm(), error.norm() * gradient_norm) << name;
}

void ExpectDirectAnswer(const Problem& problem, LmTrial* trial, const std::string& name) {
  ExpectNear(problem, Trial<BandedQrSolver>(problem, "banded_qr").x, trial, name);
}

/// x - J^+ r by Eigen's dense QR, in the free variables.
Eigen::VectorXd DenseAnswer(const Problem& problem) {
  Objective objective(&problem, nullptr);
  Eigen::VectorXd residuals;
  SparseRows jacobian;
  CHECK(objective.Jacobian(objective.start(), &residuals, &jacobian) == Status::kOk);
  return objective.start() - Eigen::MatrixXd(jacobian).colPivHouseholderQr().solve(residuals);
}

TEST(CeresLm, ReachesTheRaceToleranceOnEveryOutline) {
  for (const char* name : {"cat_110", "dolphin_80", "rhino_100", "squirrel_120", "cat_2000",
                           "dolphin_2000", "rhino_2000", "squirrel_2000"}) {
    for (const int control_points : {20, 60, 100}) {
      for (const char* start : {"data", "centroid"}) {
        FitSpec spec = MakeSpec(3, true, control_points);
        spec.start = start;
        const auto problem = MakeFileFit(std::string("animals/") + name + ".csv", spec);
        LmTrial trial(*problem, "ceres_lm");
        EXPECT_EQ(trial.outcome.reason, StopReason::kGradientSmall) << name << control_points;
        EXPECT_LE(trial.gradient_ratio(), 1e-10) << name << control_points;
        // Some rows of dolphin_80 with 100 control points are undetermined.
        if (control_points < 80) ExpectDirectAnswer(*problem, &trial, name);
      }
    }
  }
}

// With the first radius of Ceres' own these ended at 1e-9 to 1e-8: the last step that could still
// change E measurably had been damped.
TEST(CeresLm, ReachesTheRaceToleranceWithManyControlPoints) {
  for (const char* name : {"cat_2000", "dolphin_2000", "rhino_2000"}) {
    for (const bool closed : {true, false}) {
      FitSpec spec = MakeSpec(3, closed, 1000);
      spec.parameters = Parameterization::kUniform;
      const auto problem = MakeFileFit(std::string("animals/") + name + ".csv", spec);
      const LmTrial trial(*problem, "ceres_lm");
      EXPECT_EQ(trial.outcome.reason, StopReason::kGradientSmall) << name << closed;
    }
  }
}

TEST(CeresLm, EveryLinearSolverAndStrategyFindsTheDirectAnswer) {
  const auto problem = Rhino();
  for (const char* options :
       {"linear_solver=sparse_normal_cholesky", "linear_solver=dense_normal_cholesky",
        "linear_solver=dense_qr", "linear_solver=cgnr", "strategy=dogleg",
        "strategy=dogleg/linear_solver=dense_qr", "radius=1e4", "radius=1"}) {
    LmTrial trial(*problem, std::string("ceres_lm/") + options);
    EXPECT_EQ(trial.outcome.reason, StopReason::kGradientSmall) << options;
    ExpectDirectAnswer(*problem, &trial, options);
  }
}

TEST(CeresLm, NotesTheLinearSolverItChose) {
  const auto problem = Rhino();
  const LmTrial trial(*problem, "ceres_lm");
  EXPECT_EQ(trial.context.notes().at("linear solver"), "sparse_normal_cholesky");
}

TEST(CeresLm, TwoThreadsFindTheDirectAnswerToo) {
  const auto problem = MakeFileFit("animals/cat_2000.csv", MakeSpec(3, true, 60));
  TestContextOptions options;
  options.threads = 2;
  LmTrial trial(*problem, "ceres_lm", options);
  EXPECT_EQ(trial.outcome.reason, StopReason::kGradientSmall);
  ExpectDirectAnswer(*problem, &trial, "two threads");
}

TEST(CeresLm, MinimisesEveryTestFunction) {
  TestContextOptions patient;
  patient.max_iterations = 20000;  // brown_dennis: its residuals are large, and J'J far from E''
  for (const TestFunction& function : TestFunctions()) {
    const auto problem = MakeTestProblem(function.name);
    LmTrial trial(*problem, "ceres_lm", patient);
    double nearest = std::numeric_limits<double>::infinity();
    for (const TestFunction::Minimum& minimum : function.minima) {
      nearest = std::min(nearest, std::abs(trial.context.Energy(trial.x) - minimum.energy) /
                                      std::max(1.0, minimum.energy));
    }
    // Published energies have six digits.
    EXPECT_LE(nearest, 1e-5) << function.name << ": " << ToString(trial.outcome.reason);
  }
}

TEST(CeresLm, MinimisesRobustTerms) {
  for (const char* loss : {"huber", "cauchy", "soft_l1", "tukey"}) {
    const auto problem =
        MakeFit(MakeNoisyLoop(90, 2, 21),
                MakeSpec(3, true, 15, "interpolation/loss_scale=0.05/loss=" + std::string(loss)));
    LmTrial trial(*problem, "ceres_lm");
    // Losses that are not convex start at Huber's answer, where the gradient is ten times smaller.
    const double ratio =
        std::string(loss) == "cauchy" || std::string(loss) == "tukey" ? 1e-6 : 1e-7;
    EXPECT_LE(trial.gradient_ratio(), ratio) << loss << ": " << trial.outcome.message;
  }
}

TEST(CeresLm, HoldsTheCurveAtAPoint) {
  auto problem = Rhino();
  const LinearConstraint held_x = HoldCurve(*problem, 0.3, 0, 0.25);
  const LinearConstraint held_y = HoldCurve(*problem, 0.3, 1, -0.125);
  SetConstraints({held_x, held_y}, problem.get());
  for (const char* name : {"ceres_lm", "ceres_lm/linear_solver=dense_qr"}) {
    LmTrial trial(*problem, name);
    EXPECT_EQ(trial.outcome.reason, StopReason::kGradientSmall) << name;
    ExpectDirectAnswer(*problem, &trial, name);
    const Eigen::VectorXd all = problem->elimination().Expand(trial.x);
    for (const LinearConstraint& held : {held_x, held_y}) {
      double value = -held.value;
      for (const auto& [variable, coefficient] : held.coefficients) {
        value += coefficient * all[variable];
      }
      // One rounding each of four products, three sums and of the elimination's quotient.
      EXPECT_NEAR(value, 0.0, 8.0 * kEpsilon) << name;
    }
  }
}

TEST(CeresLm, MeetsConstraintsThatTieAllPointsOrTreatCoordinatesDifferently) {
  auto problem = MakeFit(MakeNoisyLoop(60, 3, 22), MakeSpec(3, true, 12));
  LinearConstraint mean;
  mean.name = "mean of the third coordinate";
  mean.value = 0.1;
  for (int j = 0; j < 12; ++j) mean.coefficients.emplace_back(3 * j + 2, 1.0 / 12.0);
  SetConstraints({mean, HoldCurve(*problem, 0.7, 0, 0.0)}, problem.get());
  LmTrial trial(*problem, "ceres_lm");
  EXPECT_EQ(trial.outcome.reason, StopReason::kGradientSmall);
  ASSERT_EQ(trial.x.size(), 34);
  ExpectNear(*problem, DenseAnswer(*problem), &trial, "dense");
  const Eigen::VectorXd all = problem->elimination().Expand(trial.x);
  double sum = 0.0;
  for (int j = 0; j < 12; ++j) sum += all[3 * j + 2] / 12.0;
  EXPECT_NEAR(sum, 0.1, 32.0 * kEpsilon);  // 12 products and 11 sums of terms below 1
}

TEST(CeresLm, BoundedCoordinatesAreCutOff) {
  // Straight pieces with a corner at each data point: A is the identity, and the bounded minimiser
  // is Q with its coordinates cut off.
  DataSet data = MakeNoisyLoop(25, 2, 23);
  data.parameters = Eigen::VectorXd::LinSpaced(25, 0.0, 1.0);
  FitSpec spec = MakeSpec(1, false, 25);
  spec.parameters.reset();
  const auto free = MakeFit(data, spec);
  const auto bounded = MakeFit(data, spec);
  const Eigen::VectorXd all_ones = Eigen::VectorXd::Ones(free->num_variables());
  bounded->SetBounds(-0.25 * all_ones, 0.125 * all_ones);
  LmTrial unbounded(*free, "ceres_lm");
  LmTrial trial(*bounded, "ceres_lm");
  const Eigen::VectorXd expected = unbounded.x.cwiseMax(-0.25).cwiseMin(0.125);
  EXPECT_GT((expected - unbounded.x).norm(), 0.1);
  // Along each coordinate E is w (x - q)^2 with w >= 0.1: Ceres ends where a step changes it by
  // less than its rounding.
  EXPECT_LE((trial.x - expected).norm(),
            std::sqrt(kEpsilon * trial.context.Energy(expected) / 0.1));
  EXPECT_TRUE((trial.x.array() >= -0.25).all() && (trial.x.array() <= 0.125).all());
}

TEST(CeresLm, AControlPointWithoutDataStaysWhereItStarted) {
  DataSet data = MakeNoisyLoop(40, 2, 24);
  data.parameters = Eigen::VectorXd::LinSpaced(40, 0.0, 0.5);
  FitSpec spec = MakeSpec(3, false, 24);
  spec.parameters.reset();
  spec.domain = {0.0, 1.0};
  const auto problem = MakeFit(data, spec);
  LmTrial trial(*problem, "ceres_lm");
  EXPECT_EQ(trial.outcome.reason, StopReason::kGradientSmall);
  EXPECT_EQ(trial.x.tail(2), problem->start().tail(2));
  EXPECT_NE(trial.x.head(2), problem->start().head(2));
}

}  // namespace
}  // namespace batten
