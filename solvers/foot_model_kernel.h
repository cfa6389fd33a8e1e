#ifndef BATTEN_SOLVERS_FOOT_MODEL_KERNEL_H_
#define BATTEN_SOLVERS_FOOT_MODEL_KERNEL_H_

// Included by foot_model.cc alone.

#include <algorithm>
#include <limits>

#include "solvers/foot_model_points.h"
#include "splines/processor.h"

namespace batten {

/// The passes over the points of a span, a pack of them at a time, in vectors of AVX2 where the
/// processor has them: the same bits with and without. P and D are -1 where they are known at run
/// time only.
template <int P, int D>
struct FootModel::Kernel : FootModel::SpanPoints<P, D> {
  using Base = SpanPoints<P, D>;
  using Base::dimension;
  using Base::kDimension;
  using Base::kOrder;
  using Base::kSize;
  using Base::kStatic;
  using Base::model;
  using Base::order;
  template <typename Pack>
  using PointPack = typename Base::template PointPack<Pack>;
  template <typename Pack>
  using AtPoints = typename Base::template AtPoints<Pack>;
  static constexpr int Pairs(int n) { return n * (n + 1) / 2; }

  /// Sums the model up over a span's points.
  void SumSpan(int span) const {
#if BATTEN_HAS_AVX2_KERNELS
    if (kStatic && HasAvx2()) return SumWide(span);
#endif
    SumBy<Pack>(span);
  }
  /// Parameters' steps of one span, and what they lower the model by.
  void MoveSpan(int span, const double* step, double* parameters) const {
#if BATTEN_HAS_AVX2_KERNELS
    if (kStatic && HasAvx2()) return MoveWide(span, step, parameters);
#endif
    MovePacks<Pack>(span, step, parameters);
  }
  /// Newton steps on f = |C(t) - Q|^2 of the span's points, inside the span.
  void ImproveSpan(int span, int steps, double* parameters) const {
#if BATTEN_HAS_AVX2_KERNELS
    if (kStatic && HasAvx2()) return ImproveWide(span, steps, parameters);
#endif
    ImprovePacks<Pack>(span, steps, parameters);
  }

 private:
  template <typename Pack>
  inline __attribute__((always_inline)) void SumBy(int span) const {
    if (model.kind_ != FootModelKind::kNewton) return SumTangent<Pack>(span);
    model.has_loss() ? SumNewton<true, Pack>(span) : SumNewton<false, Pack>(span);
  }
#if BATTEN_HAS_AVX2_KERNELS
  __attribute__((flatten, target("avx2"))) void SumWide(int span) const { SumBy<WidePack>(span); }
  __attribute__((flatten, target("avx2"))) void MoveWide(int span, const double* step,
                                                         double* parameters) const {
    MovePacks<WidePack>(span, step, parameters);
  }
  __attribute__((flatten, target("avx2"))) void ImproveWide(int span, int steps,
                                                            double* parameters) const {
    ImprovePacks<WidePack>(span, steps, parameters);
  }
#endif

  /// What both kinds of sums have in common.
  template <typename Pack>
  struct CommonSums {
    Pack energy{0.0};
    Pack gradient[kSize];
    Pack diagonal[kOrder];
  };
  template <typename Pack>
  inline __attribute__((always_inline)) void Clear(CommonSums<Pack>* common) const {
    std::fill_n(common->gradient, order() * dimension(), Pack(0.0));
    std::fill_n(common->diagonal, order(), Pack(0.0));
  }
  template <typename Pack>
  inline __attribute__((always_inline)) void Keep(int span, const CommonSums<Pack>& common) const {
    const int size = order() * dimension();
    double* gradient = model.SpanSums(span) + size * size;
    for (int x = 0; x < size; ++x) gradient[x] = common.gradient[x].Sum();
    for (int j = 0; j < order(); ++j) gradient[size + j] = common.diagonal[j].Sum();
    model.span_energies_[span] = common.energy.Sum();
  }

  /// Calls body with what is known at each pack of points, w, w times the factor a of g g', and
  /// C' . r.
  template <bool kBent, typename Pack, typename Body>
  inline __attribute__((always_inline)) void ForEachEliminated(int span, const Body& body) const {
    this->template ForEachPack<Pack>(span, [&](const PointPack<Pack>& pack) {
      AtPoints<Pack> at;
      this->EvaluateCurve(span, pack, &at);
      this->EvaluateBasis(span, pack, &at);
      Pack along;
      if constexpr (kBent) this->EvaluateLoss(pack, &at);
      const Pack a = this->template Eliminate<kBent>(at, pack, &along);
      body(at, pack.weight, pack.weight * a, along);
    });
  }

