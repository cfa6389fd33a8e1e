// ceres_lm where parameters are free and its blocks must be bound anew as they change spans.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "solvers/ceres_lbfgs.h"
#include "solvers/ceres_lm.h"
#include "solvers/ceres_problem.h"
#include "splines/bspline_curve.h"
#include "tests/roundoff.h"
#include "tests/solvers/test_fits.h"
#include "tests/solvers/trial.h"

namespace batten {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

using LmTrial = Trial<CeresLmSolver>;

FitSpec FreeSpec(bool closed, int control_points) {
  FitSpec spec = MakeSpec(3, closed, control_points, "free_parameter");
  spec.parameter_kind = ParameterKind::kFree;
  return spec;
}

FitSpec CircleSpec(int control_points) {
  FitSpec spec = FreeSpec(true, control_points);
  spec.parameters = Parameterization::kUniform;
  spec.start = "circle";
  return spec;
}

int Rebindings(const LmTrial& trial) { return std::stoi(trial.context.notes().at("re-bindings")); }

/// |g| at the free variables x without the parameters that are pressed against an end of an open
/// curve: zero at a minimum within the domain.
double InnerGradientNorm(const Problem& problem, const Eigen::VectorXd& x) {
  Objective objective(&problem, nullptr);
  double energy = 0.0;
  Eigen::VectorXd gradient;
  CHECK(objective.EnergyAndGradient(x, &energy, &gradient) == Status::kOk);
  const Eigen::VectorXd all = objective.Expand(x);
  Eigen::VectorXd full = problem.elimination().ExpandDirection(gradient);
  const BsplineBasis& basis = problem.curve_fit()->basis();
  for (int v = problem.curve_fit()->setting().parameter_offset; v < all.size(); ++v) {
    const bool at_begin = all[v] <= basis.domain_begin() && full[v] > 0.0;
    const bool at_end = all[v] >= basis.domain_end() && full[v] < 0.0;
    if (!basis.periodic() && (at_begin || at_end)) full[v] = 0.0;
  }
  return full.norm();
}

/// Ceres ends where a step leaves E equal to the last bit, so that a step along -g, which lowers it
/// by |g|^2 / (2 q), q the curvature there, does so by few roundings of E; 100 of them for sums of
/// 200 squares. q is at most the sum of the largest eigenvalues of 2 J'J in the control points, 2
/// m, as basis functions sum to 1, and in the parameters, 2 |C'|^2: less than that again, with m
/// near 100, for an outline in a box of side 1 whose domain is as long.
double SmallGradient(const Problem& problem, LmTrial* trial) {
  const auto m = static_cast<double>(problem.curve_fit()->data().points.rows());
  const double curvature = 4.0 * m;
  return std::sqrt(2.0 * curvature * 100.0 * kEpsilon * trial->context.Energy(trial->x));
}

TEST(CeresLmFree, EndsAtAStationaryPointThoughSpansChange) {
  for (const int control_points : {8, 20, 30}) {
    const auto problem = MakeFileFit("animals/rhino_100.csv", CircleSpec(control_points));
    LmTrial trial(*problem, "ceres_lm");
    const double small = SmallGradient(*problem, &trial);
    EXPECT_LE(small, 1e-6 * trial.context.gradient_norms().front()) << control_points;
    EXPECT_LE(trial.context.GradientNorm(trial.x), small) << control_points;
    EXPECT_EQ(trial.outcome.reason, StopReason::kNativeStop) << trial.outcome.message;
    if (control_points > 8) {
      EXPECT_GE(Rebindings(trial), 1) << control_points;
    }
  }
}

/// Points on a curve that the spline space has, from the curve itself and all parameters but one,
/// which starts spans away from its foot. E is zero once that has found it.
struct Stray {
  Stray(FitSpec spec, const Points& control_points, int point, double astray_t) : index(point) {
    const bool closed = spec.closed;
    std::string error;
    const auto basis = BsplineBasis::Make(spec.degree, closed, spec.given_knots, &error);
    CHECK(basis.has_value()) << error;
    constexpr int kPoints = 61;
    DataSet data;
    data.name = "stray";
    data.parameters = Eigen::VectorXd::LinSpaced(kPoints, basis->domain_begin(),
                                                 basis->domain_end() - (closed ? 0.02 : 0.0));
    data.points = BsplineCurve(*basis, control_points).Sample(*data.parameters);
    spec.parameters.reset();
    problem = MakeFit(data, spec);
    const CurveFit& fit = *problem->curve_fit();
    Eigen::VectorXd t = fit.parameters();
    foot = t[index];
    t[index] = astray_t;
    start = problem->elimination().FreeVariables(fit.Variables(control_points, t));
  }
  /// The stray's parameter at free variables x, in the domain.
  double At(const Eigen::VectorXd& x) const {
    return problem->curve_fit()->Parameters(problem->elimination().Expand(x))[index];
  }

