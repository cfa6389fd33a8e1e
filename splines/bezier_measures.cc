#include "splines/bezier_measures.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace batten {
namespace {

template <int d>
void Subtract(const double* a, const double* b, double* difference) {
  for (int c = 0; c < d; ++c) difference[c] = a[c] - b[c];
}

template <int d>
double Dot(const double* u, const double* v) {
  double sum = 0.0;
  for (int c = 0; c < d; ++c) sum += u[c] * v[c];
  return sum;
}

// |u|^2 |v|^2 - (u.v)^2 as a sum of squares (Lagrange's identity): nothing cancels where u and v
// are nearly parallel.
template <int d>
double SquaredCross(const double* u, const double* v) {
  double sum = 0.0;
  for (int i = 0; i < d; ++i) {
    for (int j = i + 1; j < d; ++j) {
      const double minor = u[i] * v[j] - u[j] * v[i];
      sum += minor * minor;
    }
  }
  return sum;
}

struct Largest {
  double value = 0.0;
  void operator()(double x) { value = std::max(value, x); }
};
struct Sum {
  double value = 0.0;
  void operator()(double x) { value += x; }
};

template <typename Fold, int d>
Quotient FoldDistances(int n, const double* points) {
  double chord[d], v[d];
  Subtract<d>(points + n * d, points, chord);
  const double squared_chord = Dot<d>(chord, chord);
  Fold fold;
  if (squared_chord > 0.0) {
    for (int i = 1; i < n; ++i) {
      Subtract<d>(points + i * d, points, v);
      fold(SquaredCross<d>(v, chord));
    }
    return {fold.value, squared_chord};
  }
  for (int i = 1; i < n; ++i) {
    Subtract<d>(points + i * d, points, v);
    fold(Dot<d>(v, v));
  }
  return {fold.value, 1.0};
}

template <typename Fold>
Quotient FoldDistances(int n, int dimension, const double* points) {
  switch (dimension) {
    case 1:
      return FoldDistances<Fold, 1>(n, points);
    case 2:
      return FoldDistances<Fold, 2>(n, points);
    case 3:
      return FoldDistances<Fold, 3>(n, points);
    default:
      return FoldDistances<Fold, 4>(n, points);
  }
}

template <int d>
bool IsNearChordIn(int n, const double* points, double squared_limit) {
  double chord[d], v[d];
  Subtract<d>(points + n * d, points, chord);
  const double squared_chord = Dot<d>(chord, chord);
  const double limit = squared_chord > 0.0 ? squared_limit * squared_chord : squared_limit;
  for (int i = 1; i < n; ++i) {
    Subtract<d>(points + i * d, points, v);
    if (!((squared_chord > 0.0 ? SquaredCross<d>(v, chord) : Dot<d>(v, v)) <= limit)) return false;
  }
  return true;
}

template <int d>
bool IsNearSegmentIn(int n, const double* points, double squared_limit) {
  const double* const last = points + n * d;
  double chord[d], v[d];
  Subtract<d>(last, points, chord);
  const double squared_chord = Dot<d>(chord, chord);
  for (int i = 1; i < n; ++i) {
    Subtract<d>(points + i * d, points, v);
    const double along = Dot<d>(v, chord);
    bool is_near = false;
    if (!(along > 0.0)) {
      is_near = Dot<d>(v, v) <= squared_limit;
    } else if (along >= squared_chord) {
      Subtract<d>(points + i * d, last, v);
      is_near = Dot<d>(v, v) <= squared_limit;
    } else {
      is_near = SquaredCross<d>(v, chord) <= squared_limit * squared_chord;
    }
    if (!is_near) return false;
  }
  return true;
}

// One division for all points: those beside the segment are compared by their cross products.
template <int d>
Quotient SquaredPolygonDistanceIn(int n, const double* points) {
  const double* const last = points + n * d;
  double chord[d], v[d];
  Subtract<d>(last, points, chord);
  const double squared_chord = Dot<d>(chord, chord);
  double beside = 0.0, beyond = 0.0;
  for (int i = 1; i < n; ++i) {
    Subtract<d>(points + i * d, points, v);
    const double along = Dot<d>(v, chord);
    if (!(along > 0.0)) {
      beyond = std::max(beyond, Dot<d>(v, v));
    } else if (along >= squared_chord) {
      Subtract<d>(points + i * d, last, v);
      beyond = std::max(beyond, Dot<d>(v, v));
    } else {
      beside = std::max(beside, SquaredCross<d>(v, chord));
    }
  }
  if (squared_chord == 0.0) return {beyond, 1.0};
  return {std::max(beside, beyond * squared_chord), squared_chord};
}

template <int d>
double SquaredLegSlopeIn(int n, const double* points, double squared_rounding) {
  double chord[d], leg[d];
  Subtract<d>(points + n * d, points, chord);
  const double squared_chord = Dot<d>(chord, chord);
  double largest = 0.0;
  for (int i = 0; i < n; ++i) {
    Subtract<d>(points + (i + 1) * d, points + i * d, leg);
    if (Dot<d>(leg, leg) <= squared_rounding) continue;
    const double along = Dot<d>(leg, chord);
    if (!(along > 0.0)) return std::numeric_limits<double>::infinity();
    const double squared_cross = SquaredCross<d>(leg, chord);
    if (squared_cross <= squared_rounding * squared_chord) continue;
    largest = std::max(largest, squared_cross / (along * along));
  }
  return largest;
}

}  // namespace

