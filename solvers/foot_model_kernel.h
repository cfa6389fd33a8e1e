#ifndef BATTEN_SOLVERS_FOOT_MODEL_KERNEL_H_
#define BATTEN_SOLVERS_FOOT_MODEL_KERNEL_H_

// Included by foot_model.cc alone.

#include <algorithm>

#include "solvers/foot_model_steps.h"
#include "splines/processor.h"

namespace batten {

/// The passes over the points of a span, a pack of them at a time, in vectors of AVX2 where the
/// processor has them: the same bits with and without. P and D are -1 where they are known at run
/// time only.
template <int P, int D>
struct FootModel::Kernel : FootModel::SpanSteps<P, D> {
  using Base = SpanSteps<P, D>;
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
    this->template ImprovePacks<Pack>(span, steps, parameters);
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
        return this->template MovePacks<FootModelKind::kPoint, false, Pack>(span, step, parameters);
      case FootModelKind::kTangent:
        return this->template MovePacks<FootModelKind::kTangent, false, Pack>(span, step,
                                                                              parameters);
      case FootModelKind::kCurvature:
        return this->template MovePacks<FootModelKind::kCurvature, false, Pack>(span, step,
                                                                                parameters);
      case FootModelKind::kNewton:
        model.has_loss()
            ? this->template MovePacks<FootModelKind::kNewton, true, Pack>(span, step, parameters)
            : this->template MovePacks<FootModelKind::kNewton, false, Pack>(span, step, parameters);
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
    this->template ImprovePacks<WidePack>(span, steps, parameters);
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
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_FOOT_MODEL_KERNEL_H_
