#ifndef BATTEN_TESTS_SPLINES_EXAMPLE_SPLINES_H_
#define BATTEN_TESTS_SPLINES_EXAMPLE_SPLINES_H_

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <ostream>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "splines/bspline_curve.h"
#include "splines/knot_rules.h"
#include "tests/roundoff.h"

namespace batten {

/// Not std::uniform_real_distribution, whose numbers differ between standard libraries.
inline double RandomBetween(double low, double high, std::mt19937* random) {
  return low + (high - low) * ((*random)() / 4294967296.0);
}

inline Points RandomPoints(int rows, int dimension, std::mt19937* random) {
  Points points(rows, dimension);
  for (int i = 0; i < rows; ++i) {
    for (int c = 0; c < dimension; ++c) points(i, c) = RandomBetween(-1.0, 1.0, random);
  }
  return points;
}

inline Points PointsOf(const std::vector<std::vector<double>>& rows) {
  Points points(rows.size(), rows.empty() ? 0 : rows[0].size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t c = 0; c < rows[i].size(); ++c) points(i, c) = rows[i][c];
  }
  return points;
}

/// The basis on knots that are known to be good.
inline BsplineBasis BasisOf(int degree, bool periodic, const std::vector<double>& knots) {
  std::string error;
  std::optional<BsplineBasis> basis = BsplineBasis::Make(degree, periodic, knots, &error);
  EXPECT_TRUE(basis.has_value()) << error;
  return basis.value();
}

/// One kind of spline for the tests that run on all of them.
struct SplineKind {
  int degree;
  EndKnots ends;
  bool uniform;

  bool periodic() const { return ends == EndKnots::kPeriodic; }
  std::string Name() const {
    const char* const end_names[] = {"EndInterpolating", "Floating", "Periodic"};
    return end_names[static_cast<int>(ends)] + std::string(uniform ? "Uniform" : "Random") +
           "Degree" + std::to_string(degree);
  }
};

inline std::string NameOf(const ::testing::TestParamInfo<SplineKind>& info) {
  return info.param.Name();
}
inline void PrintTo(const SplineKind& kind, std::ostream* stream) { *stream << kind.Name(); }

inline std::vector<SplineKind> AllSplineKinds() {
  std::vector<SplineKind> kinds;
  for (int p = 1; p <= kMaxDegree; ++p) {
    for (const EndKnots ends :
         {EndKnots::kEndInterpolating, EndKnots::kFloating, EndKnots::kPeriodic}) {
      for (const bool uniform : {true, false}) kinds.push_back({p, ends, uniform});
    }
  }
  return kinds;
}

/// Numbers of control points from the fewest on; periodic ones also n <= p and n < 2p + 1, where
/// the basis wraps onto itself.
inline std::set<int> SizesOf(const SplineKind& kind) {
  const int p = kind.degree;
  if (kind.periodic()) return {1, 2, p, p + 1, 2 * p, 2 * p + 5};
  return {p + 1, p + 2, p + 9};
}

/// Random spans are 0.3 to 1.7 long; where degree and size allow, one inner knot is double.
inline BsplineBasis MakeBasis(const SplineKind& kind, int n, std::mt19937* random) {
  const int p = kind.degree;
  std::vector<double> knots;
  if (kind.uniform) {
    knots = UniformKnots(p, n, kind.ends, -0.4, 1.7);
  } else {
    const int num_spans = kind.periodic() ? n : n - p;
    std::vector<double> steps(num_spans + 2 * p);
    for (double& step : steps) step = RandomBetween(0.3, 1.7, random);
    if (p >= 2 && num_spans >= 4) steps[p + 2] = 0.0;
    for (int i = 0; i < p; ++i) {
      if (kind.ends == EndKnots::kEndInterpolating) steps[i] = steps[num_spans + p + i] = 0.0;
    }
    if (kind.periodic()) {
      // Before and behind the n steps of one turn, the same ones again.
      for (int i = p - 1; i >= 0; --i) steps[i] = steps[i + num_spans];
      for (int i = num_spans + p; i < num_spans + 2 * p; ++i) steps[i] = steps[i - num_spans];
    }
    knots.push_back(-1.3);
    for (const double step : steps) knots.push_back(knots.back() + step);
  }
  return BasisOf(p, kind.periodic(), knots);
}

inline std::vector<BsplineBasis> MakeBases(const SplineKind& kind, std::mt19937* random) {
  std::vector<BsplineBasis> bases;
  for (const int n : SizesOf(kind)) bases.push_back(MakeBasis(kind, n, random));
  return bases;
}

inline std::vector<int> NonEmptySpans(const BsplineBasis& basis) {
  std::vector<int> spans;
  for (int k = basis.first_span(); k <= basis.last_span(); ++k) {
    if (basis.knots()[k] < basis.knots()[k + 1]) spans.push_back(k);
  }
  return spans;
}

/// The parameter at a fraction of a span, 0 its first knot.
inline double InSpan(const BsplineBasis& basis, int span, double fraction) {
  const double begin = basis.knots()[span];
  const double end = basis.knots()[span + 1];
  return std::min(begin + fraction * (end - begin), end);
}

inline double RandomParameter(const BsplineBasis& basis, std::mt19937* random) {
  return RandomBetween(basis.domain_begin(), basis.domain_end(), random);
}

/// N_(i,p)(t) by the recursive definition (Piegl & Tiller, eq. 2.5, 0 / 0 = 0), slow and plain.
inline long double BasisByDefinition(const std::vector<double>& u, int i, int p, long double t) {
  if (p == 0) return u[i] <= t && t < u[i + 1] ? 1.0L : 0.0L;
  const long double rise = static_cast<long double>(u[i + p]) - u[i];
  const long double fall = static_cast<long double>(u[i + p + 1]) - u[i + 1];
  long double sum = 0.0L;
  if (rise > 0.0L) sum += (t - u[i]) / rise * BasisByDefinition(u, i, p - 1, t);
  if (fall > 0.0L) sum += (u[i + p + 1] - t) / fall * BasisByDefinition(u, i + 1, p - 1, t);
  return sum;
}

}  // namespace batten

#endif  // BATTEN_TESTS_SPLINES_EXAMPLE_SPLINES_H_
