#include "experiments/max_distance_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "experiments/audit_curve.h"
#include "experiments/curve_window.h"
#include "tests/experiments/outlines.h"

namespace batten {
namespace {

const SearchWatch kNoWatch = [](int, double) { return true; };

MaxDistanceFit Search(const DataSet& data, bool closed, int degree, double bound) {
  FitSpec spec;
  spec.closed = closed;
  spec.degree = degree;
  spec.parameters = Parameterization::kChordLength;
  MaxDistanceFit fit;
  std::string error;
  EXPECT_TRUE(FitWithinDistance(data, spec, bound, kNoWatch, &fit, &error)) << error;
  return fit;
}

int CountOf(const MaxDistanceFit& fit) {
  return fit.problem->curve_fit()->basis().num_control_points();
}

/// The largest distance by a route of its own: de Boor's recursion in long double, 100 samples a
/// span, golden sections around the nearest two of each point. Never below the true one.
long double LargestDistance(const MaxDistanceFit& fit, const Points& points) {
  const CurveFit& curve_fit = *fit.problem->curve_fit();
  const int d = curve_fit.dimension();
  AuditedFit plain;
  plain.degree = curve_fit.basis().degree();
  plain.periodic = curve_fit.basis().periodic();
  plain.dimension = d;
  plain.knots = curve_fit.basis().knots();
  const Points control_points = curve_fit.ControlPoints(fit.run.x);
  plain.control_points.assign(control_points.data(), control_points.data() + control_points.size());
  AuditCurve curve(plain);
  constexpr int kPerSpan = 100;
  std::vector<double> places;
  for (int k = curve_fit.basis().first_span(); k <= curve_fit.basis().last_span(); ++k) {
    const double a = plain.knots[static_cast<std::size_t>(k)];
    const double b = plain.knots[static_cast<std::size_t>(k) + 1];
    for (int s = 0; s < kPerSpan && a < b; ++s) places.push_back(a + (b - a) * s / kPerSpan);
  }
  places.push_back(static_cast<double>(curve.domain_end()));
  Points samples(static_cast<Eigen::Index>(places.size()), d);
  for (std::size_t s = 0; s < places.size(); ++s) {
    curve.MoveTo(places[s]);
    for (int c = 0; c < d; ++c) {
      samples(static_cast<Eigen::Index>(s), c) = static_cast<double>(curve.Coordinate(c));
    }
  }
  const auto distance = [&](Eigen::Index i, double t) {
    curve.MoveTo(t);
    long double sum = 0.0L;
    for (int c = 0; c < d; ++c) {
      const long double r = curve.Coordinate(c) - static_cast<long double>(points(i, c));
      sum += r * r;
    }
    return std::sqrt(sum);
  };
  const auto around = [&](Eigen::Index i, std::size_t nearest) {
    double low = places[nearest == 0 ? 0 : nearest - 1];
    double high = places[std::min(nearest + 1, places.size() - 1)];
    const double ratio = 0.5 * (std::sqrt(5.0) - 1.0);
    for (int step = 0; step < 40; ++step) {
      const double a = high - ratio * (high - low);
      const double b = low + ratio * (high - low);
      (distance(i, a) < distance(i, b) ? high : low) = distance(i, a) < distance(i, b) ? b : a;
    }
    return std::min({distance(i, 0.5 * (low + high)), distance(i, places[nearest])});
  };
  long double largest = 0.0L;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Eigen::VectorXd squared = (samples.rowwise() - points.row(i)).rowwise().squaredNorm();
    Eigen::Index nearest = 0;
    const double sampled = std::sqrt(squared.minCoeff(&nearest));
    if (sampled <= static_cast<double>(largest)) continue;
    // A second branch of the curve may be the nearer one.
    Eigen::VectorXd others = squared;
    const Eigen::Index first = std::max<Eigen::Index>(nearest - 3, 0);
    others.segment(first, std::min<Eigen::Index>(7, others.size() - first)).setConstant(1e300);
    Eigen::Index other = 0;
    others.minCoeff(&other);
    largest = std::max(largest, std::min(around(i, static_cast<std::size_t>(nearest)),
                                         around(i, static_cast<std::size_t>(other))));
  }
  return largest;
}

DataSet ReadPoints(const std::string& name) {
  std::string error;
  const auto data = ReadDataSet(BATTEN_SOURCE_DIR "/data/" + name, &error);
  EXPECT_TRUE(data.has_value()) << error;
  return *data;
}

/// `count` points at equal steps along the polyline.
DataSet Resampled(const DataSet& data, bool closed, int count) {
  Points corners = data.points;
  if (closed) {
    corners.conservativeResize(corners.rows() + 1, Eigen::NoChange);
    corners.bottomRows(1) = corners.topRows(1).eval();
  }
  std::vector<double> length = {0.0};
  for (Eigen::Index i = 1; i < corners.rows(); ++i) {
    length.push_back(length.back() + (corners.row(i) - corners.row(i - 1)).norm());
  }
  DataSet made;
  made.points.resize(count, corners.cols());
  std::size_t k = 1;
  for (int i = 0; i < count; ++i) {
    const double at = length.back() * i / (closed ? count : count - 1);
    while (k + 1 < length.size() && length[k] < at) ++k;
    const double share = (at - length[k - 1]) / (length[k] - length[k - 1]);
    const auto row = static_cast<Eigen::Index>(k);
    made.points.row(i) = (1.0 - share) * corners.row(row - 1) + share * corners.row(row);
  }
  return made;
}

struct RealCurve {
  const char* name;
  bool closed;
  double share;  // the bound over the size
};
void PrintTo(const RealCurve& curve, std::ostream* stream) { *stream << curve.name; }

class MaxDistanceOnRealCurves : public ::testing::TestWithParam<RealCurve> {};

TEST_P(MaxDistanceOnRealCurves, IsNeverAboveTheBoundAtTenThousandPoints) {
  const RealCurve real = GetParam();
  const DataSet data = Resampled(ReadPoints(real.name), real.closed, 10000);
  const double size = SizeOf(data.points);
  const double bound = real.share * size;
  const MaxDistanceFit fit = Search(data, real.closed, 3, bound);
  const auto largest = static_cast<double>(LargestDistance(fit, data.points));
  // What double coordinates of the control points round.
  const double rounding = 1e-14 * data.points.cwiseAbs().maxCoeff();
  EXPECT_LE(largest, bound + rounding);
  // The certificate: no point of the curve is nearer by more than 1e-12 of the size; golden
  // sections in double parameters find a distance to half their digits squared, all of it.
  EXPECT_NEAR(largest, fit.largest_distance, 1e-11 * size);
  EXPECT_LT(CountOf(fit), 200);
}

INSTANTIATE_TEST_SUITE_P(Data, MaxDistanceOnRealCurves,
                         ::testing::Values(RealCurve{"coasts/great_britain_10m.csv", true, 2e-2},
                                           RealCurve{"curves3d/gps_hike_xyz_open.csv", false, 1e-2},
                                           RealCurve{"animals/squirrel_2000.csv", true, 1e-3}),
                         [](const auto& curve) { return "Curve" + std::to_string(curve.index); });

/// Samples of a cubic with uneven knots, at places that are not its arc length.
DataSet SamplesOf(const BsplineCurve& curve, int count) {
  DataSet data;
  data.points.resize(count, curve.dimension());
  const BsplineBasis& basis = curve.basis();
  for (int i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / (basis.periodic() ? count : count - 1);
    const double t = basis.domain_begin() + share * basis.domain_length();
    curve.Evaluate(t, 0, data.points.row(i).data());
  }
  return data;
}

BsplineCurve KnownCurve(bool closed, int dimension) {
  std::vector<double> knots;
  if (closed) {
    const std::vector<double> turn = {0.0, 0.1, 0.25, 0.35, 0.55, 0.7, 0.8};
    for (int i = -3; i <= 10; ++i) {
      const int turns = i < 0 ? -1 : i / 7;
      knots.push_back(turn[static_cast<std::size_t>(i - 7 * turns)] + turns);
    }
  } else {
    knots = {0, 0, 0, 0, 0.2, 0.35, 0.6, 0.7, 1, 1, 1, 1};
  }
  auto basis = BsplineBasis::Make(3, closed, knots, nullptr);
  const int n = basis->num_control_points();
  Points control_points(n, dimension);
  for (int j = 0; j < n; ++j) {
    const double angle = closed ? 2.0 * M_PI * j / n : 0.55 * j;
    const double radius = 1.0 + 0.35 * std::cos(2.3 * j);
    control_points(j, 0) = closed ? radius * std::cos(angle) : 0.8 * j;
    control_points(j, 1) = radius * std::sin(closed ? angle : 2.0 * angle);
    if (dimension > 2) control_points(j, 2) = 0.3 * std::sin(1.7 * j);
  }
  return BsplineCurve(*basis, control_points);
}

class MaxDistanceOfKnownSpline : public ::testing::TestWithParam<std::tuple<int, double>> {};

TEST_P(MaxDistanceOfKnownSpline, NeedsNoMoreControlPointsWhereItIsClosed) {
  const auto& [dimension, share] = GetParam();
  const BsplineCurve truth = KnownCurve(true, dimension);
  const DataSet data = SamplesOf(truth, 400);
  const MaxDistanceFit fit = Search(data, true, 3, share * SizeOf(data.points));
  EXPECT_LE(CountOf(fit), truth.basis().num_control_points());
}

// Under sanitizers the tight bounds take minutes each, and go the same ways through the code.
#if defined(__SANITIZE_ADDRESS__)
constexpr double kShares[] = {1e-4};
#else
constexpr double kShares[] = {1e-4, 1e-6, 1e-8};
#endif
INSTANTIATE_TEST_SUITE_P(Cubic, MaxDistanceOfKnownSpline,
                         ::testing::Combine(::testing::Values(2, 3), ::testing::ValuesIn(kShares)));

TEST(MaxDistance, NeedsNoMoreControlPointsThanTheOpenSplineAtAModestBound) {
  // At smaller bounds the knots of this open curve settle in a local minimum
  // (docs/max_distance.md).
  for (const int dimension : {2, 3}) {
    const BsplineCurve truth = KnownCurve(false, dimension);
    const DataSet data = SamplesOf(truth, 400);
    const MaxDistanceFit fit = Search(data, false, 3, 1e-4 * SizeOf(data.points));
    EXPECT_LE(CountOf(fit), truth.basis().num_control_points()) << dimension;
  }
}

// The data of a cubic without inner knots, and one whose ends are off: there is nothing to move but
// them.
TEST(CurveWindow, OfAWholeOpenCurveMovesItsEnds) {
  const std::vector<double> knots = {0, 0, 0, 0, 0.3, 1, 1, 1, 1};
  const auto basis = BsplineBasis::Make(3, false, knots, nullptr);
  Points control_points(5, 2);
  control_points << 0, 0, 0.2, 0.5, 0.5, 0.1, 0.8, 0.6, 1, 0.2;
  const DataSet data = SamplesOf(BsplineCurve(*basis, control_points), 50);
  Eigen::VectorXd parameters = Eigen::VectorXd::LinSpaced(50, 0.0, 1.0);
  Points off = control_points;
  off.row(0) += Eigen::RowVector2d(-0.01, 0.02);
  off.row(4) += Eigen::RowVector2d(0.02, 0.01);
  TrackedCurve curve(BsplineCurve(*basis, off), data.points, parameters);
  curve.FollowAll(0);
  const double bound = 1e-9;
  CurveWindow all(&curve, bound, curve.first_free_knot(), curve.last_free_knot());
  EXPECT_TRUE(all.Lower(2, 40, 1.0));
  EXPECT_LE(curve.squared_distances().maxCoeff(), bound * bound);
  // The ends are held to those of the data.
  for (const int end : {0, 4}) {
    for (int c = 0; c < 2; ++c)
      EXPECT_NEAR(curve.ControlPoint(end)[c], control_points(end, c), bound);
  }
}

TEST(MaxDistance, FindsTheCornersOfAnOpenPolyline) {
  DataSet corners;
  corners.points.resize(5, 2);
  corners.points << 0, 0, 4, 0.5, 5, 3, 2, 2, 0.5, 3.5;
  const DataSet data = Resampled(corners, false, 400);
  for (const double bound : {1e-2, 1e-3, 1e-4}) {
    EXPECT_LE(CountOf(Search(data, false, 1, bound * 5.0)), 5) << bound;
  }
}

TEST(MaxDistance, FindsTheCornersOfAPolygon) {
  DataSet corners;
  corners.points.resize(5, 2);
  corners.points << 0, 0, 4, 0.5, 5, 3, 2, 2, 0.5, 3.5;
  const DataSet data = Resampled(corners, true, 400);
  // No sample is a corner; the line through its neighbours passes it within half a step.
  EXPECT_LE(CountOf(Search(data, true, 1, 1e-3 * 5.0)), 5);
}

/// Uniform closed cubics through a circle's regular n-gon, best radius: the deviation is largest
/// at knots, rho (2 + cos a) / 3, and half way, rho (23 cos(a / 2) + cos(3 a / 2)) / 24, a = 2 pi
/// / n; half their difference over their mean.
double DeviationOfUniformCubic(int n) {
  const double a = 2.0 * M_PI / n;
  const double knot = (2.0 + std::cos(a)) / 3.0;
  const double middle = (23.0 * std::cos(0.5 * a) + std::cos(1.5 * a)) / 24.0;
  return std::abs(knot - middle) / (knot + middle);
}

TEST(MaxDistance, NeedsNoMoreOnACircleThanUniformCubics) {
  DataSet circle;
  circle.points.resize(720, 2);
  for (int i = 0; i < 720; ++i) {
    circle.points(i, 0) = std::cos(M_PI * i / 360.0);
    circle.points(i, 1) = std::sin(M_PI * i / 360.0);
  }
  for (const double bound : {1e-2, 1e-3, 1e-4, 1e-5}) {
    int enough = 3;
    while (DeviationOfUniformCubic(enough) > bound) ++enough;
    EXPECT_LE(CountOf(Search(circle, true, 3, bound)), enough) << bound;
  }
}

TEST(MaxDistance, DoesNotChangeWithPlaceAndScale) {
  DataSet data = ReadPoints("animals/dolphin_80.csv");
  // Numbers with few digits, so that moving rounds nothing.
  data.points = (data.points.array() * 1024.0).round() / 1024.0;
  const double bound = std::ldexp(1.0, -8) * SizeOf(data.points);
  const MaxDistanceFit fit = Search(data, true, 3, bound);
  const double scale = std::ldexp(1.0, 40);
  DataSet scaled = data;
  scaled.points *= scale;
  const MaxDistanceFit larger = Search(scaled, true, 3, bound * scale);
  EXPECT_EQ(fit.problem->curve_fit()->basis().knots(),
            larger.problem->curve_fit()->basis().knots());
  EXPECT_EQ(fit.run.x, larger.run.x);
  EXPECT_EQ(fit.largest_distance * scale, larger.largest_distance);
  DataSet moved = data;
  moved.points.rowwise() += Eigen::RowVector2d(4096.0, -512.0);
  const MaxDistanceFit elsewhere = Search(moved, true, 3, bound);
  // The allowance for rounding grows with the coordinates: the search is the same but for that.
  EXPECT_EQ(CountOf(fit), CountOf(elsewhere));
}

TEST(MaxDistance, TakesRepeatedPointsAndThoseWithoutWeight) {
  DataSet data = ReadPoints("airfoils/naca2412_open.csv");
  const double bound = 1e-3;
  const MaxDistanceFit fit = Search(data, false, 3, bound);
  const Eigen::Index m = data.points.rows();
  DataSet more;
  more.points.resize(2 * m + 1, 2);
  more.weights = Eigen::VectorXd::Ones(2 * m + 1);
  for (Eigen::Index i = 0; i < m; ++i) {
    more.points.row(2 * i) = more.points.row(2 * i + 1) = data.points.row(i);
  }
  more.points.row(2 * m) << 7.0, 7.0;
  (*more.weights)[2 * m] = 0.0;
  const MaxDistanceFit same = Search(more, false, 3, bound);
  EXPECT_EQ(CountOf(fit), CountOf(same));
  EXPECT_LE(same.largest_distance, bound);
}

TEST(MaxDistance, RefusesWhatNoCurveCanKeep) {
  FitSpec spec;
  spec.parameters = Parameterization::kChordLength;
  DataSet data = ReadPoints("airfoils/naca2412_open.csv");
  MaxDistanceFit fit;
  std::string error;
  EXPECT_FALSE(FitWithinDistance(data, spec, 1e-17, kNoWatch, &fit, &error));
  EXPECT_NE(error.find("rounding"), std::string::npos) << error;
  data.points.rowwise() = data.points.row(0).eval();
  EXPECT_FALSE(FitWithinDistance(data, spec, 1.0, kNoWatch, &fit, &error));
  EXPECT_NE(error.find("1 points"), std::string::npos) << error;
  data.points.conservativeResize(Eigen::NoChange, 1);
  EXPECT_FALSE(FitWithinDistance(data, spec, 1.0, kNoWatch, &fit, &error));
  EXPECT_NE(error.find("dimension 1"), std::string::npos) << error;
}

TEST(MaxDistance, EndsWhenItIsToldTo) {
  int calls = 0;
  const SearchWatch watch = [&](int, double fraction) {
    EXPECT_GE(fraction, 0.0);
    EXPECT_LE(fraction, 1.0);
    return ++calls < 20;
  };
  MaxDistanceFit fit;
  std::string error;
  FitSpec spec;
  spec.closed = true;
  spec.parameters = Parameterization::kChordLength;
  EXPECT_FALSE(
      FitWithinDistance(ReadPoints("animals/rhino_2000.csv"), spec, 0.5, watch, &fit, &error));
  EXPECT_EQ(calls, 20);
  EXPECT_EQ(error, "interrupted; nothing was written");
}

}  // namespace
}  // namespace batten