Quotient SquaredChordDistance(int degree, int dimension, const double* points) {
  return FoldDistances<Largest>(degree, dimension, points);
}

bool IsNearChord(int degree, int dimension, const double* points, double squared_limit) {
  switch (dimension) {
    case 1:
      return IsNearChordIn<1>(degree, points, squared_limit);
    case 2:
      return IsNearChordIn<2>(degree, points, squared_limit);
    case 3:
      return IsNearChordIn<3>(degree, points, squared_limit);
    default:
      return IsNearChordIn<4>(degree, points, squared_limit);
  }
}

bool IsNearSegment(int degree, int dimension, const double* points, double squared_limit) {
  switch (dimension) {
    case 1:
      return IsNearSegmentIn<1>(degree, points, squared_limit);
    case 2:
      return IsNearSegmentIn<2>(degree, points, squared_limit);
    case 3:
      return IsNearSegmentIn<3>(degree, points, squared_limit);
    default:
      return IsNearSegmentIn<4>(degree, points, squared_limit);
  }
}

Quotient SquaredPolygonDistance(int degree, int dimension, const double* points) {
  switch (dimension) {
    case 1:
      return SquaredPolygonDistanceIn<1>(degree, points);
    case 2:
      return SquaredPolygonDistanceIn<2>(degree, points);
    case 3:
      return SquaredPolygonDistanceIn<3>(degree, points);
    default:
      return SquaredPolygonDistanceIn<4>(degree, points);
  }
}

Quotient Flatness(int degree, int dimension, const double* points) {
  return FoldDistances<Sum>(degree, dimension, points);
}

double SquaredLegSlope(int degree, int dimension, const double* points, double rounding) {
  const double squared = rounding * rounding;
  switch (dimension) {
    case 1:
      return SquaredLegSlopeIn<1>(degree, points, squared);
    case 2:
      return SquaredLegSlopeIn<2>(degree, points, squared);
    case 3:
      return SquaredLegSlopeIn<3>(degree, points, squared);
    default:
      return SquaredLegSlopeIn<4>(degree, points, squared);
  }
}

double SquaredSegmentDistance(int dimension, const double* point, const double* a,
                              const double* b) {
  double along = 0.0, squared_chord = 0.0, to_a = 0.0, to_b = 0.0;
  for (int c = 0; c < dimension; ++c) {
    const double v = point[c] - a[c];
    const double w = point[c] - b[c];
    const double chord = b[c] - a[c];
    along += v * chord;
    squared_chord += chord * chord;
    to_a += v * v;
    to_b += w * w;
  }
  if (!(along > 0.0)) return to_a;
  if (along >= squared_chord) return to_b;
  double cross = 0.0;
  for (int i = 0; i < dimension; ++i) {
    for (int j = i + 1; j < dimension; ++j) {
      const double minor = (point[i] - a[i]) * (b[j] - a[j]) - (point[j] - a[j]) * (b[i] - a[i]);
      cross += minor * minor;
    }
  }
  return cross / squared_chord;
}

double BoxSide(int degree, int dimension, const double* points) {
  double side = 0.0;
  for (int c = 0; c < dimension; ++c) {
    double low = points[c], high = points[c];
    for (int i = 1; i <= degree; ++i) {
      low = std::min(low, points[i * dimension + c]);
      high = std::max(high, points[i * dimension + c]);
    }
    side = std::max(side, high - low);
  }
  return side;
}

double UnitOf(const Points& points) {
  const double largest = points.cwiseAbs().maxCoeff();
  constexpr int kSmallestExponent = -1000;  // 1 / unit must be a double too
  return std::ldexp(1.0, largest == 0.0 ? 0 : std::max(std::ilogb(largest), kSmallestExponent));
}

}  // namespace batten
