#ifndef BATTEN_PROBLEMS_CURVE_VIEW_H_
#define BATTEN_PROBLEMS_CURVE_VIEW_H_

#include <memory>
#include <vector>

#include "problems/evaluation_monitor.h"
#include "problems/problem.h"
#include "splines/banded_rows.h"
#include "splines/normal_band.h"

namespace batten {

/// A problem all of whose terms are compiled rows, as geometric methods see it:
/// E(P) = ||A P - Q||^2 in n unknown points P of dimension d (x read row-major; of the points that
/// constraints leave, d = 1 where they bind coordinates unlike each other). Products are counted.
class CurveView {
 public:
  /// Null if some term has no rows, or constraints are not linear.
  static std::unique_ptr<CurveView> Make(const Problem& problem, EvaluationMonitor* monitor);
  /// The same of other rows in the problem's control points, such as its terms' with weights that a
  /// loss gives; they must outlive the view. Null too if one of them is null.
  static std::unique_ptr<CurveView> Make(const Problem& problem,
                                         std::vector<const RowSource*> sources,
                                         EvaluationMonitor* monitor);

  int num_points() const { return shape_.num_columns; }  // n
  int dimension() const { return shape_.dimension; }
  int num_rows() const { return shape_.num_rows; }  // m
  const RowShape& shape() const { return shape_; }

  /// The rows as they come from the functors; streaming them costs their evaluation, keeps nothing.
  const RowSource& row_source() const;
  /// The rows in memory, compiled at the first call.
  const BandedRows& rows() const;
  /// A'A and A'Q, summed at the first call in one stream over the rows, which `threads` share.
  const NormalBand& normal_band(int threads = 1) const;
  /// The same for the caller alone, who may overwrite it: whoever asks again has it summed again.
  NormalBand TakeNormalBand(int threads) const;

  /// residuals = Q - A P, m x d in row order. Counts one product.
  Status Residuals(const Eigen::VectorXd& x, Points* residuals);
  /// product = A'R. Counts one product.
  Status TransposedProduct(const Points& r, Eigen::VectorXd* product);
  /// product = N v, N = A'A. Counts one product.
  Status NormalProduct(const Eigen::VectorXd& v, Eigen::VectorXd* product);
  /// residual = A'(Q - A P), from the normal band. Counts one product.
  Status NormalResidual(const Eigen::VectorXd& x, Eigen::VectorXd* residual);
  /// Counts one product that a method does itself, row by row. False: it must not be done.
  bool AllowProduct(const Eigen::VectorXd& x) { return Allow(&x); }

 private:
  CurveView(RowShape shape, EvaluationMonitor* monitor) : shape_(shape), monitor_(monitor) {}
  bool Allow(const Eigen::VectorXd* x) {
    return monitor_ == nullptr || monitor_->Allow(Evaluation::kProduct, x);
  }

  RowShape shape_;
  EvaluationMonitor* monitor_;
  std::vector<const RowSource*> sources_;
  mutable std::unique_ptr<const BandedRows> rows_;
  mutable std::unique_ptr<NormalBand> band_;
};

}  // namespace batten

#endif  // BATTEN_PROBLEMS_CURVE_VIEW_H_
