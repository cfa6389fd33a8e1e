#include "cost_functions/curve_fairing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "tests/cost_functions/example_fit.h"

namespace batten {
namespace {

constexpr double kPi = 3.14159265358979323846;

std::unique_ptr<BlockFamily> MakeCurveFairing(const FitSetting& setting, const std::string& options,
                                              std::string* error) {
  NameSpec spec;
  const Term* term = nullptr;
  OptionValues values;
  EXPECT_TRUE(ParseNameSpec("curve_fairing" + options, &spec, error)) << *error;
  EXPECT_TRUE(TermRegistry::Global().Resolve(spec, &term, &values, error)) << *error;
  return term->MakeFamily(setting, values, error);
}

/// Control points of the curve whose coordinates are the polynomials sum_k c_k t^k: the blossom at
/// the p knots behind each, elementary symmetric sums over their number of products.
Eigen::VectorXd PolynomialCurve(const BsplineBasis& basis,
                                const std::vector<std::vector<double>>& coordinates) {
  const int p = basis.degree(), n = basis.num_control_points();
  const auto d = static_cast<int>(coordinates.size());
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n * d);
  for (int j = 0; j < n; ++j) {
    std::vector<double> symmetric(static_cast<std::size_t>(p) + 1, 0.0);
    symmetric[0] = 1.0;
    for (int i = 1; i <= p; ++i) {
      for (int k = i; k >= 1; --k) symmetric[k] += symmetric[k - 1] * basis.knots()[j + i];
    }
    for (int c = 0; c < d; ++c) {
      double products = 1.0;  // p over k
      for (std::size_t k = 0; k < coordinates[c].size(); ++k) {
        x[j * d + c] += coordinates[c][k] * symmetric[k] / products;
        products *= (p - static_cast<double>(k)) / (static_cast<double>(k) + 1.0);
      }
    }
  }
  return x;
}

struct FairedPolynomial {
  int degree = 3;
  int spans = 1;
  double begin = 0.0, end = 1.0;
  std::string options;
};

/// The term's energy of a polynomial curve on uniform knots, the data of size 1.
double EnergyOf(const FairedPolynomial& fit, const std::vector<std::vector<double>>& coordinates) {
  const BsplineBasis basis = BasisOf(fit.degree, false,
                                     UniformKnots(fit.degree, fit.degree + fit.spans,
                                                  EndKnots::kEndInterpolating, fit.begin, fit.end));
  FitSetting setting;
  setting.basis = &basis;
  setting.dimension = static_cast<int>(coordinates.size());
  std::string error;
  const auto family = MakeCurveFairing(setting, fit.options, &error);
  EXPECT_NE(family, nullptr) << error;
  return EnergyAt(*family, PolynomialCurve(basis, coordinates));
}

/// Of y = t^2 / 2, x = t from 0 to t, with s = t / sqrt(1 + t^2): kappa = (1 + t^2)^(-3/2), so that
/// kappa^2 ds = (1 - s^2) ds and (d kappa / ds)^2 ds = 9 s^2 (1 - s^2)^3 ds.
double ParabolaPrimitive(bool variation, double t) {
  const double s = t / std::sqrt(1.0 + t * t);
  if (!variation) return s - std::pow(s, 3) / 3.0;
  return 9.0 * (std::pow(s, 3) / 3.0 - 3.0 * std::pow(s, 5) / 5.0 + 3.0 * std::pow(s, 7) / 7.0 -
                std::pow(s, 9) / 9.0);
}

constexpr double kBegin = -0.4, kEnd = 1.3;
double Parabola(bool variation) {
  return ParabolaPrimitive(variation, kEnd) - ParabolaPrimitive(variation, kBegin);
}

std::string Measure(bool variation) {
  return variation ? "/measure=variation" : "/measure=bending";
}

TEST(CurveFairing, OfAParabolaIsItsClosedForm) {
  for (const bool variation : {false, true}) {
    for (const int degree : {3, 4, 7}) {
      // Many points of the rule leave rounding only: of second and third differences of control
      // points, which grow with the number of spans.
      const FairedPolynomial fit = {degree, 4, kBegin, kEnd, Measure(variation) + "/points=24"};
      EXPECT_NEAR(EnergyOf(fit, {{0, 1}, {0, 0, 0.5}}), Parabola(variation), 1e-11)
          << degree << variation;
    }
  }
  EXPECT_NEAR(EnergyOf({2, 4, kBegin, kEnd, "/points=24"}, {{0, 1}, {0, 0, 0.5}}), Parabola(false),
              1e-12);
}

TEST(CurveFairing, OfTheRuleConvergesWithTwiceTheNumberOfItsPoints) {
  for (const bool variation : {false, true}) {
    for (const int points : {1, 2, 3, 4}) {
      const auto error = [&](int spans) {
        const FairedPolynomial fit = {3, spans, kBegin, kEnd,
                                      Measure(variation) + "/points=" + std::to_string(points)};
        return std::abs(EnergyOf(fit, {{0, 1}, {0, 0, 0.5}}) - Parabola(variation));
      };
      // Spans short enough for the order to show, and not so short that rounding does.
      const int spans = points <= 2 ? 32 : 8;
      EXPECT_NEAR(std::log2(error(spans) / error(2 * spans)), 2.0 * points, 0.4)
          << variation << points;
    }
    // The accuracy that the page states for the default.
    const double of_default =
        EnergyOf({3, 8, kBegin, kEnd, Measure(variation)}, {{0, 1}, {0, 0, 0.5}}) -
        Parabola(variation);
    EXPECT_LT(std::abs(of_default), variation ? 2e-9 : 1e-10);
  }
}

TEST(CurveFairing, DoesNotDependOnTheParameter) {
  // t = v + v^2 / 4 from v = 0 to 1: the same stretch of the parabola, of degree 4 in v.
  for (const bool variation : {false, true}) {
    const double expected = ParabolaPrimitive(variation, 1.25) - ParabolaPrimitive(variation, 0.0);
    const std::vector<std::vector<double>> curve = {{0, 1, 0.25}, {0, 0, 0.5, 0.25, 0.03125}};
    const std::string options = Measure(variation) + "/points=24";
    EXPECT_NEAR(EnergyOf({4, 3, 0.0, 1.0, options}, curve), expected, 1e-11);
    EXPECT_NEAR(EnergyOf({6, 2, 0.0, 1.0, options}, curve), expected, 1e-10);
  }
}

TEST(CurveFairing, OfATwistedCubicIsItsKnownIntegral) {
  // By hand: |a|^2 = 1 + 4 t^2 + 9 t^4 for (t, t^2, t^3); Simpson's rule, in Python:
  //   def cross(a,b): return (a[1]*b[2]-a[2]*b[1], a[2]*b[0]-a[0]*b[2], a[0]*b[1]-a[1]*b[0])
  //   def f(t, variation):
  //       a,b,c=(1,2*t,3*t*t),(0,2,6*t),(0,0,6); q=1+4*t*t+9*t**4; ab=4*t+18*t**3
  //       if not variation: return sum(k*k for k in cross(a,b))/q**2.5
  //       m=[q*u-3*ab*v for u,v in zip(cross(a,c),cross(a,b))]; return sum(k*k for k in m)/q**5.5
  //   n=4000; h=1/n; w=lambda i: 1 if i in (0,n) else 4 if i%2 else 2
  //   sum(w(i)*f(i*h,v) for i in range(n+1))*h/3  for v in (False, True)
  const std::vector<std::vector<double>> curve = {{0, 1}, {0, 0, 1}, {0, 0, 0, 1}};
  EXPECT_NEAR(EnergyOf({3, 6, 0.0, 1.0, "/points=24"}, curve), 1.8284269633113872, 1e-10);
  EXPECT_NEAR(EnergyOf({3, 6, 0.0, 1.0, "/points=24/measure=variation"}, curve), 10.725750898712306,
              1e-9);
}

/// A closed spline with n control points on a circle is a circle too but for its other frequencies,
/// which are (1 / n)^(p + 1) of it: its radius is that of the points times sinc(pi / n)^(p + 1).
struct NearCircle {
  NearCircle(int dimension, double radius)
      : basis(BasisOf(9, true, UniformKnots(9, 32, EndKnots::kPeriodic, 0.0, 2.0))) {
    const double half = kPi / 32;
    const double of_points = radius / std::pow(std::sin(half) / half, 10);
    x.resize(32 * dimension);
    for (int j = 0; j < 32; ++j) {
      const double cosine = of_points * std::cos(2 * half * j);
      const double sine = of_points * std::sin(2 * half * j);
      // In space in a plane that is no coordinate plane: axes (0.6, 0.8, 0) and (-0.64, 0.48, 0.6).
      const double place[] = {0.6 * cosine - 0.64 * sine, 0.8 * cosine + 0.48 * sine, 0.6 * sine};
      for (int c = 0; c < dimension; ++c) {
        x[j * dimension + c] = dimension == 2 ? (c == 0 ? cosine : sine) : place[c];
      }
    }
    setting.basis = &basis;
    setting.dimension = dimension;
  }
  BsplineBasis basis;
  FitSetting setting;
  Eigen::VectorXd x;
};

TEST(CurveFairing, OfACircleIsTwoPiOverItsRadiusAndCurvatureDoesNotVary) {
  std::string error;
  for (const int dimension : {2, 3}) {
    for (const double radius : {0.3, 1.7}) {
      const NearCircle circle(dimension, radius);
      const auto bending = MakeCurveFairing(circle.setting, "", &error);
      const auto variation = MakeCurveFairing(circle.setting, "/measure=variation", &error);
      ASSERT_NE(bending, nullptr) << error;
      // 32^-10 of other frequencies, 31^2 times as much in the curvature: 1e-12.
      EXPECT_NEAR(EnergyAt(*bending, circle.x) * radius, 2.0 * kPi, 1e-10);
      // Squares of 31^3 * 32^-10 and of roundings.
      EXPECT_NEAR(EnergyAt(*variation, circle.x) * std::pow(radius, 3), 0.0, 1e-15);
    }
  }
}

TEST(CurveFairing, KeepsTheLawsOfRotationAndScale) {
  std::mt19937 random(20250501);
  std::string error;
  for (const bool variation : {false, true}) {
    const ExampleFit fit(MakeBasis({3, EndKnots::kPeriodic, false}, 12, &random), 3, 9, false,
                         &random);
    const auto family = MakeCurveFairing(fit.setting, Measure(variation), &error);
    const Eigen::VectorXd x = fit.RoundVariables(&random);
    const double energy = EnergyAt(*family, x);
    const auto moved = [&](const Eigen::Matrix3d& matrix) {
      Eigen::VectorXd y = x;
      for (int j = 0; j < 12; ++j) {
        y.segment<3>(ExampleFit::kOffset + 3 * j) =
            matrix * x.segment<3>(ExampleFit::kOffset + 3 * j) + Eigen::Vector3d(3, -1, 2);
      }
      return EnergyAt(*family, y);
    };
    const Eigen::Matrix3d rotation =
        Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -0.5).normalized()).toRotationMatrix();
    EXPECT_NEAR(moved(rotation), energy, 1e-11 * energy);
    EXPECT_NEAR(moved(2.5 * rotation) * std::pow(2.5, variation ? 3 : 1), energy, 1e-11 * energy);
  }
}

