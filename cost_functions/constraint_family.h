#ifndef BATTEN_COST_FUNCTIONS_CONSTRAINT_FAMILY_H_
#define BATTEN_COST_FUNCTIONS_CONSTRAINT_FAMILY_H_

#include <memory>
#include <string>

#include "cost_functions/block_family.h"

namespace batten {

/// Equations h_k(x) = 0 and inequalities h_k(x) >= 0 that a solution is to meet, k = 0..size()-1: a
/// family with one residual, h_k, in each block, of weight 1 and without loss. h is a length as
/// inside, where data are scaled to the unit box, or a number that is compared with 1.
class ConstraintFamily : public BlockFamily {
 public:
  int num_residuals() const final { return 1; }
  virtual bool is_inequality(int k) const = 0;
  /// As the user wrote it; several of one text may share it.
  virtual std::string name(int k) const = 0;
  /// weight * sum over k of (scales_k h_k + shifts_k)^2, of inequalities where that is negative
  /// only: what an augmented Lagrangian adds to E. It may outlive this family.
  virtual std::unique_ptr<BlockFamily> MakePenalty(double weight, const Eigen::VectorXd& scales,
                                                   const Eigen::VectorXd& shifts) const = 0;

 protected:
  explicit ConstraintFamily(double weight = 1.0) : BlockFamily(weight, nullptr) {}
};

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_CONSTRAINT_FAMILY_H_
