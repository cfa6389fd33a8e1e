#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/roundoff.h"
#include "tests/solvers/contract_cases.h"

namespace batten {
namespace {

const char* const kFreeSolvers[] = {
    "foot_newton", "newton",       "lm_schur",     "varpro", "tdm",         "sdm",     "pdm",
    "gi",          "anderson:pdm", "anderson:tdm", "lbfgs",  "ceres_lbfgs", "ceres_lm"};

std::vector<double> EnergiesOf(SolverTrial* trial) {
  std::vector<double> energies;
  for (const Eigen::VectorXd& x : trial->context.iterates()) {
    energies.push_back(trial->context.Energy(x));
  }
  return energies;
}

std::unique_ptr<Problem> Outline(const std::string& name, int control_points) {
  return MakeFileFit("animals/" + name + ".csv", MakeFreeSpec(3, true, control_points));
}

TEST(Tdm, DivergesWithoutDampingWhereItConvergesWithIt) {
  // Qin & Zhang, 2020, say so of examples like this one.
  const auto problem = Outline("rhino_100", 8);
  SolverTrial undamped(*problem, "tdm/damping=0/search=none", {50});
  const std::vector<double> energies = EnergiesOf(&undamped);
  EXPECT_GT(*std::max_element(energies.begin(), energies.end()), 100.0 * energies.front());
  EXPECT_GT(energies.back(), energies.front());
  SolverTrial damped(*problem, "tdm", {2000});
  EXPECT_EQ(damped.outcome.reason, StopReason::kGradientSmall);
  EXPECT_LT(damped.context.Energy(damped.x), 0.2 * energies.front());
}

void ExpectNeverRises(const Problem& problem, const char* solver, int iterations) {
  SolverTrial trial(problem, solver, {iterations});
  const std::vector<double> energies = EnergiesOf(&trial);
  Objective objective(&problem, nullptr);
  // The method knows what its energies are differences of through |Q|, and no better than twice.
  const double size = 4.0 * objective.ResidualSize(objective.start());
  for (std::size_t k = 1; k < energies.size(); ++k) {
    ASSERT_LE(energies[k], energies[k - 1] + Objective::EnergyRoundingFloor(energies[k - 1], size))
        << solver << " " << k;
  }
  EXPECT_LT(energies.back(), energies.front());
}

TEST(FootIteration, NeverRaisesTheEnergyWhereItHalvesItsSteps) {
  for (const char* solver : {"tdm", "sdm", "tdm/damping=0", "sdm/damping=0"}) {
    // A circle far from the outline, corners, and a curve of one control point, which is a point:
    // its tangents are rounding.
    ExpectNeverRises(*Outline("rhino_100", 8), solver, 100);
    ExpectNeverRises(*MakeFit(MakeNoisyBean(28, 2, 620), MakeFreeSpec(1, true, 7)), solver, 100);
    ExpectNeverRises(*MakeFit(MakeNoisyLoop(29, 3, 621), MakeFreeSpec(4, true, 1, "data")), solver,
                     100);
  }
}

TEST(FootIteration, GoesOnWhileTheEnergyFallsThoughItsMovesGrow) {
  // Points slide along the curve: the least move of the first 1300 iterations is among the first
  // 300, and E falls in each.
  const auto problem = Outline("dolphin_80", 12);
  const SolverTrial trial(*problem, "tdm", {1300});
  EXPECT_EQ(trial.outcome.reason, StopReason::kIterationLimit);
}

TEST(FootNewton, EndsNoHigherThanNewtonFromACircle) {
  for (const char* name : {"rhino_100", "squirrel_120", "dolphin_80"}) {
    const auto problem = Outline(name, 12);
    SolverTrial feet(*problem, "foot_newton");
    SolverTrial newton(*problem, "newton");
    EXPECT_TRUE(IsSuccess(feet.outcome.reason)) << name;
    const double energy = newton.context.Energy(newton.x);
    EXPECT_LE(feet.context.Energy(feet.x), energy * (1.0 + 1e3 * kEpsilon)) << name;
  }
}

TEST(Anderson, NeverRaisesTheEnergyAtTheFeetOverPdm) {
  for (const char* name : {"rhino_100", "dolphin_80"}) {
    const auto problem = Outline(name, 12);
    // pdm's own step, which is taken where none is accelerated, may miss its minimum by rounding.
    ExpectNeverRises(*problem, "anderson:pdm", 300);
    SolverTrial trial(*problem, "anderson:pdm", {300});
    EXPECT_LT(trial.context.Energy(trial.x), 0.2 * trial.context.Energy(problem->start())) << name;
    // `batten reproduce anderson` reads the share of rejected steps out of it.
    EXPECT_THAT(trial.context.notes().at("rejected steps"),
                ::testing::MatchesRegex("[0-9]+ of [0-9]+, E would have risen"));
  }
}

TEST(Anderson, DoesNotTakeRoundingForABaseThatRaisesTheEnergy) {
  for (const char* name : {"rhino_100", "cat_110", "squirrel_120", "dolphin_80"}) {
    for (const char* solver : {"anderson:pdm", "anderson:tdm"}) {
      const SolverTrial trial(*Outline(name, 12), solver, {2000});
      EXPECT_EQ(trial.context.notes().count("may not converge"), 0U) << name << " " << solver;
    }
  }
}

/// Where it is said that no step lowers E, steps of many lengths along -g must not.
void ExpectNoStepDown(const Problem& problem, SolverTrial* trial, double noise) {
  Objective objective(&problem, nullptr);
  Eigen::VectorXd gradient;
  double energy = 0.0;
  ASSERT_EQ(objective.EnergyAndGradient(trial->x, &energy, &gradient), Status::kOk);
  for (double length = 1.0; length > 1e-9; length *= 0.1) {
    const Eigen::VectorXd x = trial->x - length * gradient.stableNormalized();
    EXPECT_GE(trial->context.Energy(x), energy - 8.0 * noise)
        << length << ", |g| " << gradient.norm();
  }
}

/// A right answer or an honest end: E is finite and not above the start's.
void ExpectEndsHonestly(const Problem& problem) {
  for (const char* solver : kFreeSolvers) {
    SCOPED_TRACE(solver);
    ASSERT_EQ(WhyUnsupported(problem, solver), "");
    SolverTrial trial(problem, solver, {200});
    ASSERT_TRUE(trial.x.allFinite());
    const Objective objective(&problem, nullptr);
    const double start = trial.context.Energy(objective.start());
    const double end = trial.context.Energy(trial.x);
    ASSERT_TRUE(std::isfinite(start));
    // Points inside are of size 1: a start that is best already may move by its rounding.
    const double size = objective.ResidualSize(objective.start());
    const double noise =
        Objective::EnergyRoundingFloor(start, size) + std::pow(16 * kEpsilon * size, 2);
    EXPECT_LE(end, start + noise) << ToString(trial.outcome.reason);
    EXPECT_NE(trial.outcome.reason, StopReason::kNotRun);
    EXPECT_NE(trial.outcome.reason, StopReason::kDiverged);
    const bool is_ours = solver != std::string("ceres_lbfgs") && solver != std::string("ceres_lm");
    if (trial.outcome.reason == StopReason::kLineSearchEnded && is_ours) {
      ExpectNoStepDown(problem, &trial, noise);
    }
    if (trial.outcome.reason == StopReason::kNumericalFailure) {
      EXPECT_FALSE(trial.outcome.message.empty());
    }
  }
}

DataSet DataOf(const Points& points) {
  DataSet data;
  data.points = points;
  return data;
}

TEST(FreeFitsOfBadData, EndHonestlyWithPointsOnALine) {
  Points points(30, 2);
  for (int i = 0; i < 30; ++i) points.row(i) << 0.3 * i, 0.1 * i - 1.0;
  for (const char* start : {"circle", "ellipse", "data"}) {
    SCOPED_TRACE(start);
    ExpectEndsHonestly(*MakeFit(DataOf(points), MakeFreeSpec(3, true, 8, start)));
    ExpectEndsHonestly(*MakeFit(DataOf(points), MakeFreeSpec(3, false, 8, start)));
  }
}

TEST(FreeFitsOfBadData, EndHonestlyWhereTheCurveTurnsBackOnItself) {
  // Of points on a line that are in no order: C' vanishes where the curve turns.
  Points points(50, 2), numbers(50, 1);
  for (int i = 0; i < 50; ++i) {
    const int place = 17 * i % 50;
    points.row(i) << place, 2.0 * place;
    numbers(i, 0) = std::cos(0.7 * i);
  }
  for (const bool closed : {true, false}) {
    for (const char* start : {"ellipse", "data"}) {
      SCOPED_TRACE(std::string(start) + (closed ? " closed" : " open"));
      ExpectEndsHonestly(*MakeFit(DataOf(points), MakeFreeSpec(3, closed, 8, start)));
    }
    ExpectEndsHonestly(*MakeFit(DataOf(numbers), MakeFreeSpec(3, closed, 8, "data")));
  }
}

TEST(FreeFitsOfBadData, EndHonestlyWithRepeatedPoints) {
  DataSet data = MakeNoisyBean(12, 2, 601);
  data.weights.reset();
  const Points once = data.points;
  data.points.resize(48, 2);
  for (int i = 0; i < 48; ++i) data.points.row(i) = once.row(i / 4);
  ExpectEndsHonestly(*MakeFit(data, MakeFreeSpec(3, true, 9)));
  ExpectEndsHonestly(*MakeFit(data, MakeFreeSpec(3, false, 9, "data")));
  // All at one place.
  FitSpec spec = MakeFreeSpec(3, true, 6);
  spec.parameters = Parameterization::kUniform;
  ExpectEndsHonestly(*MakeFit(DataOf(Points::Constant(20, 2, 3.5)), spec));
}

TEST(FreeFitsOfBadData, EndHonestlyFarFromTheStart) {
  DataSet data = MakeNoisyBean(40, 2, 602);
  data.weights.reset();
  FitSpec spec = MakeFreeSpec(3, true, 9);
  const auto plain = MakeFit(data, spec);
  for (const double away : {1e2, 1e6}) {
    SCOPED_TRACE(away);
    spec.start_points = plain->curve_fit()->ControlPoints(plain->start());
    spec.start_points.col(0).array() += away;
    ExpectEndsHonestly(*MakeFit(data, spec));
  }
}

TEST(FreeFitsOfBadData, EndHonestlyFromACurveThatIsOnePoint) {
  ExpectEndsHonestly(*MakeFit(MakeNoisyBean(40, 2, 603), MakeFreeSpec(3, true, 9, "centroid")));
  ExpectEndsHonestly(*MakeFit(MakeNoisyBean(40, 3, 604), MakeFreeSpec(3, false, 9, "centroid")));
  FitSpec spec = MakeFreeSpec(3, true, 9);
  spec.start_points = Points::Constant(9, 2, 0.25);
  ExpectEndsHonestly(*MakeFit(MakeNoisyBean(40, 2, 605), spec));
}

TEST(FreeFitsOfBadData, EndHonestlyFromACurveWithACusp) {
  // Three control points in one place: C' = 0 at a knot of a cubic, where the curve turns back.
  DataSet data = MakeNoisyBean(40, 2, 613);
  data.weights.reset();
  FitSpec spec = MakeFreeSpec(3, true, 9);
  const auto plain = MakeFit(data, spec);
  spec.start_points = plain->curve_fit()->ControlPoints(plain->start());
  spec.start_points.row(4) = spec.start_points.row(3);
  spec.start_points.row(5) = spec.start_points.row(3);
  ExpectEndsHonestly(*MakeFit(data, spec));
}

TEST(FreeFitsOfBadData, RefuseAStartThatIsNoNumber) {
  FitSpec spec = MakeFreeSpec(3, true, 9);
  for (const double bad : {std::nan(""), HUGE_VAL}) {
    spec.start_points = Points::Constant(9, 2, 0.25);
    spec.start_points(4, 1) = bad;
    std::string error;
    EXPECT_EQ(MakeFitProblem(MakeNoisyBean(40, 2, 614), spec, &error), nullptr);
    EXPECT_THAT(error, ::testing::HasSubstr("allowed: 9 finite ones of dimension 2"));
  }
}

TEST(FreeFitsOfBadData, EndHonestlyWithFewerPointsThanControlPoints) {
  ExpectEndsHonestly(*MakeFit(MakeNoisyBean(7, 2, 606), MakeFreeSpec(3, true, 12)));
  ExpectEndsHonestly(*MakeFit(MakeNoisyBean(7, 3, 607), MakeFreeSpec(3, false, 12, "data")));
}

TEST(FreeFitsOfBadData, EndHonestlyWithTwoPoints) {
  ExpectEndsHonestly(*MakeFit(MakeNoisyBean(2, 2, 608), MakeFreeSpec(3, false, 4, "data")));
  ExpectEndsHonestly(*MakeFit(MakeNoisyBean(2, 2, 609), MakeFreeSpec(3, true, 4, "circle")));
  FitSpec spec = MakeFreeSpec(3, false, 4, "data");
  spec.hold_ends = true;
  ExpectEndsHonestly(*MakeFit(MakeNoisyBean(2, 2, 610), spec));
}

TEST(FreeFitsOfBadData, EndHonestlyOnLinesAndOnOneCoordinate) {
  // Degree 1 has corners, one coordinate no normals.
  ExpectEndsHonestly(*MakeFit(MakeNoisyBean(40, 2, 611), MakeFreeSpec(1, true, 9)));
  ExpectEndsHonestly(*MakeFit(MakeNoisyBean(40, 1, 612), MakeFreeSpec(3, false, 9, "data")));
}

}  // namespace
}  // namespace batten
