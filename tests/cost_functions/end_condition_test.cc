#include "cost_functions/end_condition.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "cost_functions/bessel_tangents.h"
#include "tests/cost_functions/example_fit.h"

namespace batten {
namespace {

/// Open cubic on [0, 2] with data on the parabola (t^2, 3 - t), far from the origin in x.
struct ParabolaFit {
  ParabolaFit() : basis(BasisOf(3, false, {0, 0, 0, 0, 0.5, 2, 2, 2, 2})) {
    for (const double t : {0.0, 0.3, 0.3, 0.9, 1.6, 2.0}) {
      parameters.push_back(t);
      points.insert(points.end(), {1e6 + t * t, 3.0 - t});
    }
    sites.size = static_cast<int>(parameters.size());
    sites.parameters = parameters.data();
    sites.points = points.data();
    GroupBySpan(basis, true, &sites);
    setting.basis = &basis;
    setting.dimension = 2;
    setting.center[0] = 1e6;
    setting.center[1] = 2.0;
    setting.scale = 0.25;
    setting.data = &sites;
  }
  std::unique_ptr<BlockFamily> Make(const std::string& text) {
    NameSpec spec;
    const Term* term = nullptr;
    OptionValues values;
    EXPECT_TRUE(ParseNameSpec(text, &spec, &error)) << error;
    EXPECT_TRUE(TermRegistry::Global().Resolve(spec, &term, &values, &error)) << error;
    return term->MakeFamily(setting, values, &error);
  }
  /// Scaled control points of the parabola itself: blossoms.
  Eigen::VectorXd Parabola() const {
    Eigen::VectorXd x(10);
    for (int j = 0; j < 5; ++j) {
      const double a = basis.knots()[j + 1], b = basis.knots()[j + 2], c = basis.knots()[j + 3];
      x[2 * j] = 0.25 * (a * b + a * c + b * c) / 3.0;
      x[2 * j + 1] = 0.25 * (1.0 - (a + b + c) / 3.0);
    }
    return x;
  }
  BsplineBasis basis;
  std::vector<double> parameters;
  std::vector<double> points;
  Sites sites;
  FitSetting setting;
  std::string error;
};

// Data near 1e6 carry roundings of 1e-10; differences over 0.3 three times as much.
constexpr double kTolerance = 1e-9;

TEST(BesselTangents, AreExactOnAParabola) {
  const ParabolaFit fit;
  const auto begin = BesselTangent(fit.setting, false);
  const auto end = BesselTangent(fit.setting, true);
  ASSERT_TRUE(begin.has_value() && end.has_value());
  EXPECT_NEAR((*begin)[0], 0.0, kTolerance);
  EXPECT_NEAR((*begin)[1], -1.0, kTolerance);
  EXPECT_NEAR((*end)[0], 4.0, kTolerance);
}

TEST(BesselTangents, OfTwoPointsAreTheLineAndOfOneParameterNothing) {
  ParabolaFit fit;
  fit.sites.size = 2;
  EXPECT_NEAR((*BesselTangent(fit.setting, true))[0], 0.3, kTolerance);
  fit.sites.size = 1;
  EXPECT_FALSE(BesselTangent(fit.setting, false).has_value());
}

TEST(EndConditions, VanishOnTheParabolaOfTheirData) {
  ParabolaFit fit;
  for (const char* text : {"end_point", "end_tangent", "end_tangent/units=source",
                           "end_curvature/x=2/y=0/units=source"}) {
    const auto family = fit.Make(text);
    ASSERT_NE(family, nullptr) << fit.error;
    EXPECT_EQ(family->size(), 2);
    EXPECT_NEAR(EnergyAt(*family, fit.Parabola()), 0.0, kTolerance * kTolerance) << text;
  }
}

TEST(EndConditions, HaveTheStatedUnits) {
  ParabolaFit fit;
  const Eigen::VectorXd x = fit.Parabola();
  // Scale 0.25, so that energies are a 16th of those in the unit of the data.
  const auto energy = [&](const char* text) { return 16.0 * EnergyAt(*fit.Make(text), x); };
  EXPECT_NEAR(energy("end_curvature/units=source"), 2 * 4.0, kTolerance);
  EXPECT_NEAR(energy("end_curvature"), 2 * 4.0 * 16.0, 16 * kTolerance);
  EXPECT_NEAR(energy("end_curvature/end=begin"), 4.0 * 16.0, 16 * kTolerance);
  // C'(0) = (0, -1) against (1, -1): the domain is 2 long, the first knot difference 0.5.
  EXPECT_NEAR(energy("end_tangent/end=begin/x=1"), 4.0, 4 * kTolerance);
  EXPECT_NEAR(energy("end_tangent/end=begin/x=1/units=source"), 0.25 / 9.0, kTolerance);
  EXPECT_NEAR(energy("end_point/end=end/y=3"), 4.0, kTolerance);
}

TEST(EndConditions, OfSourceUnitsAreDifferencesOfControlPoints) {
  ParabolaFit fit;
  const DenseRows rows(*fit.Make("end_tangent/units=source")->rows());
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(2, 5);
  expected.row(0) << -1, 1, 0, 0, 0;
  expected.row(1) << 0, 0, 0, -1, 1;
  EXPECT_LE((rows.matrix - expected).cwiseAbs().maxCoeff(), 16 * kEpsilon);
}

TEST(EndConditions, SayWhatTheyCannotDo) {
  ParabolaFit fit;
  EXPECT_EQ(fit.Make("end_point/z=1"), nullptr);
  EXPECT_EQ(fit.error, "term end_point: z is given, but the data have dimension 2");
  const BsplineBasis closed = BasisOf(3, true, UniformKnots(3, 5, EndKnots::kPeriodic, 0.0, 2.0));
  fit.setting.basis = &closed;
  EXPECT_EQ(fit.Make("end_tangent"), nullptr);
  EXPECT_EQ(fit.error, "term end_tangent needs an open curve; a closed one has no ends");
  const BsplineBasis line = BasisOf(1, false, {0, 0, 1, 2, 2});
  fit.setting.basis = &line;
  EXPECT_EQ(fit.Make("end_curvature"), nullptr);
  EXPECT_EQ(fit.error, "term end_curvature needs degree 2 or more; found 1");
}

}  // namespace
}  // namespace batten
