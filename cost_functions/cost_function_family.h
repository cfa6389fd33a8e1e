#ifndef BATTEN_COST_FUNCTIONS_COST_FUNCTION_FAMILY_H_
#define BATTEN_COST_FUNCTIONS_COST_FUNCTION_FAMILY_H_

#include <memory>
#include <vector>

#include "cost_functions/block_family.h"

namespace batten {

/// Plain Ceres cost functions as a family: the way in for residuals that are no functor over sites
/// of a curve, such as the test functions in problems/test_functions.h.
///
/// Energy, gradient, residuals and Jacobian are as exact as the cost functions' own derivatives.
/// @warning Hessian products are not: a Ceres cost function has no second derivatives. They are
/// central differences of the gradient along the direction, right to about 2/3 of the digits where
/// variables and curvature are of size 1 (as in problems scaled to the unit box), and cost two
/// gradients each.
class CostFunctionFamily final : public BlockFamily {
 public:
  explicit CostFunctionFamily(double weight = 1.0,
                              std::shared_ptr<const ceres::LossFunction> loss = nullptr)
      : BlockFamily(weight, std::move(loss)) {}

  /// Block size(): parameter block k of `cost` stands at x[offsets[k]], and the parameter blocks of
  /// one cost function must not overlap. All blocks have the same number of residuals.
  void AddBlock(std::unique_ptr<ceres::CostFunction> cost, std::vector<int> offsets);

  int size() const override { return static_cast<int>(blocks_.size()); }
  int num_residuals() const override;  ///< 0 as long as there is no block.
  void Bind(const Eigen::VectorXd& x, int block, std::vector<int>* offsets,
            std::vector<int>* sizes) const override;
  std::unique_ptr<ceres::CostFunction> MakeCeresCostFunction(const Eigen::VectorXd& x,
                                                             int block) const override;

 private:
  struct Block {
    std::shared_ptr<const ceres::CostFunction> cost;
    std::vector<int> offsets;
  };
  struct Workspace;

  bool EvaluateBlock(const Eigen::VectorXd& x, int block, bool with_jacobian,
                     Workspace* workspace) const;
  /// Largest |v_i| among the variables i that blocks depend on.
  double LargestOfBlocks(const Eigen::VectorXd& v) const;

  bool DoEvaluate(const Eigen::VectorXd& x, int begin, int end, double* energy,
                  Eigen::VectorXd* gradient) const override;
  bool DoResiduals(const Eigen::VectorXd& x, Eigen::VectorXd* residuals) const override;
  bool DoJacobian(const Eigen::VectorXd& x, int first_row,
                  std::vector<Eigen::Triplet<double>>* entries) const override;
  bool DoAddHessianTimes(const Eigen::VectorXd& x, const Eigen::VectorXd& direction,
                         Eigen::VectorXd* product) const override;

  std::vector<Block> blocks_;
};

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_COST_FUNCTION_FAMILY_H_
