#include "solvers/foot_iteration.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "solvers/foot_projection.h"
#include "tests/solvers/contract_cases.h"
#include "tests/solvers/dense_joint.h"

namespace batten {
namespace {

/// All variables: the start's control points, moved so that nothing is symmetric, at their feet.
Eigen::VectorXd MovedStart(Objective* objective) {
  const Problem& problem = objective->problem();
  Eigen::VectorXd all = problem.start();
  std::mt19937 random(20240901);
  for (Eigen::Index k = 0; k < problem.ranges().front().size; ++k) {
    all[k] += RandomBetween(-0.02, 0.02, &random);
  }
  EXPECT_EQ(ProjectParameters(objective, 1, problem.start(), &all), Status::kOk);
  return all;
}

/// By how much a model says that E changes when the control points move by v.
double ModelChange(const FootModel& model, const Eigen::VectorXd& v) {
  return 2.0 * model.half_gradient().dot(v) + v.dot(model.half_hessian().ToDense() * v);
}

/// E at the feet on the curve of all variables x, its control points moved by v.
double EnergyAtFeet(Objective* objective, const Eigen::VectorXd& x, const Eigen::VectorXd& v) {
  Eigen::VectorXd all = x;
  all.head(v.size()) += v;
  EXPECT_EQ(ProjectParameters(objective, 1, x, &all), Status::kOk);
  double energy = 0.0;
  EXPECT_EQ(objective->Energy(all, &energy), Status::kOk);
  return energy;
}

/// How the error of a model's change of E falls: the exponent of h, by halving it.
double ErrorOrder(Objective* objective, FootModelKind kind, const Eigen::VectorXd& x,
                  const Eigen::VectorXd& v) {
  FootModel model(*objective->free_view(), 1);
  EXPECT_TRUE(model.Sum(x, kind, 0.0));
  const double energy = EnergyAtFeet(objective, x, 0.0 * v);
  const auto error = [&](double h) {
    return std::abs(EnergyAtFeet(objective, x, h * v) - energy - ModelChange(model, h * v));
  };
  // Steps for which h^3 is far above rounding, 1e-15, and h small against the curve, about 1.
  constexpr double kStep = 1.0 / 256.0;
  return std::log2(error(kStep) / error(0.5 * kStep));
}

/// An outline's fit in which data point `i` alone has weight, and lies `distance` (of the size of
/// the outline) outside of the curve, or inside where that is negative.
std::unique_ptr<Problem> OnePointOffTheCurve(int i, double distance) {
  DataSet data = MakeNoisyBean(40, 2, 501);
  FitSpec spec = MakeFreeSpec(3, true, 9, "ellipse");
  const auto plain = MakeFit(data, spec);
  const BsplineCurve curve = plain->curve_fit()->Curve(plain->start());
  spec.start_points = curve.control_points();
  double c[4];
  const double t = plain->curve_fit()->Parameters(plain->start())[i];
  curve.EvaluateUpTo(t, 1, c);
  // It runs counterclockwise: outside is to the right.
  const Eigen::RowVector2d out = Eigen::RowVector2d(c[3], -c[2]).normalized();
  data.points.row(i) = Eigen::RowVector2d(c[0], c[1]) + 2.0 * distance * out;
  data.weights->setZero();
  (*data.weights)[i] = 1.0;
  return MakeFit(data, spec);
}

/// All control points moved alike: as if the data point moved the other way.
Eigen::VectorXd Translation(const Problem& problem) {
  Eigen::VectorXd v(problem.ranges().front().size);
  for (Eigen::Index k = 0; k < v.size(); k += 2) v.segment(k, 2) << 0.6, -0.8;
  return v;
}

TEST(SdmModel, IsTheSquaredDistanceToSecondOrderWhereADataPointMovesOnTheConvexSide) {
  for (const int i : {3, 11, 20, 33}) {
    for (const double distance : {0.05, 0.3}) {
      const auto problem = OnePointOffTheCurve(i, distance);
      Objective objective(problem.get(), nullptr);
      const Eigen::VectorXd v = Translation(*problem);
      EXPECT_NEAR(ErrorOrder(&objective, FootModelKind::kCurvature, problem->start(), v), 3.0, 0.1)
          << i;
    }
  }
}

TEST(SdmModel, IsClampedOnTheConcaveSideWhereNewtonsIsNot) {
  for (const int i : {3, 11, 20, 33}) {
    const auto problem = OnePointOffTheCurve(i, -0.2);
    Objective objective(problem.get(), nullptr);
    const Eigen::VectorXd v = Translation(*problem);
    EXPECT_NEAR(ErrorOrder(&objective, FootModelKind::kCurvature, problem->start(), v), 2.0, 0.1)
        << i;
    EXPECT_NEAR(ErrorOrder(&objective, FootModelKind::kNewton, problem->start(), v), 3.0, 0.1) << i;
    // Clamped it is the squared distance from the tangent, which is above that from the curve.
    FootModel model(*objective.free_view(), 1);
    ASSERT_TRUE(model.Sum(problem->start(), FootModelKind::kCurvature, 0.0));
    const double h = 1.0 / 256.0;
    EXPECT_GT(ModelChange(model, h * v), EnergyAtFeet(&objective, problem->start(), h * v) -
                                             EnergyAtFeet(&objective, problem->start(), 0.0 * v));
  }
}

TEST(NewtonModel, IsTheEnergyAtTheFeetToSecondOrderInTheControlPoints) {
  for (const int dimension : {2, 3}) {
    for (const bool weighted : {false, true}) {
      DataSet data = MakeNoisyBean(50, dimension, 502);
      if (!weighted) data.weights.reset();
      const auto problem = MakeFit(data, MakeFreeSpec(5, true, 10, "ellipse"));
      Objective objective(problem.get(), nullptr);
      const Eigen::VectorXd x = MovedStart(&objective);
      std::mt19937 random(20240902);
      Eigen::VectorXd v(problem->ranges().front().size);
      for (double& entry : v) entry = RandomBetween(-0.5, 0.5, &random);
      EXPECT_NEAR(ErrorOrder(&objective, FootModelKind::kNewton, x, v), 3.0, 0.1);
      // What the others leave out is of second order.
      EXPECT_NEAR(ErrorOrder(&objective, FootModelKind::kTangent, x, v), 2.0, 0.1);
      EXPECT_NEAR(ErrorOrder(&objective, FootModelKind::kPoint, x, v), 2.0, 0.1);
    }
  }
}

TEST(Tdm, UndampedStepsAsGaussAndNewtonWithParametersEliminated) {
  for (const int dimension : {2, 3}) {
    const auto problem =
        MakeFit(MakeNoisyBean(60, dimension, 503), MakeFreeSpec(3, true, 5, "ellipse"));
    TestContext context(*problem);
    Objective objective(problem.get(), &context);
    const auto solver = MakeSolver("tdm/damping=0/search=none");
    auto* map = dynamic_cast<FixedPoint*>(solver.get());
    Eigen::VectorXd x = MovedStart(&objective), image;
    ASSERT_FALSE(map->Start(&objective, &context, &x).has_value());
    ASSERT_EQ(map->Map(x, &image), Status::kOk);
    const DenseJoint dense(*problem, x);
    const Eigen::Index size = map->num_mapped(x);
    const Eigen::VectorXd expected = dense.Step(FootModelKind::kTangent, 0.0).head(size);
    const Eigen::MatrixXd reduced = dense.Reduce(FootModelKind::kTangent, 0.0).half_hessian;
    const Eigen::VectorXd sizes = reduced.jacobiSvd().singularValues();
    // tdm keeps a damping of 64 roundings; few control points hold the points, which makes 1e-10.
    const double condition = sizes[0] / sizes[size - 1];
    ASSERT_LT(64 * kEpsilon * condition, 1e-10);
    EXPECT_LT((image.head(size) - x.head(size) - expected).norm(), 1e-10 * expected.norm());
  }
}

/// Turns all coordinates by an orthogonal matrix.
Points Turned(const Points& points, const Eigen::MatrixXd& turn) {
  return Points(points * turn.transpose());
}

Eigen::MatrixXd SomeTurn(int dimension) {
  std::mt19937 random(20240903);
  const Eigen::MatrixXd drawn = RandomPoints(dimension, dimension, &random);
  return drawn.householderQr().householderQ();
}

TEST(FreeFits, HaveTheSameEnergiesAndIteratesWhenAllIsTurned) {
  for (const int dimension : {2, 3}) {
    const Eigen::MatrixXd turn = SomeTurn(dimension);
    DataSet data = MakeNoisyBean(50, dimension, 504);
    // The longest sides of the two boxes are below and above a power of two.
    const auto side = [](const Points& points) {
      return (points.colwise().maxCoeff() - points.colwise().minCoeff()).maxCoeff();
    };
    const double sides[] = {side(data.points), side(Turned(data.points, turn))};
    data.points *= 4.0 / std::sqrt(sides[0] * sides[1]);
    ASSERT_GT(std::abs(std::log(sides[0] / sides[1])), 0.01);
    FitSpec spec = MakeFreeSpec(3, true, 9, "ellipse");
    spec.start_points =
        MakeFit(data, spec)->curve_fit()->ControlPoints(MakeFit(data, spec)->start());
    const auto plain = MakeFit(data, spec);
    data.points = Turned(data.points, turn);
    spec.start_points = Turned(spec.start_points, turn);
    const auto turned = MakeFit(data, spec);
    ASSERT_EQ(plain->units().length, turned->units().length);
    for (const char* solver : {"foot_newton", "newton", "lm_schur", "varpro", "tdm", "sdm", "pdm",
                               "gi", "anderson:pdm", "lbfgs", "ceres_lbfgs"}) {
      SCOPED_TRACE(solver);
      SolverTrial one(*plain, solver, {5});
      SolverTrial two(*turned, solver, {5});
      ASSERT_EQ(one.iterations(), two.iterations());
      // A rounding grows by the condition of a step's equations, 1e3 at most, at each of a few
      // steps.
      constexpr double kNear = 1e-8;
      for (int k = 0; k <= one.iterations(); ++k) {
        const Eigen::VectorXd& x = one.context.iterates()[static_cast<std::size_t>(k)];
        const Eigen::VectorXd& y = two.context.iterates()[static_cast<std::size_t>(k)];
        const double energy = one.context.Energy(x);
        EXPECT_NEAR(two.context.Energy(y), energy, kNear * energy) << k;
        const Points expected = Turned(plain->curve_fit()->ControlPoints(x), turn);
        EXPECT_LT((turned->curve_fit()->ControlPoints(y) - expected).norm(), kNear * 10.0) << k;
      }
    }
  }
}

}  // namespace
}  // namespace batten
