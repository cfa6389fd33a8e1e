#ifndef BATTEN_COST_FUNCTIONS_ORDERED_FAMILY_H_
#define BATTEN_COST_FUNCTIONS_ORDERED_FAMILY_H_

#include <memory>
#include <utility>
#include <vector>

#include "cost_functions/block_family.h"
#include "cost_functions/fit_setting.h"
#include "cost_functions/ordered_parameters.h"

namespace batten {

/// A family with free parameters whose order is kept: its parameters are the ordered ones nearest
/// to the variables, E(P, t(s)). Points that would pass each other thus share one t. Its gradient
/// is less the steepest descent from s = t, where E(P, t(s)) has a kink: 0 at minima over ordered t
/// only. Elsewhere (s where t(s) pools points, or past an end of an open curve) no step is felt
/// that does not move their mean: Seat puts s there. The Jacobian is that by t, the Hessian that of
/// points that stay together. Ends that are held are those of the domain, where others stop anyway.
class OrderedFamily final : public BlockFamily {
 public:
  OrderedFamily(const FitSetting& setting, std::unique_ptr<BlockFamily> inner,
                std::shared_ptr<const ceres::LossFunction> loss)
      : BlockFamily(inner->weight(), std::move(loss)),
        inner_(std::move(inner)),
        begin_(setting.parameter_offset + (setting.ends_held ? 1 : 0)),
        count_(inner_->size() - (setting.ends_held ? 2 : 0)),
        basis_(setting.basis) {}

  int size() const override { return inner_->size(); }
  int num_residuals() const override { return inner_->num_residuals(); }
  bool keeps_order() const override { return true; }
  bool seats() const override { return true; }
  void Seat(Eigen::VectorXd* x) const override;
  void KeepTogether(const Eigen::VectorXd& x, const Eigen::VectorXd& gradient,
                    Eigen::VectorXd* direction) const override;
  /// These two are as if the order did not matter: for those who ask keeps_order() first.
  void Bind(const Eigen::VectorXd& x, int block, std::vector<int>* offsets,
            std::vector<int>* sizes) const override;
  std::unique_ptr<ceres::CostFunction> MakeCeresCostFunction(const Eigen::VectorXd& x,
                                                             int block) const override;

 private:
  OrderedParameters Order(const Eigen::VectorXd& x) const {
    return OrderOnCurve(*basis_, x.segment(begin_, count_));
  }
  Eigen::VectorXd Ordered(const Eigen::VectorXd& x, const OrderedParameters& order) const;

  bool DoEvaluate(const Eigen::VectorXd& x, int begin, int end, double* energy,
                  Eigen::VectorXd* gradient) const override;
  bool DoResiduals(const Eigen::VectorXd& x, Eigen::VectorXd* residuals) const override;
  bool DoJacobian(const Eigen::VectorXd& x, int first_row,
                  std::vector<Eigen::Triplet<double>>* entries) const override;
  bool DoAddHessianTimes(const Eigen::VectorXd& x, const Eigen::VectorXd& direction,
                         Eigen::VectorXd* product) const override;

  std::unique_ptr<BlockFamily> inner_;
  int begin_;  // of the parameters that may move
  int count_;
  const BsplineBasis* basis_;
};

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_ORDERED_FAMILY_H_
