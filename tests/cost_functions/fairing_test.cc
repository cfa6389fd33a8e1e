#include "cost_functions/fairing.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "tests/cost_functions/example_fit.h"

namespace batten {
namespace {

using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

/// Integrals and, where functions that wrap around cancel, the size of what they are sums of.
struct Gram {
  explicit Gram(int n) : entries(LongMatrix::Zero(n, n)) {}
  void Add(int i, int j, long double part) {
    entries(i, j) += part;
    if (i == j) size = std::max(size, std::abs(part));
  }
  LongMatrix entries;
  long double size = 0.0L;
};

std::unique_ptr<BlockFamily> MakeFairing(const FitSetting& setting, const std::string& options,
                                         std::string* error) {
  NameSpec spec;
  const Term* term = nullptr;
  OptionValues values;
  EXPECT_TRUE(ParseNameSpec("fairing" + options, &spec, error)) << *error;
  EXPECT_TRUE(TermRegistry::Global().Resolve(spec, &term, &values, error)) << *error;
  return term->MakeFamily(setting, values, error);
}

FitSetting SettingOf(const BsplineBasis& basis, int dimension) {
  FitSetting setting;
  setting.basis = &basis;
  setting.dimension = dimension;
  return setting;
}

/// N^(k)_(i,p)(t) by the recurrence of derivatives (Piegl & Tiller, eq. 2.7), 0 / 0 = 0.
long double DerivativeByDefinition(const std::vector<double>& u, int i, int p, int k,
                                   long double t) {
  if (k > p) return 0.0L;
  if (k == 0) return BasisByDefinition(u, i, p, t);
  const long double rise = static_cast<long double>(u[i + p]) - u[i];
  const long double fall = static_cast<long double>(u[i + p + 1]) - u[i + 1];
  long double sum = 0.0L;
  if (rise > 0.0L) sum += p / rise * DerivativeByDefinition(u, i, p - 1, k - 1, t);
  if (fall > 0.0L) sum -= p / fall * DerivativeByDefinition(u, i + 1, p - 1, k - 1, t);
  return sum;
}

/// integral of N_i^(k) N_j^(k), every pair: span by span from the Taylor polynomials around the
/// span's middle, whose coefficients the recurrence gives. No quadrature.
Gram GramByDefinition(const BsplineBasis& basis, int k) {
  const int p = basis.degree(), n = basis.num_control_points();
  Gram gram(n);
  for (const int span : NonEmptySpans(basis)) {
    const long double begin = basis.knots()[span];
    const long double half = (basis.knots()[span + 1] - begin) / 2.0L;
    std::vector<std::array<long double, kMaxOrder>> taylor(static_cast<std::size_t>(p) + 1);
    for (int j = 0; j <= p; ++j) {
      long double factor = 1.0L;  // half^a / a!
      for (int a = 0; a <= p - k; ++a) {
        taylor[j][a] =
            factor * DerivativeByDefinition(basis.knots(), span - p + j, p, k + a, begin + half);
        factor *= half / (a + 1);
      }
    }
    for (int i = 0; i <= p; ++i) {
      for (int j = 0; j <= p; ++j) {
        long double sum = 0.0L;
        for (int a = 0; a <= p - k; ++a) {
          for (int b = a % 2; b <= p - k; b += 2) {
            sum += taylor[i][a] * taylor[j][b] * 2.0L * half / (a + b + 1);
          }
        }
        gram.Add(basis.ControlPointIndex(span - p + i), basis.ControlPointIndex(span - p + j), sum);
      }
    }
  }
  return gram;
}

/// The source's closed form for cubics: N'' is linear in each span, and the integral of a product
/// of two linear functions is a quadratic form in their values at the span's ends.
Gram CubicGramInClosedForm(const BsplineBasis& basis) {
  const int n = basis.num_control_points();
  const std::vector<double>& u = basis.knots();
  Gram gram(n);
  // N''_i on span s: 6 times hats over products of knot differences, s - 3 <= i <= s.
  const auto at_end = [&u](int i, int s, bool right) {
    const auto hat = [&](int j) {  // N_(j,1) at an end of span s
      return (j == s - 1 && !right) || (j == s && right) ? 1.0L : 0.0L;
    };
    const auto over = [&](long double value, int first, int last) {
      const long double length = static_cast<long double>(u[last]) - u[first];
      return length > 0.0L ? value / length : 0.0L;
    };
    const long double rise = over(hat(i), i, i + 2) - over(hat(i + 1), i + 1, i + 3);
    const long double fall = over(hat(i + 1), i + 1, i + 3) - over(hat(i + 2), i + 2, i + 4);
    return 6.0L * (over(rise, i, i + 3) - over(fall, i + 1, i + 4));
  };
  for (const int s : NonEmptySpans(basis)) {
    const long double length = static_cast<long double>(u[s + 1]) - u[s];
    for (int i = s - 3; i <= s; ++i) {
      for (int j = s - 3; j <= s; ++j) {
        const long double a = at_end(i, s, false), b = at_end(i, s, true);
        const long double c = at_end(j, s, false), d = at_end(j, s, true);
        gram.Add(basis.ControlPointIndex(i), basis.ControlPointIndex(j),
                 length / 6.0L * (2.0L * a * c + a * d + b * c + 2.0L * b * d));
      }
    }
  }
  return gram;
}

/// The rows' A'A against the integrals. A value of N^(k) is k differences of numbers up to 2^k
/// times as large, each step and each of its p - k recursions a few roundings; both factors of an
/// entry carry them.
void ExpectGram(const BlockFamily& family, const BsplineBasis& basis, int k, double factor,
                const Gram& gram) {
  ASSERT_NE(family.rows(), nullptr);
  const DenseRows rows(*family.rows());
  EXPECT_TRUE(rows.right_hand_sides.isZero(0.0));
  const Eigen::MatrixXd ours = rows.matrix.transpose() * rows.matrix;
  const double size = static_cast<double>(gram.size) * factor;
  const double tolerance = 4.0 * (basis.degree() + k) * std::exp2(k) * kEpsilon * size;
  for (Eigen::Index i = 0; i < ours.rows(); ++i) {
    for (Eigen::Index j = 0; j < ours.cols(); ++j) {
      EXPECT_NEAR(ours(i, j), static_cast<double>(gram.entries(i, j)) * factor, tolerance)
          << i << ", " << j;
    }
  }
}

class EverySplineFairing : public ::testing::TestWithParam<SplineKind> {};

TEST_P(EverySplineFairing, IsTheIntegralOfTheSquaredDerivative) {
  std::mt19937 random(20250311);
  std::string error;
  for (const BsplineBasis& basis : MakeBases(GetParam(), &random)) {
    for (int k = 1; k <= std::min(3, basis.degree()); ++k) {
      SCOPED_TRACE("n = " + std::to_string(basis.num_control_points()) +
                   " k = " + std::to_string(k));
      const std::string options = "/derivative=" + std::to_string(k);
      const FitSetting setting = SettingOf(basis, 2);
      const Gram gram = GramByDefinition(basis, k);
      const auto source = MakeFairing(setting, options + "/units=source", &error);
      const auto scale_free = MakeFairing(setting, options, &error);
      ASSERT_NE(source, nullptr) << error;
      ASSERT_NE(scale_free, nullptr) << error;
      ExpectGram(*source, basis, k, 1.0, gram);
      ExpectGram(*scale_free, basis, k, std::pow(basis.domain_length(), 2 * k - 1), gram);
      EXPECT_EQ(source->size() % (basis.degree() - k + 1), 0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Splines, EverySplineFairing, ::testing::ValuesIn(AllSplineKinds()),
                         NameOf);

TEST(Fairing, OfCubicsIsTheClosedFormOfLinearPieces) {
  std::mt19937 random(20250312);
  std::string error;
  for (const EndKnots ends :
       {EndKnots::kEndInterpolating, EndKnots::kFloating, EndKnots::kPeriodic}) {
    for (const bool uniform : {true, false}) {
      const SplineKind kind = {3, ends, uniform};
      for (const BsplineBasis& basis : MakeBases(kind, &random)) {
        SCOPED_TRACE(kind.Name());
        const auto family = MakeFairing(SettingOf(basis, 1), "/units=source", &error);
        ASSERT_NE(family, nullptr) << error;
        ExpectGram(*family, basis, 2, 1.0, CubicGramInClosedForm(basis));
      }
    }
  }
}

TEST(Fairing, OfUniformCubicsHasTheKnownNumbers) {
  // Knots 0, 1, 2, ...: W is a band of 8/3, -3/2, 0, 1/6 away from the ends.
  const BsplineBasis basis = BasisOf(3, true, UniformKnots(3, 9, EndKnots::kPeriodic, 0.0, 9.0));
  std::string error;
  const auto family = MakeFairing(SettingOf(basis, 1), "/units=source", &error);
  const DenseRows rows(*family->rows());
  const Eigen::MatrixXd gram = rows.matrix.transpose() * rows.matrix;
  const double known[] = {8.0 / 3.0, -3.0 / 2.0, 0.0, 1.0 / 6.0, 0.0};
  const double tolerance = 32 * kEpsilon;  // sums of four squares of values up to 2
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 9; ++j) {
      const int apart = std::min((i - j + 9) % 9, (j - i + 9) % 9);
      EXPECT_NEAR(gram(i, j), known[apart], tolerance);
    }
  }
}

TEST(Fairing, DoesNotSeeHowLongTheDomainIsUnlessAsked) {
  std::string error;
  Eigen::VectorXd x(8);
  x << 0.3, -0.7, 0.2, 0.9, -0.4, 0.1, 0.6, -0.8;
  for (int k = 1; k <= 3; ++k) {
    const std::string options = "/derivative=" + std::to_string(k);
    const auto energy = [&](double begin, double end, const std::string& units) {
      const BsplineBasis basis =
          BasisOf(3, false, UniformKnots(3, 8, EndKnots::kEndInterpolating, begin, end));
      const auto family = MakeFairing(SettingOf(basis, 1), options + units, &error);
      return EnergyAt(*family, x);
    };
    const double unit = energy(0.0, 1.0, "");
    EXPECT_EQ(energy(0.0, 1.0, "/units=source"), unit);
    // A few roundings in each knot, which differences of knots near 3 carry 3 / 0.04 times.
    EXPECT_NEAR(energy(3.0, 3.2, ""), unit, 1e4 * kEpsilon * unit);
    EXPECT_NEAR(energy(-40.0, 60.0, ""), unit, 1e3 * kEpsilon * unit);
    EXPECT_NEAR(energy(0.0, 4.0, "/units=source") * std::pow(4.0, 2 * k - 1), unit,
                64 * kEpsilon * unit);
  }
}

TEST(Fairing, OfAParabolaIsItsSquaredSecondDerivativeTimesTheLength) {
  // C(t) = 3 t^2 on [0, 2] of degree 2: C'' = 6, integral 72; control points by blossoming.
  const BsplineBasis basis = BasisOf(2, false, {0, 0, 0, 0.5, 1.25, 2, 2, 2});
  Eigen::VectorXd x(5);
  for (int j = 0; j < 5; ++j) x[j] = 3.0 * basis.knots()[j + 1] * basis.knots()[j + 2];
  std::string error;
  const auto family = MakeFairing(SettingOf(basis, 1), "/units=source/weight=0.5", &error);
  EXPECT_NEAR(EnergyAt(*family, x), 36.0, 36.0 * 64 * kEpsilon);
}

TEST(Fairing, RefusesADerivativeThatIsZero) {
  const BsplineBasis basis =
      BasisOf(2, false, UniformKnots(2, 6, EndKnots::kEndInterpolating, 0.0, 1.0));
  std::string error;
  EXPECT_EQ(MakeFairing(SettingOf(basis, 2), "/derivative=3", &error), nullptr);
  EXPECT_EQ(error,
            "term fairing: derivative is 3, but that of a curve of degree 2 is zero; allowed: "
            "1 to 2");
}

TEST(Fairing, RefusesDomainsWhosePowersAreNoNumbers) {
  const BsplineBasis basis =
      BasisOf(3, false, UniformKnots(3, 6, EndKnots::kEndInterpolating, 0.0, 1e-120));
  std::string error;
  EXPECT_EQ(MakeFairing(SettingOf(basis, 2), "/derivative=3", &error), nullptr);
  EXPECT_EQ(error,
            "term fairing: derivative 3 over a domain of length 1e-120 leaves the range of "
            "numbers; divide the parameters and knots by its length");
}

}  // namespace
}  // namespace batten
