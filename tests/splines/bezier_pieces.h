#ifndef BATTEN_TESTS_SPLINES_BEZIER_PIECES_H_
#define BATTEN_TESTS_SPLINES_BEZIER_PIECES_H_

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "splines/bezier_distance.h"
#include "splines/bezier_hull.h"
#include "splines/bezier_measures.h"
#include "splines/bezier_subdivision.h"
#include "tests/splines/example_splines.h"

namespace batten {

/// Curves on which something is zero, repeated, or as large as numbers are.
struct DegenerateCurve {
  const char* name;
  std::vector<std::vector<double>> points;
};
inline const DegenerateCurve kDegenerateCurves[] = {
    {"one_point", {{3, 4}}},
    {"a_segment", {{3, 4}, {5, 6}}},
    {"all_equal", {{3, 4}, {3, 4}, {3, 4}, {3, 4}}},
    {"all_zero", {{0, 0}, {0, 0}, {0, 0}}},
    {"closed", {{0, 0}, {3, 1}, {-2, 4}, {0, 0}}},
    {"there_and_back", {{0, 0}, {1, 1}, {0, 0}}},
    {"straight", {{0, 0}, {1, 1}, {3, 3}, {4, 4}}},
    {"straight_with_overshoot", {{0, 0}, {9, 9}, {-5, -5}, {4, 4}}},
    {"cusp", {{0, 0}, {1, 1}, {0, 1}, {1, 0}}},
    {"repeated", {{0, 0}, {0, 0}, {0, 0}, {1, 2}, {3, 1}, {3, 1}, {3, 1}}},
    {"tiny_beside_huge", {{0, 0}, {1e-300, 1}, {1, 1e-300}, {1, 1}}},
    {"far_away", {{1e9, 1e9}, {1e9 + 1, 1e9 + 2}, {1e9 + 2, 1e9}}},
    {"huge", {{0, 0}, {1e300, 1e300}, {1e300, -1e300}, {-1e300, 5e299}}},
    {"largest", {{-1.7e308, 0}, {1.7e308, 1.7e308}, {1.7e308, -1.7e308}}},
    {"denormal", {{0, 0}, {5e-324, 1e-323}, {2e-320, 0}}},
    {"in_space", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}}},
};

inline BezierCurve CurveOf(const Points& points) {
  return BezierCurve::Make(points, nullptr).value();
}

inline DistanceBounds TrueErrorOf(const BezierCurve& curve, const Subdivision& result) {
  return BoundHausdorffDistance(
      curve,
      Eigen::Map<const Eigen::VectorXd>(result.parameters.data(),
                                        static_cast<Eigen::Index>(result.parameters.size())),
      result.vertices);
}

/// Certified: the tolerance of polygon or segment is kept, to what rounding adds in the rule and in
/// the certificate. In units in which nothing overflows.
inline void ExpectErrorWithin(double relative_tolerance, const BezierCurve& curve,
                              const Subdivision& result) {
  const int n = curve.degree(), d = curve.dimension();
  const double unit = UnitOf(curve.control_points());
  const Points scaled = curve.control_points() / unit;
  // Vertices that are denormal numbers are rounded to the smallest of these.
  const double denormal = 2 * std::numeric_limits<double>::denorm_min() / unit;
  const DistanceBounds bounds = TrueErrorOf(curve, result);
  EXPECT_LE(bounds.upper / unit, relative_tolerance * BoxSide(n, d, scaled.data()) + denormal +
                                     4 * BezierRounding(n, d, scaled.data()));
  EXPECT_LE(bounds.lower, bounds.upper);
}

/// The measure of a piece in the units of its tolerance, by the measures alone.
inline double MeasureOf(StopMeasure stop, int n, int d, const double* piece) {
  const auto quotient = [](const Quotient& q) { return q.numerator / q.denominator; };
  switch (stop) {
    case StopMeasure::kControlPoints:
      return std::sqrt(quotient(SquaredChordDistance(n, d, piece)));
    case StopMeasure::kPolygon:
      return std::sqrt(quotient(SquaredPolygonDistance(n, d, piece)));
    case StopMeasure::kHullArea:
      return HullArea(n, piece);
    case StopMeasure::kFlatness:
      return quotient(Flatness(n, d, piece));
    case StopMeasure::kSegment:
      return BoundSegmentDistance(n, d, piece, piece, piece + n * d, 0.02, 0.0).lower;
    case StopMeasure::kAngle:
      break;
  }
  return std::atan(std::sqrt(SquaredLegSlope(n, d, piece, 0.0)));
}