TEST(CurveFairing, TimesThePowerOfTheDatasSizeIsASquaredLength) {
  const BsplineBasis basis =
      BasisOf(3, false, UniformKnots(3, 7, EndKnots::kEndInterpolating, kBegin, kEnd));
  const Eigen::VectorXd x = PolynomialCurve(basis, {{0, 1}, {0, 0, 0.5}});
  FitSetting setting;
  setting.basis = &basis;
  setting.dimension = 2;
  setting.size = 0.75;
  setting.scale = 0.25;
  std::string error;
  for (const bool variation : {false, true}) {
    const int power = variation ? 5 : 3;
    const std::string options = Measure(variation) + "/points=24";
    EXPECT_NEAR(EnergyAt(*MakeCurveFairing(setting, options, &error), x),
                std::pow(0.75, power) * Parabola(variation), 1e-11);
    // In the user's units, where lengths are 4 times as large and E 16 times: the integral itself.
    EXPECT_NEAR(16.0 * EnergyAt(*MakeCurveFairing(setting, options + "/units=source", &error), x),
                Parabola(variation) / std::pow(4.0, power - 2), 1e-11);
  }
}

TEST(CurveFairing, HasNoNumberWhereTheCurveStandsStill) {
  const BsplineBasis basis =
      BasisOf(3, false, UniformKnots(3, 6, EndKnots::kEndInterpolating, 0.0, 1.0));
  FitSetting setting;
  setting.basis = &basis;
  setting.dimension = 2;
  std::string error;
  const auto family = MakeCurveFairing(setting, "", &error);
  const Eigen::VectorXd point = Eigen::VectorXd::Constant(12, 0.25);
  double energy = 0.0;
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(12);
  EXPECT_EQ(family->Evaluate(point, 0, family->size(), &energy, nullptr), Status::kNonFinite);
  EXPECT_EQ(family->Evaluate(point, 0, family->size(), &energy, &gradient), Status::kNonFinite);
}

