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
  /// Of entry (i, j), i <= j < n, in an upper triangle row by row.
  static constexpr int Place(int i, int j, int n) { return i * n - i * (i - 1) / 2 + j - i; }

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
    MoveBy<Pack>(span, step, parameters);
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
    switch (model.kind_) {
      case FootModelKind::kPoint:
        return SumTangent<FootModelKind::kPoint, Pack>(span);
      case FootModelKind::kTangent:
        return SumTangent<FootModelKind::kTangent, Pack>(span);
      case FootModelKind::kCurvature:
        return SumTangent<FootModelKind::kCurvature, Pack>(span);
      case FootModelKind::kNewton:
        model.has_loss() ? SumNewton<true, Pack>(span) : SumNewton<false, Pack>(span);
    }
  }
  template <typename Pack>
  inline __attribute__((always_inline)) void MoveBy(int span, const double* step,
                                                    double* parameters) const {
    switch (model.kind_) {
      case FootModelKind::kPoint:
        return MovePacks<FootModelKind::kPoint, false, Pack>(span, step, parameters);
      case FootModelKind::kTangent:
        return MovePacks<FootModelKind::kTangent, false, Pack>(span, step, parameters);
      case FootModelKind::kCurvature:
        return MovePacks<FootModelKind::kCurvature, false, Pack>(span, step, parameters);
      case FootModelKind::kNewton:
        model.has_loss() ? MovePacks<FootModelKind::kNewton, true, Pack>(span, step, parameters)
                         : MovePacks<FootModelKind::kNewton, false, Pack>(span, step, parameters);
    }
  }
#if BATTEN_HAS_AVX2_KERNELS
  __attribute__((flatten, target("avx2"))) void SumWide(int span) const { SumBy<WidePack>(span); }
  __attribute__((flatten, target("avx2"))) void MoveWide(int span, const double* step,
                                                         double* parameters) const {
    MoveBy<WidePack>(span, step, parameters);
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
  template <FootModelKind K, bool kBent, typename Pack, typename Body>
  inline __attribute__((always_inline)) void ForEachEliminated(int span, const Body& body) const {
    const auto curve = this->template CurveOf<Pack>(span);
    const auto basis = this->template BasisOf<Pack>(span);
    this->template ForEachPack<Pack>(span, [&](const PointPack<Pack>& pack) {
      AtPoints<Pack> at;
      this->EvaluateCurve(curve, pack, &at);
      this->EvaluateBasis(basis, pack, &at);
      if constexpr (kBent) this->EvaluateLoss(pack, &at);
      const auto elimination = this->template Eliminate<K, kBent>(at, pack);
      body(at, pack.weight, elimination.Divided(pack.weight), elimination.along);
    });
  }

  /// B B' (x) M with M = w (I - a C' C''): the products of basis functions times M's upper
  /// triangle.
  template <FootModelKind K, typename Pack>
  inline __attribute__((always_inline)) void SumTangent(int span) const {
    const int k = order(), d = dimension(), size = k * d, num_entries = Pairs(d);
    Pack blocks[Pairs(kOrder) * Pairs(kDimension)];
    std::fill_n(blocks, Pairs(k) * num_entries, Pack(0.0));
    CommonSums<Pack> common;
    Clear(&common);
    ForEachEliminated<K, false, Pack>(
        span, [&](const AtPoints<Pack>& at, const Pack& w, const Pack& wa, const Pack& along) {
          Pack m[Pairs(kDimension)], v[kDimension];
          this->ForEachCoordinate([&](int e) {
            const Pack weighted = w * at.r[e], slope = wa * at.first[e];
            common.energy = common.energy + weighted * at.r[e];
            v[e] = weighted - slope * along;
            m[Place(e, e, d)] = w - slope * at.first[e];
            this->ForEachCoordinate([&](int f) {
              if (f > e) m[Place(e, f, d)] = -(slope * at.first[f]);
            });
          });
          this->ForEachFunction([&](int j) {
            this->ForEachCoordinate([&](int e) {
              common.gradient[j * d + e] = common.gradient[j * d + e] + at.basis[j] * v[e];
            });
            this->ForEachFunction([&](int l) {
              if (l < j) return;
              const Pack product = at.basis[j] * at.basis[l];
              if (l == j) common.diagonal[j] = common.diagonal[j] + w * product;
              this->template ForEach<Pairs(kDimension)>(num_entries, [&](int entry) {
                Pack& sum = blocks[Place(j, l, k) * num_entries + entry];
                sum = sum + product * m[entry];
              });
            });
          });
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
    ForEachEliminated<FootModelKind::kNewton, kBent, Pack>(
        span, [&](const AtPoints<Pack>& at, const Pack& w, const Pack& wa, const Pack& along) {
          Pack g[kSize], weighted[kDimension];
          this->ForEachCoordinate([&](int e) {
            weighted[e] = w * at.r[e];
            common.energy = common.energy + weighted[e] * at.r[e];
          });
          const Pack drawn = wa * along;
          this->ForEachFunction([&](int j) {
            this->ForEachCoordinate([&](int e) {
              Pack entry = at.basis[j] * at.first[e] + at.slope[j] * at.r[e];
              if constexpr (kBent) entry = entry + at.loss_bend * along * at.basis[j] * at.r[e];
              common.gradient[j * d + e] =
                  common.gradient[j * d + e] + (at.basis[j] * weighted[e] - drawn * entry);
              g[j * d + e] = entry;
            });
            const Pack of_basis = w * at.basis[j];
            this->ForEachFunction([&](int l) {
              if (l < j) return;
              Pack& sum = products[Place(j, l, k)];
              sum = sum + of_basis * at.basis[l];
            });
          });
          this->template ForEach<kSize>(size, [&](int x) {
            const Pack factor = wa * g[x];
            this->template ForEach<kSize>(size, [&](int y) {
              if (y < x) return;
              Pack& sum = triangle[Place(x, y, size)];
              sum = sum - factor * g[y];
            });
          });
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
        if (moves[lane] != 0.0) parameters[pack.points[lane]] = reached[lane];
      }
    });
    model.span_decreases_[span] = decrease.Sum();
  }
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_FOOT_MODEL_KERNEL_H_
