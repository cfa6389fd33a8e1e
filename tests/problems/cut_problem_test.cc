#include "problems/cut_problem.h"

#include <gtest/gtest.h>

#include <string>

#include "problems/objective.h"
#include "tests/splines/example_splines.h"

namespace batten {
namespace {

BezierCurve CurveOf(const Points& points) { return BezierCurve::Make(points, nullptr).value(); }

TEST(CutProblem, ItsEnergyIsTheValueInTheUsersUnits) {
  std::mt19937 random(71);
  const BezierCurve curve = CurveOf(1000.0 * RandomPoints(8, 2, &random));
  for (const CutMeasure measure : {CutMeasure::kFlatness, CutMeasure::kHullArea}) {
    std::string error;
    const std::unique_ptr<Problem> problem = MakeCutProblem(measure, curve, 0.37, &error);
    ASSERT_NE(problem, nullptr) << error;
    EXPECT_EQ(problem->num_variables(), 1);
    EXPECT_EQ(problem->start()[0], 0.37);
    double energy = 0.0;
    ASSERT_EQ(problem->terms()[0].family->Evaluate(problem->start(), 0, 1, &energy, nullptr),
              Status::kOk);
    CutValue value(measure, 7, 2, curve.control_points().data());
    EXPECT_NEAR(energy * problem->units().energy / value(0.37), 1.0, 1000 * kEpsilon);
  }
}

TEST(CutProblem, OutsideTheCurveEnergyIsNotFinite) {
  std::string error;
  const std::unique_ptr<Problem> problem = MakeCutProblem(
      CutMeasure::kFlatness, CurveOf(PointsOf({{0, 0}, {1, 2}, {2, 0}})), 0.5, &error);
  double energy = 0.0;
  EXPECT_EQ(problem->terms()[0].family->Evaluate(Eigen::VectorXd::Constant(1, 1.5), 0, 1, &energy,
                                                 nullptr),
            Status::kNonFinite);
}

TEST(CutProblem, RefusesWhatHasNoBestCut) {
  std::string error;
  const BezierCurve parabola = CurveOf(PointsOf({{0, 0}, {1, 2}, {2, 0}}));
  EXPECT_EQ(MakeCutProblem(CutMeasure::kFlatness, CurveOf(PointsOf({{0, 0}, {1, 2}})), 0.5, &error),
            nullptr);
  EXPECT_EQ(error, "found degree 1; allowed: 2 to 60");
  EXPECT_EQ(MakeCutProblem(CutMeasure::kFlatness, parabola, 1.0, &error), nullptr);
  EXPECT_EQ(error, "found the start 1; allowed: above 0 and below 1");
  EXPECT_EQ(MakeCutProblem(CutMeasure::kHullArea,
                           CurveOf(PointsOf({{0, 0, 0}, {1, 2, 0}, {2, 0, 1}})), 0.5, &error),
            nullptr);
  EXPECT_EQ(error, "the hull's area needs a planar curve; found 3 coordinates, use flatness");
}

}  // namespace
}  // namespace batten
