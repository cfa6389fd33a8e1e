// What a fit's parameters are: fixed, free, projected; guards against loops.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "problems/objective.h"
#include "tests/solvers/test_fits.h"

namespace batten {
namespace {

using ::testing::HasSubstr;

std::string WhyNot(FitSpec spec) {
  std::string error;
  EXPECT_EQ(MakeFitProblem(MakeNoisyBean(30, 2, 801), std::move(spec), &error), nullptr);
  return error;
}

FitSpec WithGuard(const std::string& guard) {
  FitSpec spec = MakeFreeSpec(3, true, 9);
  std::string error;
  NameSpec name;
  CHECK(ParseNameSpec(guard, &name, &error)) << error;
  spec.guard = name;
  return spec;
}

TEST(ParameterKind, ReadsWhatItWrites) {
  for (const ParameterKind kind :
       {ParameterKind::kFixed, ParameterKind::kFree, ParameterKind::kProjected}) {
    ParameterKind read = ParameterKind::kFixed;
    EXPECT_TRUE(FromString(ToString(kind), &read));
    EXPECT_EQ(read, kind);
  }
  ParameterKind unchanged = ParameterKind::kFree;
  EXPECT_FALSE(FromString("feet", &unchanged));
  EXPECT_EQ(unchanged, ParameterKind::kFree);
}

TEST(ProjectedFit, HasTheSumOfSquaredDistancesAsItsEnergy) {
  const auto problem = MakeFit(MakeNoisyBean(30, 2, 802), MakeProjectedSpec(3, true, 9));
  const CurveFit& fit = *problem->curve_fit();
  EXPECT_EQ(problem->num_variables(), 18);
  Eigen::VectorXd x = problem->start();
  x[3] += 0.2;
  double energy = 0.0;
  ASSERT_EQ(Objective(problem.get(), nullptr).Energy(x, &energy), Status::kOk);
  // Samples so dense that the nearest is farther than the foot by 1e-4 of the size at most.
  const BsplineCurve curve = fit.Curve(x);
  const Points samples = curve.Sample(Eigen::VectorXd::LinSpaced(40001, 0.0, 1.0));
  const Points at_feet = curve.Sample(fit.Parameters(x));
  double sampled = 0.0;
  for (Eigen::Index i = 0; i < 30; ++i) {
    const double nearest =
        (samples.rowwise() - fit.data().points.row(i)).rowwise().norm().minCoeff();
    EXPECT_NEAR((at_feet.row(i) - fit.data().points.row(i)).norm(), nearest, 1e-4);
    EXPECT_LE((at_feet.row(i) - fit.data().points.row(i)).norm(), nearest + 1e-12);
    sampled += (*fit.data().weights)[i] * nearest * nearest;
  }
  EXPECT_NEAR(energy * problem->units().energy, sampled, 1e-3 * sampled);
}

TEST(ProjectedFit, TakesTermsThatDoNotSayWhatTheParametersAre) {
  EXPECT_THAT(WhyNot(MakeProjectedSpec(3, true, 9, "circle", "interpolation")),
              HasSubstr("they are projected; use foot_point"));
  EXPECT_THAT(WhyNot(MakeProjectedSpec(3, true, 9, "circle", "foot_point,free_parameter")),
              HasSubstr("term free_parameter"));
  EXPECT_THAT(WhyNot(MakeSpec(3, true, 9, "foot_point")), HasSubstr("this problem's are fixed"));
  MakeFit(MakeNoisyBean(30, 2, 803),
          MakeProjectedSpec(3, true, 9, "circle", "foot_point,fairing/weight=1e-6"));
}

TEST(FreeFit, HasATermWithParameters) {
  EXPECT_THAT(WhyNot(MakeFreeSpec(3, true, 9, "circle", "interpolation")),
              HasSubstr("no term has them; add free_parameter"));
}

TEST(FitConstraints, AreThoseOfFreeParameters) {
  FitSpec projected = MakeProjectedSpec(3, false, 9, "data");
  projected.hold_ends = true;
  EXPECT_THAT(WhyNot(projected), HasSubstr("the parameters are projected"));
  FitSpec fixed = MakeSpec(3, true, 9);
  fixed.keep_order = true;
  EXPECT_THAT(WhyNot(fixed), HasSubstr("the parameters are fixed"));
}

TEST(Guard, IsALightFairingTermOfTheProblem) {
  for (const auto& [guard, weight] : {std::pair("length", 30 * 1e-5), {"length/weight=2", 60.0}}) {
    const auto problem = MakeFit(MakeNoisyBean(30, 2, 804), WithGuard(guard));
    ASSERT_EQ(problem->terms().size(), 2U);
    EXPECT_THAT(problem->terms()[1].name, HasSubstr("fairing/derivative=1"));
    EXPECT_EQ(problem->terms()[1].family->weight(), weight);
    // Made again from its own spec it has it once.
    EXPECT_EQ(MakeFit(MakeNoisyBean(30, 2, 804), problem->curve_fit()->spec())->terms().size(), 2U);
  }
}

TEST(Guard, OfNoneAddsNothing) {
  EXPECT_EQ(MakeFit(MakeNoisyBean(30, 2, 804), WithGuard("none"))->terms().size(), 1U);
  EXPECT_THAT(WhyNot(WithGuard("none/weight=1")), HasSubstr("weight"));
}

TEST(Guard, IsRefusedWhereItIsNotKnown) {
  EXPECT_THAT(WhyNot(WithGuard("lenght")), HasSubstr("length"));
  EXPECT_THAT(WhyNot(WithGuard("length/weight=-1")), HasSubstr("weight"));
  EXPECT_THAT(WhyNot(WithGuard("length:bending")), HasSubstr("wraps nothing"));
}

}  // namespace
}  // namespace batten
