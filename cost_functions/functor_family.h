#ifndef BATTEN_COST_FUNCTIONS_FUNCTOR_FAMILY_H_
#define BATTEN_COST_FUNCTIONS_FUNCTOR_FAMILY_H_

#include <glog/logging.h>

#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "cost_functions/functor_ceres.h"
#include "cost_functions/functor_kernel.h"
#include "cost_functions/loss.h"
#include "cost_functions/term.h"

namespace batten {

/// Whether a functor is compiled for one of the common pairs of sizes: all of them, unless it says
/// otherwise (CompiledFor).
template <typename Functor, typename = void>
struct CompiledSizes {
  static constexpr bool Have(int /*degree*/, int /*dimension*/) { return true; }
};
template <typename Functor>
struct CompiledSizes<Functor, std::void_t<decltype(Functor::CompiledFor(3, 2))>> {
  static constexpr bool Have(int degree, int dimension) {
    return Functor::CompiledFor(degree, dimension);
  }
};

/// Spreads one residual functor over its sites. A functor is a small copyable struct:
///
///   static TermInfo Info();                        // name, summary, source, options
///   static constexpr bool kAffine;                 // what TermInfo::affine becomes
///   static constexpr int kDerivatives;             // highest derivative of C it asks for
///   static constexpr int NumResiduals(int dimension);   // at most 16
///   static constexpr bool CompiledFor(int degree, int dimension);  // if not for all common sizes
///   explicit Functor(const OptionValues& options);
///   std::shared_ptr<const Sites> MakeSites(const FitSetting& setting) const;
///   template <typename SiteType, typename T>
///   bool operator()(const SiteType& site, const T* const* control_points, T* residuals) const;
///
/// control_points[j][c] is coordinate c of the span's j-th control point. False means that the
/// residual has no value there.
template <typename Functor>
class FunctorFamily final : public BlockFamily, private RowSource {
 public:
  FunctorFamily(const FitSetting& setting, Functor functor, double weight,
                std::shared_ptr<const ceres::LossFunction> loss)
      : BlockFamily(weight, std::move(loss)),
        setting_(setting),
        functor_(std::move(functor)),
        sites_(functor_.MakeSites(setting)),
        part_begins_(CutIntoParts(*setting.basis, *sites_)) {
    if constexpr (kMayHaveRows) rows_are_alike_ = RowsAreAlike();
  }

  int size() const override { return sites_->size; }
  int num_residuals() const override { return Functor::NumResiduals(setting_.dimension); }

  void Bind(const Eigen::VectorXd&, int block, std::vector<int>* offsets,
            std::vector<int>* sizes) const override {
    const BsplineBasis& basis = *setting_.basis;
    const int distinct = std::min(basis.order(), basis.num_control_points());
    const int first = SpanOf(block) - basis.degree();
    offsets->resize(static_cast<std::size_t>(distinct));
    sizes->assign(static_cast<std::size_t>(distinct), setting_.dimension);
    for (int j = 0; j < distinct; ++j) {
      (*offsets)[static_cast<std::size_t>(j)] =
          setting_.control_point_offset + basis.ControlPointIndex(first + j) * setting_.dimension;
    }
  }

  const RowSource* rows_without_loss() const override { return rows_are_alike_ ? this : nullptr; }

  std::unique_ptr<ceres::CostFunction> MakeCeresCostFunction(const Eigen::VectorXd& /*x*/,
                                                             int block) const override {
    return WithKernel([&](const auto& kernel) {
      return MakeFunctorCostFunction(functor_, kernel.MakeSite(block, SpanOf(block)),
                                     *setting_.basis, setting_.dimension);
    });
  }

 private:
  /// Rows are compiled one coordinate at a time: one residual each.
  static constexpr bool kMayHaveRows = Functor::kAffine && Functor::NumResiduals(1) == 1;

  /// The kernel for sizes known at run time only. Besides terms of few sites it serves all that is
  /// not asked for again and again: each pair of sizes takes the compiler seconds per term.
  using AnyKernel = FunctorKernel<Functor, -1, -1>;
  AnyKernel MakeAnyKernel() const { return AnyKernel(setting_, *sites_, functor_); }

