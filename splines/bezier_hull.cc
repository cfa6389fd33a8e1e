#include "splines/bezier_hull.h"

#include <algorithm>
#include <array>

#include "splines/bezier.h"

namespace batten {
namespace {

struct PlanePoint {
  double x;
  double y;
  int index;
  bool operator<(const PlanePoint& other) const {
    return x < other.x || (x == other.x && y < other.y);
  }
};

/// Positive where a, b, c turn left: twice the area of their triangle.
double Turn(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

}  // namespace

int ConvexHull(int degree, const double* points, int* indices) {
  const int count = degree + 1;
  std::array<PlanePoint, kMaxBezierDegree + 1> sorted, chain;
  for (int i = 0; i < count; ++i) sorted[i] = {points[2 * i], points[2 * i + 1], i};
  std::sort(sorted.begin(), sorted.begin() + count);
  int num_vertices = 0;
  // The lower chain from left to right, then the upper one from right to left.
  for (int pass = 0; pass < 2; ++pass) {
    int size = 0;
    for (int i = 0; i < count; ++i) {
      const PlanePoint& next = sorted[pass == 0 ? i : count - 1 - i];
      while (size >= 2 && Turn(chain[size - 2], chain[size - 1], next) <= 0.0) --size;
      chain[size++] = next;
    }
    // Each chain ends where the other begins.
    for (int k = 0; k + 1 < size; ++k) indices[num_vertices++] = chain[k].index;
  }
  return num_vertices;
}

double HullArea(int degree, const double* points) {
  std::array<int, kMaxBezierDegree + 2> hull;
  const int count = ConvexHull(degree, points, hull.data());
  const auto vertex = [&](int k) {
    return PlanePoint{points[2 * hull[k]], points[2 * hull[k] + 1], hull[k]};
  };
  // The fan of triangles from the first point: nothing cancels far from the origin.
  double twice_area = 0.0;
  for (int k = 1; k + 1 < count; ++k) twice_area += Turn(vertex(0), vertex(k), vertex(k + 1));
  return 0.5 * twice_area;
}

}  // namespace batten
