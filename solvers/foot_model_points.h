#ifndef BATTEN_SOLVERS_FOOT_MODEL_POINTS_H_
#define BATTEN_SOLVERS_FOOT_MODEL_POINTS_H_

// Included by foot_model_steps.h alone.

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "cost_functions/pack.h"
#include "solvers/foot_model.h"

namespace batten {

template <typename Body, int... kIndices>
inline __attribute__((always_inline)) void CallForEach(std::integer_sequence<int, kIndices...>,
                                                       const Body& body) {
  (body(std::integral_constant<int, kIndices>{}), ...);
}

/// The points of a span, a pack of them at a time; P and D are -1 where they are known at run time
/// only.
template <int P, int D>
struct FootModel::SpanPoints {
  static constexpr bool kStatic = P >= 0;
  static constexpr int kOrder = kStatic ? P + 1 : kMaxOrder;
  static constexpr int kDimension = kStatic ? D : kMaxDimension;
  static constexpr int kSize = kOrder * kDimension;

  FootModel& model;
  int order() const { return kStatic ? P + 1 : model.order_; }
  int dimension() const { return kStatic ? D : model.dimension_; }

  /// body(0), ..., body(n - 1). Where n is kMost, known to the compiler, it is unrolled: what its
  /// arguments index can be in registers then, or has addresses of its own.
  template <int kMost, typename Body>
  static inline __attribute__((always_inline)) void ForEach(int n, const Body& body) {
    if constexpr (kStatic) {
      CallForEach(std::make_integer_sequence<int, kMost>{}, body);
    } else {
      for (int i = 0; i < n; ++i) body(i);
    }
  }
  template <typename Body>
  inline __attribute__((always_inline)) void ForEachFunction(const Body& body) const {
    ForEach<kOrder>(order(), body);
  }
  template <typename Body>
  inline __attribute__((always_inline)) void ForEachCoordinate(const Body& body) const {
    ForEach<kDimension>(dimension(), body);
  }

  /// Up to kRowPack points of a span; the last one again where there are fewer, without weight.
  template <typename Pack>
  struct PointPack {
    int count;
    std::ptrdiff_t points[kRowPack];
    Pack t, u, weight;
    Pack q[kDimension];
  };
  /// Position less data point, and what is asked for of the derivatives and the basis.
  template <typename Pack>
  struct AtPoints {
    Pack r[kDimension];
    Pack first[kDimension];
    Pack second[kDimension];
    Pack basis[kOrder];
    Pack slope[kOrder];  // of the basis
    Pack loss_bend;      // c / w, where the loss's curvature is asked for
  };

  /// Packs of the span's points, in the order of its runs.
  template <typename Pack, typename Body>
  inline __attribute__((always_inline)) void ForEachPack(int span, const Body& body) const {
    const Run* run = model.runs_.data() + model.span_runs_[span];
    const Run* const end = model.runs_.data() + model.span_runs_[span + 1];
    PointPack<Pack> pack;
    for (int next = run == end ? 0 : run->begin; run != end;) {
      // Of ordered data nearly all are neighbours, which are read as one.
      if (run->end - next >= kRowPack) {
        LoadNeighbours(next, &pack);
        next += kRowPack;
        if (next == run->end && ++run != end) next = run->begin;
      } else {
        pack.count = 0;
        while (pack.count < kRowPack && run != end) {
          pack.points[pack.count++] = next++;
          if (next == run->end && ++run != end) next = run->begin;
        }
        GatherPoints(&pack);
      }
      pack.u = pack.t - model.middles_[span];
      body(pack);
    }
  }
  template <typename Pack>
  inline __attribute__((always_inline)) void LoadNeighbours(int first,
                                                            PointPack<Pack>* pack) const {
    const int d = dimension();
    pack->count = kRowPack;
    for (int lane = 0; lane < kRowPack; ++lane) pack->points[lane] = first + lane;
    pack->t = Pack::Load(model.parameters_ + first);
    pack->weight = Pack::Load(model.weights_ + first);
    const double* const q = model.sites_.points.data() + static_cast<std::ptrdiff_t>(first) * d;
    for (int e = 0; e < d; ++e) pack->q[e] = Pack::Gather(q + e, d);
  }
  /// The last of its points again where there are fewer than a pack has.
  template <typename Pack>
  inline __attribute__((always_inline)) void GatherPoints(PointPack<Pack>* pack) const {
    for (int lane = pack->count; lane < kRowPack; ++lane) {
      pack->points[lane] = pack->points[pack->count - 1];
    }
    pack->t = Pack::Gather(model.parameters_, pack->points, 1);
    pack->weight = Pack::Gather(model.weights_, pack->points, 1);
    for (int lane = pack->count; lane < kRowPack; ++lane) pack->weight.Set(lane, 0.0);
    for (int e = 0; e < dimension(); ++e) {
      pack->q[e] = Pack::Gather(model.sites_.points.data() + e, pack->points, dimension());
    }
  }

  /// Coefficients of powers of u in every entry of a pack.
  template <typename Pack, int kMost>
  struct Polynomials {
    Pack coefficients[kOrder * kMost];
    Polynomials(const double* source, int size) {
      for (int x = 0; x < size; ++x) coefficients[x] = Pack(source[x]);
    }
  };
  template <typename Pack>
  using CurvePolynomials = Polynomials<Pack, kDimension>;
  template <typename Pack>
  using BasisPolynomials = Polynomials<Pack, kOrder>;
  template <typename Pack>
  CurvePolynomials<Pack> CurveOf(int span) const {
    const int size = order() * dimension();
    return {&model.curve_[static_cast<std::size_t>(span) * size], size};
  }
  template <typename Pack>
  BasisPolynomials<Pack> BasisOf(int span) const {
    const int size = order() * order();
    return {&model.coefficients_[static_cast<std::size_t>(span) * size], size};
  }