  /// B B' (x) M with M = w (I - a C' C''): the products of basis functions times M's upper
  /// triangle.
  template <typename Pack>
  inline __attribute__((always_inline)) void SumTangent(int span) const {
    const int k = order(), d = dimension(), size = k * d, num_entries = Pairs(d);
    Pack blocks[Pairs(kOrder) * Pairs(kDimension)];
    std::fill_n(blocks, Pairs(k) * num_entries, Pack(0.0));
    CommonSums<Pack> common;
    Clear(&common);
    ForEachEliminated<false, Pack>(
        span, [&](const AtPoints<Pack>& at, const Pack& w, const Pack& wa, const Pack& along) {
          Pack m[Pairs(kDimension)], v[kDimension];
          for (int e = 0, entry = 0; e < d; ++e) {
            common.energy = common.energy + w * at.r[e] * at.r[e];
            v[e] = w * at.r[e] - wa * along * at.first[e];
            m[entry] = w - wa * at.first[e] * at.first[e];
            ++entry;
            for (int f = e + 1; f < d; ++f) m[entry++] = Pack(0.0) - wa * at.first[e] * at.first[f];
          }
          for (int j = 0, pair = 0; j < k; ++j) {
            common.diagonal[j] = common.diagonal[j] + w * at.basis[j] * at.basis[j];
            for (int e = 0; e < d; ++e) {
              common.gradient[j * d + e] = common.gradient[j * d + e] + at.basis[j] * v[e];
            }
            for (int l = j; l < k; ++l, ++pair) {
              const Pack product = at.basis[j] * at.basis[l];
              for (int entry = 0; entry < num_entries; ++entry) {
                Pack& sum = blocks[pair * num_entries + entry];
                sum = sum + product * m[entry];
              }
            }
          }
        });
    Keep(span, common);
    double* sums = model.SpanSums(span);
    for (int j = 0, pair = 0; j < k; ++j) {
      for (int l = j; l < k; ++l, ++pair) {
        for (int e = 0, entry = 0; e < d; ++e) {
          for (int f = e; f < d; ++f, ++entry) {
            const double sum = blocks[pair * num_entries + entry].Sum();
            sums[(j * d + e) * size + l * d + f] = sums[(j * d + f) * size + l * d + e] = sum;
          }
        }
      }
    }
  }

  /// w B B' (x) I - w a g g', g = B (x) C' + B' (x) r: the upper triangle of g g', and the products
  /// of basis functions apart. `kBent`: with the curvature of the loss.
  template <bool kBent, typename Pack>
  inline __attribute__((always_inline)) void SumNewton(int span) const {
    const int k = order(), d = dimension(), size = k * d;
    Pack triangle[Pairs(kSize)], products[Pairs(kOrder)];
    std::fill_n(triangle, Pairs(size), Pack(0.0));
    std::fill_n(products, Pairs(k), Pack(0.0));
    CommonSums<Pack> common;
    Clear(&common);
    ForEachEliminated<kBent, Pack>(
        span, [&](const AtPoints<Pack>& at, const Pack& w, const Pack& wa, const Pack& along) {
          for (int e = 0; e < d; ++e) common.energy = common.energy + w * at.r[e] * at.r[e];
          Pack g[kSize];
          for (int j = 0; j < k; ++j) {
            for (int e = 0; e < d; ++e) {
              Pack& entry = g[j * d + e];
              entry = at.basis[j] * at.first[e] + at.slope[j] * at.r[e];
              if constexpr (kBent) entry = entry + at.loss_bend * along * at.basis[j] * at.r[e];
              common.gradient[j * d + e] =
                  common.gradient[j * d + e] + (w * at.basis[j] * at.r[e] - wa * along * entry);
            }
          }
          for (int j = 0, pair = 0; j < k; ++j) {
            const Pack weighted = w * at.basis[j];
            for (int l = j; l < k; ++l, ++pair) {
              products[pair] = products[pair] + weighted * at.basis[l];
            }
          }
          for (int x = 0, pair = 0; x < size; ++x) {
            const Pack factor = wa * g[x];
            for (int y = x; y < size; ++y, ++pair) triangle[pair] = triangle[pair] - factor * g[y];
          }
          if constexpr (kBent) this->AddLossBend(at, w * at.loss_bend, triangle);
        });
    double* sums = model.SpanSums(span);
    for (int x = 0, pair = 0; x < size; ++x) {
      for (int y = x; y < size; ++y, ++pair) sums[x * size + y] = triangle[pair].Sum();
    }
    for (int j = 0, pair = 0; j < k; ++j) {
      for (int l = j; l < k; ++l, ++pair) {
        const double product = products[pair].Sum();
        for (int e = 0; e < d; ++e) sums[(j * d + e) * size + l * d + e] += product;
        if (l == j) common.diagonal[j] = products[pair];
      }
    }
    Keep(span, common);
  }

