#include "solvers/passing_length.h"

#include <cmath>

namespace batten {
namespace {

/// The limit of a stop test over what the measure is for h = |D1 x D2| = |D1| = 1, so that squares
/// of both may be compared.
double SquaredFactor(const StopTest& stop, int n) {
  const double limit = stop.limit();
  switch (stop.measure()) {
    case StopMeasure::kControlPoints:
    case StopMeasure::kPolygon: {
      const int middle = n / 2;
      const double highest = 0.5 * middle * (n - middle);
      return limit / (highest * highest);
    }
    case StopMeasure::kFlatness: {
      double sum = 0.0;
      for (int i = 1; i < n; ++i) sum += 0.25 * i * i * (n - i) * (n - i);
      return limit / sum;
    }
    case StopMeasure::kSegment: {
      const double highest = n * (n - 1) / 8.0;  // of the curve itself, at its middle
      return limit * limit / (highest * highest);
    }
    case StopMeasure::kHullArea: {
      const double area = (n - 1.0) * n * (n + 1.0) / 12.0;  // sum of i (n - i) / 2
      return limit * limit / (area * area);
    }
    case StopMeasure::kAngle:
      break;
  }
  const double slope = 0.5 * (n - 1);  // of the first leg
  return limit / (slope * slope);
}

}  // namespace

PassingLength::PassingLength(const StopTest& stop, int degree, int dimension)
    : degree_(degree),
      dimension_(dimension),
      measure_(stop.measure()),
      factor_(SquaredFactor(stop, degree)) {}

double PassingLength::FromSquares(double squared_speed, double squared_cross) const {
  switch (measure_) {
    case StopMeasure::kHullArea:
      return std::cbrt(std::sqrt(factor_ / squared_cross));
    case StopMeasure::kAngle:
      return std::sqrt(factor_ * squared_speed * squared_speed / squared_cross);
    default:
      return std::sqrt(std::sqrt(factor_ * squared_speed / squared_cross));
  }
}

template <int d>
PassingLength::Squares PassingLength::SquaresNear(const double* points, double h) const {
  const int n = degree_;
  const double along = (n - 1) * h, curving = 0.5 * (n - 1) * (n - 2) * h * h;
  const double turning = (n - 2) * h;
  double speed[d], bend[d];
  Squares squares;
  for (int c = 0; c < d; ++c) {
    const double first = points[d + c] - points[c];
    const double next = points[2 * d + c] - points[d + c];
    const double second = next - first;
    const double third = n >= 3 ? (points[3 * d + c] - points[2 * d + c] - next) - second : 0.0;
    speed[c] = first + along * second + curving * third;
    bend[c] = second + turning * third;
    squares.speed += speed[c] * speed[c];
  }
  for (int i = 0; i < d; ++i) {
    for (int j = i + 1; j < d; ++j) {
      const double minor = speed[i] * bend[j] - speed[j] * bend[i];
      squares.cross += minor * minor;
    }
  }
  return squares;
}

double PassingLength::Near(const double* points, double h) const {
  Squares squares;
  switch (dimension_) {
    case 1:
      squares = SquaresNear<1>(points, h);
      break;
    case 2:
      squares = SquaresNear<2>(points, h);
      break;
    case 3:
      squares = SquaresNear<3>(points, h);
      break;
    default:
      squares = SquaresNear<4>(points, h);
  }
  return FromSquares(squares.speed, squares.cross);
}

}  // namespace batten