  std::unique_ptr<Problem> problem;
  Eigen::VectorXd start;
  double foot = 0.0;
  int index;
};

Stray StrayOnAnArc(bool hold_ends = false) {
  constexpr int kControlPoints = 12;
  FitSpec spec = FreeSpec(false, kControlPoints);
  spec.given_knots = UniformKnots(3, kControlPoints, EndKnots::kEndInterpolating, 0.0, 1.0);
  spec.hold_ends = hold_ends;
  Points control_points(kControlPoints, 2);
  for (int j = 0; j < kControlPoints; ++j) {
    control_points.row(j) << std::cos(0.2 * j), 1.5 * std::sin(0.2 * j);
  }
  return {spec, control_points, 40, 40.0 / 60.0 - 0.5};  // spans are 1/9 long
}

/// Knots twice at the seam and, a corner, three times at 0.25.
const std::vector<double>& RepeatedKnots() {
  static const auto& knots = *new std::vector<double>{-0.5, -0.4, -0.2, 0.0, 0.0, 0.25, 0.25, 0.25,
                                                      0.5,  0.6,  0.8,  1.0, 1.0, 1.25, 1.25};
  return knots;
}

/// Its way leads from 0.7 over the seam to about 0.05.
Stray StrayAcrossTheSeam() {
  FitSpec spec = FreeSpec(true, 8);
  spec.given_knots = RepeatedKnots();
  Points control_points(8, 2);
  for (int j = 0; j < 8; ++j) {
    control_points.row(j) << std::cos(0.785 * j), 1.25 * std::sin(0.785 * j + 0.1);
  }
  return {spec, control_points, 3, 0.7};
}

struct StrayTrial {
  explicit StrayTrial(const Stray& stray, const std::string& name = "ceres_lm",
                      TestContextOptions options = {})
      : context(*stray.problem, options), x(stray.start) {
    Objective objective(stray.problem.get(), &context);
    outcome = MakeSolver<CeresLmSolver>(name).Minimize(&objective, &context, &x);
  }
  int rebindings() const { return std::stoi(context.notes().at("re-bindings")); }