/// Each piece, cut anew from the curve by its parameters, is within the tolerance. For tolerances
/// far above rounding: the two ways to a piece differ by some roundings.
inline void ExpectPiecesPass(const BezierCurve& curve, const SubdivisionOptions& options,
                             const Subdivision& result) {
  const int n = curve.degree(), d = curve.dimension();
  const double side = BoxSide(n, d, curve.control_points().data());
  const bool is_square =
      options.stop == StopMeasure::kHullArea || options.stop == StopMeasure::kFlatness;
  const double unit = options.stop == StopMeasure::kAngle ? 1.0 : is_square ? side * side : side;
  constexpr double kSlack = 1.0 + 1e-7;
  double worst = 0.0;
  for (int i = 0; i < result.num_pieces(); ++i) {
    const BezierCurve piece = curve.Part(result.parameters[i], result.parameters[i + 1]);
    worst = std::max(worst, MeasureOf(options.stop, n, d, piece.control_points().data()));
  }
  EXPECT_LE(worst, options.relative_tolerance * unit * kSlack) << ToString(options.stop);
}

/// From 0 to 1 without gap; pieces, if kept, begin and end in the vertices.
inline void ExpectCovers(const Subdivision& result, int degree) {
  const int k = result.num_pieces();
  ASSERT_EQ(result.vertices.rows(), k + 1);
  EXPECT_EQ(result.parameters.front(), 0.0);
  EXPECT_EQ(result.parameters.back(), 1.0);
  for (int i = 0; i < k; ++i) EXPECT_LT(result.parameters[i], result.parameters[i + 1]);
  if (result.pieces.rows() == 0) return;
  const int size = degree + 1;
  ASSERT_EQ(result.pieces.rows(), k * size);
  for (int i = 0; i < k; ++i) {
    EXPECT_EQ(result.pieces.row(size * i), result.vertices.row(i));
    EXPECT_EQ(result.pieces.row(size * i + degree), result.vertices.row(i + 1));
  }
}

/// de Casteljau's algorithm in long double.
inline std::array<long double, kMaxDimension> ExactPoint(const Points& points, long double t) {
  std::vector<long double> b(points.data(), points.data() + points.size());
  const auto d = static_cast<std::size_t>(points.cols());
  for (std::size_t size = b.size() - d; size > 0; size -= d) {
    for (std::size_t k = 0; k < size; ++k) b[k] = (1.0L - t) * b[k] + t * b[k + d];
  }
  std::array<long double, kMaxDimension> point{};
  std::copy(b.begin(), b.begin() + static_cast<std::ptrdiff_t>(d), point.begin());
  return point;
}

/// Some 200 pieces are compared with the curve at 5 parameters each. A rounding of the largest
/// coordinate is half an eps; the parameters of pieces are rounded once, which moves the point by
/// |C'| eps / 2.
inline void ExpectPiecesAreTheCurve(const BezierCurve& curve, const Subdivision& result,
                                    double roundings) {
  const int size = curve.degree() + 1, d = curve.dimension();
  ASSERT_EQ(result.pieces.rows(), result.num_pieces() * size);
  double worst = 0.0;
  for (int i = 0; i < result.num_pieces(); i += 1 + result.num_pieces() / 200) {
    const long double begin = result.parameters[i], end = result.parameters[i + 1];
    for (const double s : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      double point[kMaxDimension];
      EvaluateBezier(curve.degree(), d, result.pieces.data() + i * size * d, s, point);
      const auto exact = ExactPoint(curve.control_points(), begin + (end - begin) * s);
      for (int c = 0; c < d; ++c) {
        worst = std::max(worst, static_cast<double>(std::abs(point[c] - exact[c])));
      }
    }
  }
  EXPECT_LE(worst, roundings * kEpsilon / 2 * curve.control_points().cwiseAbs().maxCoeff());
}

}  // namespace batten

#endif  // BATTEN_TESTS_SPLINES_BEZIER_PIECES_H_
