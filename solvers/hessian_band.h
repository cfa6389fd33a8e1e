#ifndef BATTEN_SOLVERS_HESSIAN_BAND_H_
#define BATTEN_SOLVERS_HESSIAN_BAND_H_

#include <functional>
#include <vector>

#include "cost_functions/block_family.h"
#include "splines/bspline_basis.h"
#include "splines/normal_band.h"

namespace batten {

/// The second derivatives of terms in the control points of a curve, in their band (blocks of
/// d x d), whatever the terms are. Control points further apart than a residual block reaches do
/// not meet: one product of the Hessian with a vector that has a 1 at all points of one colour
/// tells their columns at once (Curtis, Powell & Reid, J. IMA 13, 1974).
class HessianBand {
 public:
  /// Of terms in control points alone, which stand at x[offset]; `any` is any x.
  HessianBand(const BsplineBasis& basis, int dimension, int offset,
              std::vector<const BlockFamily*> terms, const Eigen::VectorXd& any);
  /// At x; `allow` is asked before each of num_products() products. kStop: it said no.
  Status Sum(const Eigen::VectorXd& x, const std::function<bool()>& allow);
  const NormalBand& band() const { return band_; }
  const RowShape& shape() const { return shape_; }  ///< Of band().
  int num_products() const { return num_colours_ * dimension_; }
  int dimension() const { return dimension_; }

 private:
  void MakeColours();
  /// Column (j, c) of the Hessian from its product with the vectors of the column's colour.
  void SetColumn(int j, int c, const Eigen::VectorXd& product);

  const BsplineBasis& basis_;
  int dimension_;
  int offset_;
  std::vector<const BlockFamily*> terms_;
  int reach_;  // the furthest neighbour a control point meets
  int num_colours_ = 0;
  std::vector<int> colours_;  // of the control points
  RowShape shape_;
  NormalBand band_;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_HESSIAN_BAND_H_
