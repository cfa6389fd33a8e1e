#include "problems/fit_problem.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "problems/objective.h"
#include "tests/solvers/test_fits.h"

namespace batten {
namespace {

using ::testing::HasSubstr;

/// "" if the problem can be made.
std::string WhyNot(DataSet data, const FitSpec& spec) {
  std::string error;
  return MakeFitProblem(std::move(data), spec, &error) != nullptr ? "" : error;
}

DataSet WithParameters(DataSet data, double begin, double step) {
  data.parameters = Eigen::VectorXd(data.points.rows());
  for (Eigen::Index i = 0; i < data.points.rows(); ++i) {
    (*data.parameters)[i] = begin + step * static_cast<double>(i);
  }
  return data;
}

TEST(FitProblem, RefusesParametersOfAClosedCurveThatWouldWrapAroundUnasked) {
  FitSpec spec = MakeSpec(3, true, 8);
  spec.parameters.reset();
  const DataSet data = WithParameters(MakeNoisyLoop(20, 2, 1), 0.0, 1.0);
  EXPECT_THAT(WhyNot(data, spec), HasSubstr("parameter 2 of data point 3 is outside [0, 1]"));
  EXPECT_EQ(WhyNot(WithParameters(data, 0.0, 0.05), spec), "");
  spec.domain = {0.0, 20.0};
  EXPECT_EQ(WhyNot(data, spec), "");
  // Stated, one period is what wraps: parameter 20 is 0 again.
  const auto once = MakeFit(data, spec);
  const auto twice = MakeFit(WithParameters(data, 20.0, 1.0), spec);
  EXPECT_EQ(once->curve_fit()->parameters(), twice->curve_fit()->parameters());
}

TEST(FitProblem, PutsTheParametersOfARuleOnTheDomainOfGivenKnots) {
  for (const bool closed : {false, true}) {
    FitSpec spec = MakeSpec(3, closed, closed ? 6 : 8);
    spec.given_knots =
        UniformKnots(3, spec.control_points,
                     closed ? EndKnots::kPeriodic : EndKnots::kEndInterpolating, 0.0, 1.0);
    const auto unit = MakeFit(MakeNoisyLoop(30, 2, 3), spec);
    // A power of two times, and moved: 4 t - 2 is exact but for a rounding of the sum.
    for (double& knot : spec.given_knots) knot = 4.0 * knot - 2.0;
    const auto moved = MakeFit(MakeNoisyLoop(30, 2, 3), spec);
    const Eigen::VectorXd expected = 4.0 * unit->curve_fit()->parameters().array() - 2.0;
    EXPECT_LT((moved->curve_fit()->parameters() - expected).cwiseAbs().maxCoeff(), 1e-15 * 4);
    EXPECT_EQ(moved->curve_fit()->parameters().maxCoeff() > 1.0, true);
  }
}

TEST(FitProblem, DoesNotScaleByPointsWithoutWeight) {
  DataSet data = MakeNoisyLoop(30, 2, 3);
  FitSpec spec = MakeSpec(3, false, 8);
  spec.parameters = Parameterization::kUniform;
  const double size = MakeFit(data, spec)->curve_fit()->size();
  data.points.row(7) << 1e6, -1e6;
  (*data.weights)[7] = 0.0;
  EXPECT_LE(MakeFit(data, spec)->curve_fit()->size(), size);
}

TEST(FitProblem, RefusesSizesWhoseSquaresAreNoNumbers) {
  const FitSpec spec = MakeSpec(3, false, 8);
  DataSet data = MakeNoisyLoop(30, 2, 3);
  data.weights.reset();
  DataSet tiny = data;
  tiny.points *= 1e-160;
  EXPECT_THAT(WhyNot(tiny, spec), HasSubstr("allowed: 0 or at least 1e-130"));
  tiny.points *= 1e40;
  EXPECT_EQ(WhyNot(tiny, spec), "");
  data.weights = Eigen::VectorXd::Constant(30, 1e200);
  data.points *= 1e60;
  EXPECT_THAT(WhyNot(data, spec), HasSubstr("the largest weight times the squared spread"));
}

TEST(FitProblem, RefusesTermsThatSayNothing) {
  EXPECT_THAT(WhyNot(MakeNoisyLoop(30, 2, 3), MakeSpec(3, false, 8, "interpolation/weight=0")),
              HasSubstr("the largest weight of a term is 0"));
  EXPECT_THAT(WhyNot(MakeNoisyLoop(30, 2, 3), MakeSpec(3, false, 8, "interpolation,interpolation")),
              HasSubstr("term interpolation is given twice"));
  EXPECT_THAT(WhyNot(MakeNoisyLoop(30, 2, 3),
                     MakeSpec(3, false, 8, "interpolation,interpolation/weight=1")),
              HasSubstr("term interpolation/weight=1 is given twice"));
  EXPECT_THAT(WhyNot(MakeNoisyLoop(30, 2, 3), MakeSpec(3, false, 8, "interpolation/loss_scale=2")),
              HasSubstr("loss_scale is given without a loss"));
}

TEST(FitProblem, LossScaleFollowsTheSizeOfTheDataAndNotItsPowerOfTwo) {
  const auto energy = [](double scale) {
    DataSet data = MakeNoisyLoop(40, 2, 3);
    data.points *= scale;
    FitSpec spec = MakeSpec(3, true, 9, "interpolation/loss=cauchy/loss_scale=0.05");
    spec.parameters = Parameterization::kUniform;
    const auto problem = MakeFit(std::move(data), spec);
    double found = 0.0;
    Objective(problem.get(), nullptr).Energy(problem->start(), &found);
    return found * problem->units().energy / (scale * scale);
  };
  for (const double scale : {1.1, 1.7, 1e3}) {
    EXPECT_NEAR(energy(scale), energy(1.0), 1e-12 * energy(1.0));
  }
}

}  // namespace
}  // namespace batten
