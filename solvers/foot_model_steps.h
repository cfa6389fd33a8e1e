#ifndef BATTEN_SOLVERS_FOOT_MODEL_STEPS_H_
#define BATTEN_SOLVERS_FOOT_MODEL_STEPS_H_

// Included by foot_model_kernel.h alone.

#include <limits>

#include "solvers/foot_model_points.h"

namespace batten {

/// How the parameters of a span's points move; P and D are -1 where they are known at run time
/// only.
template <int P, int D>
struct FootModel::SpanSteps : FootModel::SpanPoints<P, D> {
  using Base = SpanPoints<P, D>;
  using Base::dimension;
  using Base::kSize;
  using Base::model;
  using Base::order;
  template <typename Pack>
  using PointPack = typename Base::template PointPack<Pack>;
  template <typename Pack>
  using AtPoints = typename Base::template AtPoints<Pack>;

  template <typename Pack>
  inline __attribute__((always_inline)) void ImprovePacks(int span, int steps,
                                                          double* parameters) const {
    const Pack low(model.basis_.knots()[model.basis_.first_span() + span]);
    const Pack high(model.basis_.knots()[model.basis_.first_span() + span + 1]);
    const auto curve = this->template CurveOf<Pack>(span);
    this->template ForEachPack<Pack>(span, [&](PointPack<Pack>& pack) {
      const Pack middle(model.middles_[span]), zero(0.0);
      Pack best(std::numeric_limits<double>::infinity()), t = pack.t, best_t = pack.t;
      typename Pack::Mask goes_on = pack.t <= pack.t;
      if (model.has_held_) {
        goes_on = zero < Pack::Gather(model.moves_.data(), pack.points, 1);
      }
      for (int step = 0; step <= steps && Any(goes_on); ++step) {
        AtPoints<Pack> at;
        pack.u = t - middle;
        this->EvaluateCurve(curve, pack, &at);
        Pack f(0.0), along(0.0), speed(0.0), bend(0.0);
        this->ForEachCoordinate([&](int e) {
          f = f + at.r[e] * at.r[e];
          along = along + at.r[e] * at.first[e];
          speed = speed + at.first[e] * at.first[e];
          bend = bend + at.r[e] * at.second[e];
        });
        goes_on = goes_on & (f < best);
        best = Choose(goes_on, f, best);
        best_t = Choose(goes_on, t, best_t);
        constexpr double kLeast = 0.1;
        constexpr double kWorth = 1e-6;  // of f: what a step must lower it by
        const Pack least = kLeast * speed, whole = speed + bend;
        const Pack denominator = Choose(least < whole, whole, least);
        const Pack move = along / denominator;
        goes_on = goes_on & (zero < denominator) & (kWorth * f < along * move);
        const Pack next = t - move;
        t = Choose(goes_on, Choose(next < low, low, Choose(high < next, high, next)), t);
      }
      double found[kRowPack];
      best_t.StoreAll(found);
      for (int lane = 0; lane < pack.count; ++lane) {
        const std::ptrdiff_t i = pack.points[lane];
        if (model.moves_[i] > 0.0) parameters[i] = found[lane];
      }
    });
  }

  /// g's of a point is C' . S (+ r . S' for kNewton, and what a loss adds), S the curve of the
  /// control points' steps. What eliminates t is computed anew: that is less than reading it.
  template <FootModelKind K, bool kBent, typename Pack>
  inline __attribute__((always_inline)) void MovePacks(int span, const double* step,
                                                       double* parameters) const {
    const int k = order(), d = dimension();
    double of_step[kSize];
    model.CurveOfSpan(span, step, of_step);
    const typename Base::template CurvePolynomials<Pack> moved(of_step, k * d);
    const auto curve = this->template CurveOf<Pack>(span);
    const bool wraps = model.basis_.periodic();
    const double begin = model.basis_.domain_begin(), end = model.basis_.domain_end();
    Pack decrease(0.0);
    this->template ForEachPack<Pack>(span, [&](const PointPack<Pack>& pack) {
      AtPoints<Pack> at;
      this->EvaluateCurve(curve, pack, &at);
      if constexpr (kBent) this->EvaluateLoss(pack, &at);
      const auto elimination = this->template Eliminate<K, kBent>(at, pack);
      const Pack& along = elimination.along;
      Pack product = along;
      this->ForEachCoordinate([&](int e) {
        Pack value(0.0), slope(0.0);
        this->ForEachFunction([&](int stage) {
          const Pack& coefficient = moved.coefficients[(k - 1 - stage) * d + e];
          slope = stage < 2 ? value : slope * pack.u + value;
          value = stage < 1 ? coefficient : value * pack.u + coefficient;
        });
        product = product + at.first[e] * value;
        if constexpr (K == FootModelKind::kNewton) product = product + at.r[e] * slope;
        if constexpr (kBent) product = product + at.loss_bend * along * at.r[e] * value;
      });
      const Pack inverse = elimination.Divided(Pack(1.0));
      const Pack move = product * inverse;
      const Pack of_model = along * along * inverse;
      const Pack scale = model.damping_ * elimination.damped;
      decrease = decrease + pack.weight * (of_model + scale * move * move);
      double moves[kRowPack];
      move.StoreAll(moves);
      double reached[kRowPack];
      (pack.t - move).StoreAll(reached);
      for (int lane = 0; lane < pack.count; ++lane) {
        if (moves[lane] == 0.0 && !model.moves_all()) continue;
        const double t = reached[lane];
        // In the domain the next pass reads it where it is.
        const bool is_inside = begin <= t && t < end;
        parameters[pack.points[lane]] = is_inside || !wraps ? t : model.basis_.Wrap(t);
      }
    });
    model.span_decreases_[span] = decrease.Sum();
  }
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_FOOT_MODEL_STEPS_H_