  template <typename Pack>
  inline __attribute__((always_inline)) void ImprovePacks(int span, int steps,
                                                          double* parameters) const {
    const Pack low(model.basis_.knots()[model.basis_.first_span() + span]);
    const Pack high(model.basis_.knots()[model.basis_.first_span() + span + 1]);
    this->template ForEachPack<Pack>(span, [&](PointPack<Pack>& pack) {
      const Pack middle(model.middles_[span]), zero(0.0);
      Pack best(std::numeric_limits<double>::infinity()), t = pack.t, best_t = pack.t;
      typename Pack::Mask goes_on = zero < Pack::Gather(model.moves_.data(), pack.points, 1);
      for (int step = 0; step <= steps && Any(goes_on); ++step) {
        AtPoints<Pack> at;
        pack.u = t - middle;
        this->EvaluateCurve(span, pack, &at);
        Pack f(0.0), along(0.0), speed(0.0), bend(0.0);
        for (int e = 0; e < dimension(); ++e) {
          f = f + at.r[e] * at.r[e];
          along = along + at.r[e] * at.first[e];
          speed = speed + at.first[e] * at.first[e];
          bend = bend + at.r[e] * at.second[e];
        }
        goes_on = goes_on & (f < best);
        best = Choose(goes_on, f, best);
        best_t = Choose(goes_on, t, best_t);
        constexpr double kLeast = 0.1;
        const Pack least = kLeast * speed, whole = speed + bend;
        const Pack denominator = Choose(least < whole, whole, least);
        goes_on = goes_on & (zero < denominator);
        const Pack next = t - along / denominator;
        t = Choose(goes_on, Choose(next < low, low, Choose(high < next, high, next)), t);
      }
      double found[kRowPack];
      best_t.StoreFirst(found, kRowPack);
      for (int lane = 0; lane < pack.count; ++lane) {
        const std::ptrdiff_t i = pack.points[lane];
        if (model.moves_[i] > 0.0) parameters[i] = found[lane];
      }
    });
  }

  /// g's of a point is C' . S (+ r . S' for kNewton, and what a loss adds), S the curve of the
  /// control points' steps.
  template <typename Pack>
  inline __attribute__((always_inline)) void MovePacks(int span, const double* step,
                                                       double* parameters) const {
    const int k = order(), d = dimension();
    const bool is_newton = model.kind_ == FootModelKind::kNewton;
    const bool is_bent = is_newton && model.has_loss();
    double moved[kSize];
    model.CurveOfSpan(span, step, moved);
    Pack decrease(0.0);
    this->template ForEachPack<Pack>(span, [&](const PointPack<Pack>& pack) {
      const Pack along = Pack::LoadFirst(&model.along_[pack.place], pack.count);
      const Pack denominator = Pack::LoadFirst(&model.denominators_[pack.place], pack.count);
      AtPoints<Pack> at;
      this->EvaluateCurve(span, pack, &at);
      if (is_bent) this->EvaluateLoss(pack, &at);
      Pack product = along;
      for (int e = 0; e < d; ++e) {
        Pack value(moved[(k - 1) * d + e]), slope(0.0);
        for (int power = k - 2; power >= 0; --power) {
          slope = slope * pack.u + value;
          value = value * pack.u + moved[power * d + e];
        }
        product = product + at.first[e] * value;
        if (is_newton) product = product + at.r[e] * slope;
        if (is_bent) product = product + at.loss_bend * along * at.r[e] * value;
      }
      const Pack zero(0.0);
      const typename Pack::Mask moves = (zero < denominator) | (denominator < zero);
      const Pack move = Choose(moves, zero - product / denominator, zero);
      const Pack of_model = pack.weight * along * along / denominator;
      const Pack scale = Pack::LoadFirst(&model.scales_[pack.place], pack.count);
      decrease = decrease + Choose(moves, of_model + scale * move * move, zero);
      double reached[kRowPack], divided[kRowPack];
      (pack.t + move).StoreFirst(reached, kRowPack);
      denominator.StoreFirst(divided, kRowPack);
      for (int lane = 0; lane < pack.count; ++lane) {
        if (divided[lane] != 0.0) parameters[pack.points[lane]] = reached[lane];
      }
    });
    model.span_decreases_[span] = decrease.Sum();
  }
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_FOOT_MODEL_KERNEL_H_