  TestContext context;
  Eigen::VectorXd x;
  Outcome outcome;
};

TEST(CeresLmFree, FollowsAParameterThroughSpans) {
  for (const bool hold_ends : {false, true}) {
    const Stray stray = StrayOnAnArc(hold_ends);
    StrayTrial trial(stray);
    EXPECT_TRUE(IsSuccess(trial.outcome.reason)) << trial.outcome.message;
    // Two spans at most to the end of a window, then two more.
    EXPECT_GE(trial.rebindings(), 2);
    EXPECT_LE(trial.context.Energy(trial.x), 1e-10 * trial.context.Energy(stray.start));
    EXPECT_NEAR(stray.At(trial.x), stray.foot, 1e-2);
  }
}

TEST(CeresLmFree, BoundOnceItEndsHigher) {
  const Stray stray = StrayOnAnArc();
  Objective objective(stray.problem.get(), nullptr);
  CeresProblem once(&objective, Evaluation::kJacobian, stray.start);
  once.AddTerms();
  ceres::Solver::Options options;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = 1000;
  options.function_tolerance = options.parameter_tolerance = 1e-16;
  ceres::Solver::Summary summary;
  ceres::Solve(options, once.problem(), &summary);
  ASSERT_TRUE(summary.IsSolutionUsable()) << summary.message;
  double energy = 0.0;
  ASSERT_EQ(objective.Energy(once.state(), &energy), Status::kOk);
  StrayTrial trial(stray);
  EXPECT_TRUE(once.moving().AnyHasArrived(once.state()));
  EXPECT_GT(energy, 1e-6);
  EXPECT_LE(trial.context.Energy(trial.x), 1e-6 * energy);
}

TEST(CeresLmFree, FollowsAParameterAcrossTheSeamAndRepeatedKnots) {
  const Stray stray = StrayAcrossTheSeam();
  StrayTrial trial(stray);
  EXPECT_TRUE(IsSuccess(trial.outcome.reason)) << trial.outcome.message;
  EXPECT_GE(trial.rebindings(), 1);
  EXPECT_LE(trial.context.Energy(trial.x), 1e-10 * trial.context.Energy(stray.start));
  EXPECT_NEAR(stray.At(trial.x), stray.foot, 1e-2);
}

TEST(CeresLmFree, EliminatesParametersUnlessToldOtherwise) {
  const Stray stray = StrayOnAnArc();
  for (const char* options :
       {"", "/strategy=dogleg", "/linear_solver=sparse_normal_cholesky",
        "/linear_solver=dense_normal_cholesky", "/linear_solver=dense_qr", "/linear_solver=cgnr"}) {
    StrayTrial trial(stray, std::string("ceres_lm") + options);
    EXPECT_LE(trial.context.Energy(trial.x), 1e-10 * trial.context.Energy(stray.start)) << options;
    const std::string used = trial.context.notes().at("linear solver");
    EXPECT_EQ(used == "sparse_schur", std::string(options).find("linear") == std::string::npos);
  }
}

TEST(CeresLmFree, ParametersPressedAgainstAnEndStayThere) {
  for (const bool hold_ends : {false, true}) {
    for (const auto& [name, control_points] : {std::pair("rhino_100", 8), {"cat_110", 30}}) {
      FitSpec spec = FreeSpec(false, control_points);
      spec.parameters = Parameterization::kUniform;
      spec.hold_ends = hold_ends;
      const auto problem = MakeFileFit(std::string("animals/") + name + ".csv", spec);
      LmTrial trial(*problem, "ceres_lm");
      EXPECT_EQ(trial.outcome.reason, StopReason::kNativeStop) << name << trial.outcome.message;
      const double small = SmallGradient(*problem, &trial);
      EXPECT_LE(trial.context.GradientNorm(trial.x), small) << name;
      EXPECT_EQ(trial.context.iterates().back(), trial.x) << name;
      const Eigen::VectorXd all = problem->elimination().Expand(trial.x);
      const int first = problem->curve_fit()->setting().parameter_offset;
      // A hair past the end they do not count in the gradient; in the domain E would fall no more.
      Eigen::VectorXd at_ends = all;
      int num_pressed = 0;
      for (int v = first; v < all.size(); ++v) {
        at_ends[v] = std::clamp(all[v], 0.0, 1.0);
        EXPECT_TRUE(all[v] == at_ends[v] || all[v] == std::nextafter(at_ends[v], all[v])) << v;
        if (all[v] != at_ends[v]) ++num_pressed;
      }
      EXPECT_EQ(num_pressed > 0, !hold_ends) << name;
      EXPECT_LE(InnerGradientNorm(*problem, problem->elimination().FreeVariables(at_ends)), small)
          << name;
      if (hold_ends) {
        EXPECT_EQ(all[first], 0.0) << name;
        EXPECT_EQ(all[all.size() - 1], 1.0) << name;
      }
    }
  }
}

TEST(CeresLmFree, BooksARebindingAsNoIteration) {
  const Stray stray = StrayOnAnArc();
  StrayTrial trial(stray);
  const std::vector<Eigen::VectorXd>& iterates = trial.context.iterates();
  EXPECT_EQ(iterates.front(), stray.start);
  EXPECT_EQ(iterates.back(), trial.x);
  for (std::size_t k = 1; k < iterates.size(); ++k) EXPECT_NE(iterates[k], iterates[k - 1]) << k;
  TestContextOptions options;
  for (int most = 0; most + 1 < static_cast<int>(iterates.size()); most += 5) {
    options.max_iterations = most;
    StrayTrial stopped(stray, "ceres_lm", options);
    EXPECT_EQ(stopped.outcome.reason, StopReason::kIterationLimit) << most;
    EXPECT_EQ(stopped.x, iterates[static_cast<std::size_t>(most)]) << most;
  }
}

TEST(CeresLmFree, StopsWhereverTheMonitorSaysNo) {
  const Stray stray = StrayOnAnArc();
  const int all = StrayTrial(stray).context.count(Evaluation::kEnergy);
  for (int most = 0; most < all; most += 7) {
    TestContextOptions options;
    options.max_energies = most;
    StrayTrial trial(stray, "ceres_lm", options);
    EXPECT_EQ(trial.outcome.reason, StopReason::kTimeLimit) << most;
    EXPECT_EQ(trial.context.count(Evaluation::kEnergy), most);
    EXPECT_EQ(trial.context.refused(), 1) << most;
    EXPECT_EQ(trial.context.iterates().back(), trial.x) << most;
  }
}

TEST(CeresLmFree, CallsAStartWithoutAValueANumericalFailure) {
  Stray stray = StrayOnAnArc();
  stray.start[0] = 1e200;  // its square is infinite
  TestContextOptions never;
  never.gradient_tolerance = -1.0;
  StrayTrial trial(stray, "ceres_lm", never);
  EXPECT_EQ(trial.outcome.reason, StopReason::kNumericalFailure);
  EXPECT_EQ(trial.x, stray.start);
}

TEST(CeresLmFree, SaysWhyNot) {
  const Stray stray = StrayOnAnArc();
  Problem& problem = *stray.problem;
  const int t = problem.curve_fit()->setting().parameter_offset;
  EXPECT_THAT(WhyUnsupported<CeresLmSolver>(problem, "ceres_lm"), IsEmpty());
  EXPECT_THAT(WhyUnsupported<CeresLbfgsSolver>(problem, "ceres_lbfgs/form=problem"),
              HasSubstr("cannot follow free parameters past their spans; use form=objective"));
  SetConstraints({{"ends meet", {{0, 1.0}, {22, -1.0}}, 0.0}, {"held", {{t, 1.0}}, 0.0}}, &problem);
  EXPECT_THAT(WhyUnsupported<CeresLmSolver>(problem, "ceres_lm"), IsEmpty());
  SetConstraints({{"tied", {{t, 1.0}, {t + 1, -1.0}}, 0.0}}, &problem);
  EXPECT_THAT(WhyUnsupported<CeresLmSolver>(problem, "ceres_lm"),
              HasSubstr("none that tie them to others; use lbfgs"));
  SetConstraints({}, &problem);
  problem.SetBounds(Eigen::VectorXd::Zero(problem.num_variables()),
                    Eigen::VectorXd::Ones(problem.num_variables()));
  EXPECT_THAT(WhyUnsupported<CeresLmSolver>(problem, "ceres_lm"),
              HasSubstr("ceres_lm bounds free parameters itself"));
}

}  // namespace
}  // namespace batten