  /// Calls body with the kernel of the sizes at hand: compiled for the common ones.
  template <typename Body>
  auto WithKernel(Body body) const {
    if (IsOfSizes<3, 2>()) return WithSizes<3, 2>(body);
#ifndef BATTEN_ONE_STATIC_SIZE  // under sanitizers each size takes the compiler up to a minute
    if (IsOfSizes<3, 1>()) return WithSizes<3, 1>(body);
    if (IsOfSizes<3, 3>()) return WithSizes<3, 3>(body);
    if (IsOfSizes<2, 2>()) return WithSizes<2, 2>(body);
    if (IsOfSizes<5, 2>()) return WithSizes<5, 2>(body);
#endif
    return body(MakeAnyKernel());
  }
  template <int P, int D>
  bool IsOfSizes() const {
    return setting_.use_static_sizes && setting_.basis->degree() == P && setting_.dimension == D;
  }
  template <int P, int D, typename Body>
  auto WithSizes(Body body) const {
    if constexpr (CompiledSizes<Functor>::Have(P, D)) {
      return body(FunctorKernel<Functor, P, D>(setting_, *sites_, functor_));
    } else {
      return body(MakeAnyKernel());
    }
  }

  int SpanOf(int block) const {
    const auto& groups = sites_->groups;
    return std::upper_bound(groups.begin(), groups.end(), block,
                            [](int site, const Sites::Group& g) { return site < g.end; })
        ->span;
  }

  bool DoEvaluate(const Eigen::VectorXd& x, int begin, int end, double* energy,
                  Eigen::VectorXd* gradient) const override {
    return WithKernel([&](const auto& kernel) {
      return gradient == nullptr ? kernel.Energy(x.data(), begin, end, weight(), loss(), energy)
                                 : kernel.EnergyAndGradient(x.data(), begin, end, weight(), loss(),
                                                            energy, gradient->data());
    });
  }

  bool DoResiduals(const Eigen::VectorXd& x, Eigen::VectorXd* residuals) const override {
    residuals->resize(static_cast<Eigen::Index>(size()) * num_residuals());
    const AnyKernel kernel = MakeAnyKernel();
    return kernel.ForEachSite(
        0, size(), [](const auto&) {},
        [&](const auto& site, int s, const auto& window) {
          return kernel.PlainResiduals(site, window, x.data(),
                                       residuals->data() + s * num_residuals());
        },
        [](const auto&) {});
  }

  bool DoJacobian(const Eigen::VectorXd& x, int first_row,
                  std::vector<Eigen::Triplet<double>>* entries) const override {
    const AnyKernel kernel = MakeAnyKernel();
    std::vector<double> residuals(static_cast<std::size_t>(num_residuals()));
    std::vector<double> jacobian(residuals.size() *
                                 static_cast<std::size_t>(kernel.num_variables()));
    return kernel.ForEachSite(
        0, size(), [](const auto&) {},
        [&](const auto& site, int s, const auto& window) {
          if (!kernel.ResidualsAndJacobian(site, window, x.data(), residuals.data(),
                                           jacobian.data())) {
            return false;
          }
          for (std::size_t e = 0; e < jacobian.size(); ++e) {
            const int row = static_cast<int>(e) / kernel.num_variables();
            const int v = static_cast<int>(e) % kernel.num_variables();
            entries->emplace_back(first_row + s * num_residuals() + row,
                                  window.offset[v / kernel.dimension()] + v % kernel.dimension(),
                                  jacobian[e]);
          }
          return true;
        },
        [](const auto&) {});
  }

  bool DoAddHessianTimes(const Eigen::VectorXd& x, const Eigen::VectorXd& direction,
                         Eigen::VectorXd* product) const override {
    const auto add = [&](const auto& kernel) {
      return kernel.AddHessianTimes(x.data(), direction.data(), weight(), loss(), product->data());
    };
    // An affine residual has its normal band, and comes here under a loss alone.
    if constexpr (Functor::kAffine) {
      return add(MakeAnyKernel());
    } else {
      return WithKernel(add);
    }
  }

