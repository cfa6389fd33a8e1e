#ifndef BATTEN_COST_FUNCTIONS_BEZIER_CUT_H_
#define BATTEN_COST_FUNCTIONS_BEZIER_CUT_H_

#include <ceres/dynamic_autodiff_cost_function.h>
#include <ceres/jet.h>

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "splines/bezier_cut_value.h"
#include "splines/bezier_hull.h"
#include "splines/bezier_measures.h"

namespace batten {

/// Both parts of a Bezier curve cut at a differentiable place u.
template <typename T>
struct BezierParts {
  std::vector<T> first;  ///< n + 1 points, d coordinates each.
  std::vector<T> second;
};

/// de Casteljau's algorithm over Jets; `points` as in CutBezier().
template <typename T>
BezierParts<T> CutAt(const T& u, int dimension, const std::vector<double>& points) {
  BezierParts<T> parts;
  for (const double coordinate : points) parts.second.push_back(T(coordinate));
  const auto d = static_cast<std::size_t>(dimension);
  for (std::size_t size = points.size(); size > 0; size -= d) {
    parts.first.insert(parts.first.end(), parts.second.begin(),
                       parts.second.begin() + static_cast<std::ptrdiff_t>(d));
    for (std::size_t k = 0; k + d < size; ++k) {
      parts.second[k] += u * (parts.second[k + d] - parts.second[k]);
    }
  }
  return parts;
}

/// Residuals whose squares add up to CutValue of kFlatness: in the plane the signed distance of
/// each inner control point of both parts from its chord (2 (n - 1) of them), in other dimensions
/// the d components of that distance. False outside (0, 1).
class CutFlatness {
 public:
  explicit CutFlatness(const BezierCurve& curve)
      : degree_(curve.degree()),
        dimension_(curve.dimension()),
        points_(curve.control_points().data(),
                curve.control_points().data() + curve.control_points().size()) {}

  int num_residuals() const { return 2 * (degree_ - 1) * (dimension_ == 2 ? 1 : dimension_); }

  template <typename T>
  bool operator()(T const* const* cut, T* residuals) const {
    const T& u = cut[0][0];
    if (!(u > T(0.0) && u < T(1.0))) return false;
    const BezierParts<T> parts = CutAt(u, dimension_, points_);
    for (const std::vector<T>* part : {&parts.first, &parts.second}) {
      residuals = dimension_ == 2 ? SignedDistances(*part, residuals)
                                  : DistanceComponents(*part, residuals);
    }
    return true;
  }

 private:
  template <typename T>
  T* SignedDistances(const std::vector<T>& part, T* residuals) const {
    using std::sqrt;
    const T chord[] = {part[2 * degree_] - part[0], part[2 * degree_ + 1] - part[1]};
    const T squared_chord = chord[0] * chord[0] + chord[1] * chord[1];
    for (int i = 1; i < degree_; ++i) {
      const T v[] = {part[2 * i] - part[0], part[2 * i + 1] - part[1]};
      const T squared = v[0] * v[0] + v[1] * v[1];
      if (squared_chord > T(0.0)) {
        *residuals++ = (v[0] * chord[1] - v[1] * chord[0]) / sqrt(squared_chord);
      } else {
        *residuals++ = squared > T(0.0) ? sqrt(squared) : T(0.0);
      }
    }
    return residuals;
  }

  template <typename T>
  T* DistanceComponents(const std::vector<T>& part, T* residuals) const {
    const int d = dimension_;
    const T* first = part.data();
    const T* last = part.data() + degree_ * d;
    T squared_chord(0.0);
    for (int c = 0; c < d; ++c) squared_chord += (last[c] - first[c]) * (last[c] - first[c]);
    for (int i = 1; i < degree_; ++i) {
      const T* point = part.data() + i * d;
      T along(0.0);
      for (int c = 0; c < d; ++c) along += (point[c] - first[c]) * (last[c] - first[c]);
      if (squared_chord > T(0.0)) along /= squared_chord;
      for (int c = 0; c < d; ++c) {
        *residuals++ = (point[c] - first[c]) - along * (last[c] - first[c]);
      }
    }
    return residuals;
  }

  int degree_;
  int dimension_;
  std::vector<double> points_;
};

/// Two residuals, the roots of the areas of both parts' hulls, for planar curves: their squares add
/// up to CutValue of kHullArea. Differentiable while the hulls keep their corners; at a kink the
/// derivative is of one side. Zero areas have derivative zero. False outside (0, 1).
class CutHullArea {
 public:
  explicit CutHullArea(const BezierCurve& curve)
      : degree_(curve.degree()),
        points_(curve.control_points().data(),
                curve.control_points().data() + curve.control_points().size()) {}

  static int num_residuals() { return 2; }

  template <typename T>
  bool operator()(T const* const* cut, T* residuals) const {
    const T& u = cut[0][0];
    if (!(u > T(0.0) && u < T(1.0))) return false;
    const BezierParts<T> parts = CutAt(u, 2, points_);
    residuals[0] = RootOfArea(parts.first);
    residuals[1] = RootOfArea(parts.second);
    return true;
  }

 private:
  static double ValueOf(double x) { return x; }
  template <typename T, int N>
  static double ValueOf(const ceres::Jet<T, N>& x) {
    return x.a;
  }

  template <typename T>
  T RootOfArea(const std::vector<T>& part) const {
    using std::sqrt;
    std::vector<double> values;
    for (const T& coordinate : part) values.push_back(ValueOf(coordinate));
    std::vector<int> hull(static_cast<std::size_t>(degree_) + 2);
    const int count = ConvexHull(degree_, values.data(), hull.data());
    T twice_area(0.0);
    for (int k = 1; k + 1 < count; ++k) {
      const T* origin = part.data() + 2 * hull[0];
      const T* a = part.data() + 2 * hull[k];
      const T* b = part.data() + 2 * hull[k + 1];
      twice_area +=
          (a[0] - origin[0]) * (b[1] - origin[1]) - (a[1] - origin[1]) * (b[0] - origin[0]);
    }
    return twice_area > T(0.0) ? sqrt(0.5 * twice_area) : T(0.0);
  }

  int degree_;
  std::vector<double> points_;
};

/// The functor as an automatically differentiated cost function of one variable.
template <typename Functor>
std::unique_ptr<ceres::CostFunction> MakeCutCostFunction(const BezierCurve& curve) {
  constexpr int kDerivatives = 1;
  auto functor = std::make_unique<Functor>(curve);
  const int num_residuals = functor->num_residuals();
  auto cost = std::make_unique<ceres::DynamicAutoDiffCostFunction<Functor, kDerivatives>>(
      functor.release());  // it owns the functor now
  cost->AddParameterBlock(1);
  cost->SetNumResiduals(num_residuals);
  return cost;
}

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_BEZIER_CUT_H_
