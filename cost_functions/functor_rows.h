#ifndef BATTEN_COST_FUNCTIONS_FUNCTOR_ROWS_H_
#define BATTEN_COST_FUNCTIONS_FUNCTOR_ROWS_H_

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <type_traits>

#include "cost_functions/affine_form.h"
#include "cost_functions/fit_setting.h"
#include "cost_functions/pack.h"
#include "cost_functions/site.h"
#include "splines/basis_derivative.h"
#include "splines/basis_functions.h"
#include "splines/processor.h"

namespace batten {

/// Whether a functor says (kOnlyHighestDerivative) that of its site it asks for the derivative of
/// order kDerivatives and no other.
template <typename Functor, typename = void>
struct AsksForOneDerivative : std::false_type {};
template <typename Functor>
struct AsksForOneDerivative<Functor, std::enable_if_t<Functor::kOnlyHighestDerivative>>
    : std::true_type {};

/// The basis functions of one span, in the derivatives that the functor asks for; P as in
/// FunctorKernel, Constant as in SpanBasis.
template <typename Functor, int P, typename Constant>
class SpanOfFunctor {
 public:
  static constexpr int kDerivatives = Functor::kDerivatives;
  static constexpr bool kOneDerivative = kDerivatives > 0 && AsksForOneDerivative<Functor>::value;

  SpanOfFunctor(const BsplineBasis& basis, int span)
      : degree_(basis.degree()),
        knots_(basis.knots().data()),
        span_(span),
        prepared_(degree_, knots_, span) {}

  template <typename T>
  inline __attribute__((always_inline)) void Evaluate(const T& t, T* values) const {
    if constexpr (kOneDerivative) {
      prepared_.Evaluate(t, values + kDerivatives * (degree() + 1));
    } else if constexpr (kDerivatives == 0) {
      prepared_.Evaluate(t, values);
    } else {
      EvaluateBasisDerivatives<P>(degree(), knots_, span_, t, kDerivatives, values);
    }
  }

 private:
  struct Nothing {
    Nothing(int /*degree*/, const double* /*knots*/, int /*span*/) {}
  };
  using Prepared = std::conditional_t<
      kDerivatives == 0, SpanBasis<P, Constant>,
      std::conditional_t<kOneDerivative,
                         SpanBasisDerivative<P, std::max(kDerivatives, 1), Constant>, Nothing>>;
  int degree() const { return P >= 0 ? P : degree_; }

  int degree_;
  const double* knots_;
  int span_;
  Prepared prepared_;
};

/// The rows of an affine residual functor that are alike for all coordinates, read out of the
/// functor, kRowPack sites at a time; P and D as in FunctorKernel.
template <typename Functor, int P, int D>
class FunctorRows {
 public:
  FunctorRows(const FitSetting& setting, const Sites& sites, const Functor& functor)
      : setting_(setting), sites_(sites), basis_(*setting.basis), functor_(functor) {}

  /// Hands out the rows root_factor * (A, Q) of groups first_group..end_group-1, span by
  /// span.
  void Stream(double root_factor, int first_group, int end_group, RowConsumer* consumer) const {
#if BATTEN_HAS_AVX2_KERNELS
    // Terms with derivatives have few sites in a span, seldom a pack of them.
    if constexpr (kStatic && Functor::kDerivatives == 0) {
      if (HasAvx2()) return StreamIn<WidePack>(root_factor, first_group, end_group, consumer);
    }
#endif
    StreamIn<Pack>(root_factor, first_group, end_group, consumer);
  }
  /// The same bits on processors without AVX2, and in tests on others.
  void StreamOnAnyProcessor(double root_factor, int first_group, int end_group,
                            RowConsumer* consumer) const {
    StreamIn<Pack>(root_factor, first_group, end_group, consumer);
  }

 private:
  static constexpr bool kStatic = P >= 0;
  static constexpr int kOrderStorage = kStatic ? P + 1 : kMaxOrder;
  static constexpr int kDimensionStorage = kStatic ? D : kMaxDimension;
  template <typename PackType>
  using Form = AffineForm<PackType, kOrderStorage>;
  using PlainForm = AffineForm<double, kOrderStorage>;
  template <typename PackType>
  using Span = SpanOfFunctor<Functor, P, PackType>;

  int order() const { return kStatic ? P + 1 : basis_.order(); }
  int dimension() const { return kStatic ? D : setting_.dimension; }