  template <typename Pack>
  inline __attribute__((always_inline)) void EvaluateCurve(const CurvePolynomials<Pack>& curve,
                                                           const PointPack<Pack>& pack,
                                                           AtPoints<Pack>* at) const {
    const int d = dimension();
    ForEachCoordinate([&](int e) {
      Pack value(0.0), first(0.0), second(0.0);
      ForEachFunction([&](int step) {
        const int power = order() - 1 - step;
        const Pack& coefficient = curve.coefficients[power * d + e];
        second = step < 3 ? first : second * pack.u + first;
        first = step < 2 ? value : first * pack.u + value;
        value = step < 1 ? coefficient : value * pack.u + coefficient;
      });
      at->r[e] = value - pack.q[e];
      at->first[e] = first;
      at->second[e] = second + second;
    });
  }
  template <typename Pack>
  inline __attribute__((always_inline)) void EvaluateBasis(const BasisPolynomials<Pack>& basis,
                                                           const PointPack<Pack>& pack,
                                                           AtPoints<Pack>* at) const {
    const int k = order();
    ForEachFunction([&](int j) {
      Pack value(0.0), slope(0.0);
      ForEachFunction([&](int step) {
        const Pack& coefficient = basis.coefficients[(k - 1 - step) * k + j];
        slope = step < 2 ? value : slope * pack.u + value;
        value = step < 1 ? coefficient : value * pack.u + coefficient;
      });
      at->basis[j] = value;
      at->slope[j] = slope;
    });
  }

  /// Where parameters are pressed against an end of the domain, they stay there.
  template <typename Pack>
  inline __attribute__((always_inline)) typename Pack::Mask IsPressed(const Pack& t,
                                                                      const Pack& along) const {
    const Pack begin(model.basis_.domain_begin()), end(model.basis_.domain_end()), zero(0.0);
    return ((t <= begin) & (zero < along)) | ((end <= t) & (along < zero));
  }

  template <typename Pack>
  inline __attribute__((always_inline)) void EvaluateLoss(const PointPack<Pack>& pack,
                                                          AtPoints<Pack>* at) const {
    at->loss_bend = Pack::Gather(model.loss_bends_.data(), pack.points, 1);
  }
  /// Adds c B B' (x) r r', the upper triangle row by row.
  template <typename Pack>
  inline __attribute__((always_inline)) void AddLossBend(const AtPoints<Pack>& at, const Pack& c,
                                                         Pack* triangle) const {
    const int d = dimension(), size = order() * d;
    Pack q[kSize];
    for (int x = 0; x < size; ++x) q[x] = at.basis[x / d] * at.r[x % d];
    for (int x = 0, pair = 0; x < size; ++x) {
      const Pack factor = c * q[x];
      for (int y = x; y < size; ++y, ++pair) triangle[pair] = triangle[pair] + factor * q[y];
    }
  }

  /// What eliminates the parameters of points.
  template <typename Pack>
  struct Elimination {
    Pack along;                 // C' . r
    Pack denominator;           // of the parameter's step
    typename Pack::Mask moves;  // where there is one
    Pack damped;                // |C'|^2, at least least_speed_
    Pack Divided(const Pack& by) const { return Choose(moves, by / denominator, Pack(0.0)); }
  };
  /// `kBent`: with the loss's curvature.
  template <FootModelKind K, bool kBent, typename Pack>
  inline __attribute__((always_inline)) Elimination<Pack> Eliminate(
      const AtPoints<Pack>& at, const PointPack<Pack>& pack) const {
    Pack speed(0.0), bend(0.0), product(0.0);
    ForEachCoordinate([&](int e) {
      speed = e == 0 ? at.first[e] * at.first[e] : speed + at.first[e] * at.first[e];
      bend = e == 0 ? at.r[e] * at.second[e] : bend + at.r[e] * at.second[e];
      product = e == 0 ? at.first[e] * at.r[e] : product + at.first[e] * at.r[e];
    });
    if constexpr (kBent) bend = bend + at.loss_bend * product * product;
    // Where C' all but vanishes, damping by |C'|^2 alone would hold no step of t back.
    const Pack least(model.least_speed_);
    const typename Pack::Mask slow = speed < least;
    const Pack damped = Choose(slow, least, speed);
    const Pack zero(0.0);
    typename Pack::Mask moves = zero < speed;
    if constexpr (K == FootModelKind::kPoint) moves = speed < zero;
    if (model.has_held_) {
      moves = moves & (zero < Pack::Gather(model.moves_.data(), pack.points, 1));
    }
    if (!model.basis_.periodic()) moves = moves & !IsPressed(pack.t, product);
    Pack denominator =
        Choose(slow, speed + model.damping_ * damped, (1.0 + model.damping_) * speed);
    if constexpr (K == FootModelKind::kCurvature) {
      denominator = Choose(zero < bend, speed + bend, speed);
    } else if constexpr (K == FootModelKind::kNewton) {
      // Where f'' is not positive, t is at no minimum: Gauss and Newton's denominator leads to one.
      constexpr double kLeast = 1e-3;
      denominator = Choose(kLeast * speed < speed + bend, denominator + bend, denominator);
    }
    return {product, denominator, moves, damped};
  }
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_FOOT_MODEL_POINTS_H_