TEST(CurveFairing, RefusesCurvesWithoutCurvature) {
  std::string error;
  const auto why = [&error](int degree, bool closed, int n, int dimension,
                            const std::string& options) {
    const EndKnots ends = closed ? EndKnots::kPeriodic : EndKnots::kEndInterpolating;
    const BsplineBasis basis = BasisOf(degree, closed, UniformKnots(degree, n, ends, 0.0, 1.0));
    FitSetting setting;
    setting.basis = &basis;
    setting.dimension = dimension;
    EXPECT_EQ(MakeCurveFairing(setting, options, &error), nullptr);
    return error;
  };
  EXPECT_EQ(why(3, false, 6, 1, ""),
            "term curve_fairing needs data of dimension 2 or more; a line has no curvature");
  EXPECT_EQ(why(1, false, 6, 2, ""),
            "term curve_fairing of measure bending needs degree 2 or more, else curvature is "
            "infinite at the knots; found 1");
  EXPECT_EQ(why(2, false, 6, 2, "/measure=variation"),
            "term curve_fairing of measure variation needs degree 3 or more, else curvature jumps "
            "at the knots; found 2");
  EXPECT_EQ(why(3, true, 2, 2, ""),
            "term curve_fairing needs 3 control points of a closed curve, else it turns back on "
            "itself; found 2");
}

}  // namespace
}  // namespace batten