  RowShape shape() const override {
    RowShape shape;
    shape.num_rows = size();
    shape.num_columns = setting_.basis->num_control_points();
    shape.width = setting_.basis->order();
    shape.dimension = setting_.dimension;
    shape.cyclic = setting_.basis->periodic();
    return shape;
  }
  void Stream(RowConsumer* consumer) const override {
    StreamGroups(0, static_cast<int>(sites_->groups.size()), consumer);
  }
  int num_parts() const override { return static_cast<int>(part_begins_.size()) - 1; }
  void StreamPart(int part, RowConsumer* consumer) const override {
    const auto k = static_cast<std::size_t>(part);
    StreamGroups(part_begins_[k], part_begins_[k + 1], consumer);
  }
  void StreamGroups(int first, int end, RowConsumer* consumer) const {
    if constexpr (kMayHaveRows) {
      WithKernel([&](const auto& kernel) {
        kernel.StreamRows(std::sqrt(weight()), first, end, consumer);
        return true;
      });
    }
  }

  /// Whether the residual's derivative really is one row for all coordinates: tried on the first
  /// and the last block. A functor that claims it wrongly is evaluated uncompiled.
  bool RowsAreAlike() const {
    const int d = setting_.dimension;
    if (num_residuals() != d || size() == 0) return false;
    const AnyKernel kernel = MakeAnyKernel();
    const int num_variables = kernel.num_variables();
    std::vector<double> residuals(static_cast<std::size_t>(d));
    std::vector<double> jacobian(static_cast<std::size_t>(d * num_variables));
    const Eigen::VectorXd x = Eigen::VectorXd::Zero(setting_.control_point_offset +
                                                    setting_.basis->num_control_points() * d);
    for (const int block : {0, size() - 1}) {
      const int span = SpanOf(block);
      const auto site = kernel.MakeSite(block, span);
      const auto window = kernel.MakeWindow(span);
      if (!kernel.ResidualsAndJacobian(site, window, x.data(), residuals.data(), jacobian.data()) ||
          !kernel.PlainResiduals(site, window, x.data(), residuals.data()) ||
          !IsSeenAlikeAlone(site, residuals)) {
        return false;
      }
      for (int r = 0; r < d; ++r) {
        for (int v = 0; v < num_variables; ++v) {
          const double alike = v % d == r ? jacobian[static_cast<std::size_t>(v - r)] : 0.0;
          if (jacobian[static_cast<std::size_t>(r * num_variables + v)] != alike) return false;
        }
      }
    }
    return true;
  }

  /// Whether the functor finds the same residuals at control points of zero when it sees each
  /// coordinate as a curve of its own, as it does while rows are compiled.
  template <typename SiteType>
  bool IsSeenAlikeAlone(SiteType site, const std::vector<double>& residuals) const {
    Site<double, -1, -1, Functor::kDerivatives> alone(site.degree(), 1);
    std::copy_n(site.mutable_basis(), (Functor::kDerivatives + 1) * (site.degree() + 1),
                alone.mutable_basis());
    alone.set_root_weight(site.root_weight());
    const double zero = 0.0;
    const std::vector<const double*> points(kMaxOrder, &zero);
    for (int c = 0; c < site.dimension(); ++c) {
      alone.mutable_point()[0] = site.point(c);
      double residual = 0.0;
      if (!functor_(alone, points.data(), &residual)) return false;
      if (residual != residuals[static_cast<std::size_t>(c)]) return false;
    }
    return true;
  }

  FitSetting setting_;
  Functor functor_;
  std::shared_ptr<const Sites> sites_;
  std::vector<int> part_begins_;
  bool rows_are_alike_ = false;
};

/// Registers a functor as a term.
template <typename Functor>
class FunctorTerm final : public Term {
 public:
  TermInfo Info() const override {
    TermInfo info = Functor::Info();
    info.affine = Functor::kAffine;
    return info;
  }
  std::unique_ptr<BlockFamily> MakeFamily(const FitSetting& setting, const OptionValues& options,
                                          std::string* /*error*/) const override {
    return std::make_unique<FunctorFamily<Functor>>(
        setting, Functor(options), options.Real("weight"), MakeLoss(options, setting.size));
  }
};

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_FUNCTOR_FAMILY_H_