  template <typename PackType>
  void StreamIn(double root_factor, int first_group, int end_group, RowConsumer* consumer) const {
    Form<PackType> variables[kOrderStorage];
    const Form<PackType>* points[kOrderStorage];
    PlainForm few_variables[kOrderStorage];
    const PlainForm* few_points[kOrderStorage];
    for (int j = 0; j < order(); ++j) {
      variables[j] = Form<PackType>::Variable(j);
      points[j] = &variables[j];
      few_variables[j] = PlainForm::Variable(j);
      few_points[j] = &few_variables[j];
    }
    // Right-hand sides behind the coefficients: consumers have their fastest loops for that.
    alignas(32) double rows[(kOrderStorage + kDimensionStorage) * kMaxRowsPerBlock];
    int lanes_in_use = kRowPack;
    for (int g = first_group; g < end_group; ++g) {
      const Sites::Group& group = sites_.groups[static_cast<std::size_t>(g)];
      const int size = group.end - group.begin;
      if (size < kRowPack) {
        // Lanes without a row are zero: they stay so while no block has fewer rows than the last.
        if (size < lanes_in_use) std::fill_n(rows, (order() + dimension()) * kRowPack, 0.0);
        lanes_in_use = size;
        consumer->Consume(FillFew(group, root_factor, few_points, rows));
        continue;
      }
      lanes_in_use = kRowPack;
      const Span<PackType> span(basis_, group.span);
      for (int begin = group.begin; begin < group.end; begin += kMaxRowsPerBlock) {
        RowBlock block;
        block.first_column = basis_.ControlPointIndex(group.span - basis_.degree());
        block.num_rows = std::min(kMaxRowsPerBlock, group.end - begin);
        block.stride = (block.num_rows + kRowPack - 1) / kRowPack * kRowPack;
        double* const right_hand_sides = rows + order() * block.stride;
        block.coefficients = rows;
        block.right_hand_sides = right_hand_sides;
        FillRows(span, points, begin, block, root_factor, rows, right_hand_sides);
        consumer->Consume(block);
      }
    }
  }

  /// The block of a span with fewer sites than a pack has, one after the other in plain numbers: a
  /// smoothing spline has one or two in each of its spans, for which packs cost twice as much.
  /// Lanes of `rows` without a row must be zero.
  __attribute__((flatten)) RowBlock FillFew(const Sites::Group& group, double root_factor,
                                            const PlainForm* const* points, double* rows) const {
    RowBlock block;
    block.first_column = basis_.ControlPointIndex(group.span - basis_.degree());
    block.num_rows = group.end - group.begin;
    block.stride = kRowPack;
    block.coefficients = rows;
    block.right_hand_sides = rows + order() * kRowPack;
    Site<double, P, kStatic ? 1 : -1, Functor::kDerivatives> site(basis_.degree(), 1);
    site.set_variables(points);
    const Span<double> span(basis_, group.span);
    for (int i = 0; i < block.num_rows; ++i) {
      const int item = sites_.item(group.begin + i);
      span.Evaluate(sites_.parameters[item], site.mutable_basis());
      site.set_root_weight(sites_.weights == nullptr ? 1.0 : std::sqrt(sites_.weights[item]));
      PlainForm result;
      for (int c = 0; c < dimension(); ++c) {
        double point = 0.0;
        if (sites_.points != nullptr) {
          const double center = setting_.Origin(sites_, c);
          point = (sites_.points[static_cast<std::ptrdiff_t>(item) * dimension() + c] - center) *
                  setting_.scale;
        }
        // Without data a site is the same for all coordinates.
        if (c == 0 || sites_.points != nullptr) {
          site.mutable_point()[0] = point;
          functor_(site, points, &result);
        }
        rows[(order() + c) * kRowPack + i] = -result.constant * root_factor;
      }
      for (int j = 0; j < order(); ++j) {
        rows[j * kRowPack + i] = result.coefficient[j] * root_factor;
      }
    }
    return block;
  }

  /// Products with weights and factors that are 1 are left out when compiling, not when running.
  template <typename PackType>
  void FillRows(const Span<PackType>& span, const Form<PackType>* const* points, int begin,
                const RowBlock& block, double root_factor, double* coefficients,
                double* right_hand_sides) const {
    if (sites_.weights == nullptr) {
      FillRowsWith<false>(span, points, begin, block, coefficients, right_hand_sides);
    } else {
      FillRowsWith<true>(span, points, begin, block, coefficients, right_hand_sides);
    }
    if (root_factor == 1.0) return;
    for (int k = 0; k < order() * block.stride; ++k) coefficients[k] *= root_factor;
    for (int k = 0; k < dimension() * block.stride; ++k) right_hand_sides[k] *= root_factor;
  }

  /// Flattened: with the basis and the functor called for each pack, rows cost twice as much.
  template <bool kWeighted>
  __attribute__((flatten)) void FillRowsWith(const Span<Pack>& span,
                                             const Form<Pack>* const* points, int begin,
                                             const RowBlock& block, double* coefficients,
                                             double* right_hand_sides) const {
    FillPacks<kWeighted>(span, points, begin, block, coefficients, right_hand_sides);
  }
#if BATTEN_HAS_AVX2_KERNELS
  template <bool kWeighted>
  __attribute__((flatten, target("avx2"))) void FillRowsWith(const Span<WidePack>& span,
                                                             const Form<WidePack>* const* points,
                                                             int begin, const RowBlock& block,
                                                             double* coefficients,
                                                             double* right_hand_sides) const {
    FillPacks<kWeighted>(span, points, begin, block, coefficients, right_hand_sides);
  }
#endif

