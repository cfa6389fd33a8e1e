#ifndef BATTEN_SOLVERS_FOOT_MODEL_POINTS_H_
#define BATTEN_SOLVERS_FOOT_MODEL_POINTS_H_

// Included by foot_model_kernel.h alone.

#include <algorithm>
#include <cstddef>

#include "cost_functions/pack.h"
#include "solvers/foot_model.h"

namespace batten {

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

  /// Up to kRowPack points of a span; the last one again where there are fewer, without weight.
  template <typename Pack>
  struct PointPack {
    int place;
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

  template <typename Pack, typename Body>
  inline __attribute__((always_inline)) void ForEachPack(int span, const Body& body) const {
    const int end = model.span_begins_[span + 1];
    PointPack<Pack> pack;
    for (int place = model.span_begins_[span]; place < end; place += kRowPack) {
      pack.place = place;
      pack.count = std::min(kRowPack, end - place);
      std::ptrdiff_t places[kRowPack];
      for (int lane = 0; lane < kRowPack; ++lane) {
        places[lane] = std::min(place + lane, end - 1);
        pack.points[lane] = model.order_of_points_[places[lane]];
      }
      pack.t = Pack::Gather(model.places_.data(), places, 1);
      pack.u = pack.t - model.middles_[span];
      pack.weight = Pack::Gather(model.weights_, pack.points, 1);
      for (int lane = pack.count; lane < kRowPack; ++lane) pack.weight.Set(lane, 0.0);
      for (int e = 0; e < dimension(); ++e) {
        pack.q[e] = Pack::Gather(model.sites_.points.data() + e, pack.points, dimension());
      }
      body(pack);
    }
  }

  template <typename Pack>
  inline __attribute__((always_inline)) void EvaluateCurve(int span, const PointPack<Pack>& pack,
                                                           AtPoints<Pack>* at) const {
    const int k = order(), d = dimension();
    const double* curve = &model.curve_[static_cast<std::size_t>(span) * k * d];
    for (int e = 0; e < d; ++e) {
      Pack value(curve[(k - 1) * d + e]), first(0.0), second(0.0);
      for (int power = k - 2; power >= 0; --power) {
        second = second * pack.u + first;
        first = first * pack.u + value;
        value = value * pack.u + curve[power * d + e];
      }
      at->r[e] = value - pack.q[e];
      at->first[e] = first;
      at->second[e] = second + second;
    }
  }
  template <typename Pack>
  inline __attribute__((always_inline)) void EvaluateBasis(int span, const PointPack<Pack>& pack,
                                                           AtPoints<Pack>* at) const {
    const int k = order();
    const double* c = &model.coefficients_[static_cast<std::size_t>(span) * k * k];
    for (int j = 0; j < k; ++j) {
      at->basis[j] = Pack(c[(k - 1) * k + j]);
      at->slope[j] = Pack(0.0);
      for (int power = k - 2; power >= 0; --power) {
        at->slope[j] = at->slope[j] * pack.u + at->basis[j];
        at->basis[j] = at->basis[j] * pack.u + c[power * k + j];
      }
    }
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

  /// The factor a of g g' over w; keeps what the parameters' steps need. `kBent`: with the loss's
  /// curvature.
  template <bool kBent, typename Pack>
  inline __attribute__((always_inline)) Pack Eliminate(const AtPoints<Pack>& at,
                                                       const PointPack<Pack>& pack,
                                                       Pack* along) const {
    Pack speed(0.0), bend(0.0), product(0.0);
    for (int e = 0; e < dimension(); ++e) {
      speed = speed + at.first[e] * at.first[e];
      bend = bend + at.r[e] * at.second[e];
      product = product + at.first[e] * at.r[e];
    }
    *along = product;
    if constexpr (kBent) bend = bend + at.loss_bend * product * product;
    // Where C' all but vanishes, damping by |C'|^2 alone would hold no step of t back.
    const Pack least(model.least_speed_);
    const typename Pack::Mask slow = speed < least;
    const Pack damped = Choose(slow, least, speed);
    const Pack zero(0.0);
    Pack a = zero, denominator = zero;
    if (model.kind_ != FootModelKind::kPoint) {
      typename Pack::Mask moves = zero < speed;
      if (model.has_held_) {
        moves = moves & (zero < Pack::Gather(model.moves_.data(), pack.points, 1));
      }
      if (!model.basis_.periodic()) moves = moves & !IsPressed(pack.t, product);
      denominator = Choose(slow, speed + model.damping_ * damped, (1.0 + model.damping_) * speed);
      if (model.kind_ == FootModelKind::kCurvature) {
        denominator = Choose(zero < bend, speed + bend, speed);
      } else if (model.kind_ == FootModelKind::kNewton) {
        // Where f'' is not positive, t is at no minimum: Gauss and Newton's denominator leads to
        // one.
        constexpr double kLeast = 1e-3;
        denominator = Choose(kLeast * speed < speed + bend, denominator + bend, denominator);
      }
      a = Choose(moves, 1.0 / denominator, zero);
      denominator = Choose(moves, denominator, zero);
    }
    product.StoreFirst(&model.along_[pack.place], pack.count);
    denominator.StoreFirst(&model.denominators_[pack.place], pack.count);
    (pack.weight * model.damping_ * damped).StoreFirst(&model.scales_[pack.place], pack.count);
    return a;
  }
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_FOOT_MODEL_POINTS_H_