  template <bool kWeighted, typename PackType>
  inline __attribute__((always_inline)) void FillPacks(const Span<PackType>& span,
                                                       const Form<PackType>* const* points,
                                                       int begin, const RowBlock& block,
                                                       double* coefficients,
                                                       double* right_hand_sides) const {
    // Read once: what is written in between could be the same numbers, as far as compilers know.
    PackType origin[kDimensionStorage];
    for (int c = 0; c < dimension(); ++c) origin[c] = PackType(setting_.Origin(sites_, c));
    const PackType scale(setting_.scale);
    // Whole packs of neighbours in memory first; then the rest, a lane at a time.
    const int in_a_row = sites_.order.empty() ? block.num_rows / kRowPack * kRowPack : 0;
    for (int first = 0; first < in_a_row; first += kRowPack) {
      Prefetch(begin + first);
      FillPack<true, kWeighted>(span, points, begin + first, 0, origin, scale, block.stride,
                                coefficients + first, right_hand_sides + first);
    }
    for (int first = in_a_row; first < block.stride; first += kRowPack) {
      FillPack<false, kWeighted>(span, points, begin + first, begin + block.num_rows - 1, origin,
                                 scale, block.stride, coefficients + first,
                                 right_hand_sides + first);
    }
    for (int i = block.num_rows; i < block.stride; ++i) {
      for (int j = 0; j < order(); ++j) coefficients[j * block.stride + i] = 0.0;
      for (int c = 0; c < dimension(); ++c) right_hand_sides[c * block.stride + i] = 0.0;
    }
  }

  /// What is read of the sites a few spans further on: between two spans their products are summed
  /// up, and the processor by itself does not go on reading meanwhile, nor past the end of a page.
  inline __attribute__((always_inline)) void Prefetch(int site) const {
    constexpr std::ptrdiff_t kAhead = 256;
    __builtin_prefetch(sites_.parameters + site + kAhead);
    if (sites_.points != nullptr) {
      __builtin_prefetch(sites_.points + (site + kAhead) * dimension());
    }
  }

  /// Entries of the sites first..first+kRowPack-1; those past `last` repeat it.
  template <typename PackType, bool kInARow>
  PackType Collect(const double* source, std::ptrdiff_t step, int first, int last) const {
    if constexpr (kInARow) {
      return PackType::Gather(source + first * step, step);
    } else {
      std::ptrdiff_t item[kRowPack];
      for (int i = 0; i < kRowPack; ++i) item[i] = sites_.item(std::min(first + i, last));
      return PackType::Gather(source, item, step);
    }
  }

  /// The rows of kRowPack sites. Coordinate by coordinate the functor sees a curve with one
  /// coordinate, whose control point j is the variable x_j.
  template <bool kInARow, bool kWeighted, typename PackType>
  inline __attribute__((always_inline)) void FillPack(const Span<PackType>& span,
                                                      const Form<PackType>* const* points,
                                                      int first, int last, const PackType* origin,
                                                      const PackType& scale, int stride,
                                                      double* coefficients,
                                                      double* right_hand_sides) const {
    Site<PackType, P, kStatic ? 1 : -1, Functor::kDerivatives> site(basis_.degree(), 1);
    const auto t = Collect<PackType, kInARow>(sites_.parameters, 1, first, last);
    span.Evaluate(t, site.mutable_basis());
    PackType root(1.0);
    if constexpr (kWeighted) {
      root = Collect<PackType, kInARow>(sites_.weights, 1, first, last);
      root = root.Map([](double weight) { return std::sqrt(weight); });
    }
    site.set_root_weight(root);
    site.set_variables(points);
    Form<PackType> result;
    for (int c = 0; c < dimension(); ++c) {
      PackType point(0.0);
      if (sites_.points != nullptr) {
        point =
            (Collect<PackType, kInARow>(sites_.points + c, dimension(), first, last) - origin[c]) *
            scale;
      }
      site.mutable_point()[0] = point;
      functor_(site, points, &result);
      (-result.constant).Store(right_hand_sides + c * stride);
    }
    for (int j = 0; j < order(); ++j) {
      result.coefficient[j].Store(coefficients + j * stride);
    }
  }

  const FitSetting& setting_;
  const Sites& sites_;
  const BsplineBasis& basis_;
  const Functor& functor_;
};

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_FUNCTOR_ROWS_H_
