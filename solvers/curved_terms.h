#ifndef BATTEN_SOLVERS_CURVED_TERMS_H_
#define BATTEN_SOLVERS_CURVED_TERMS_H_

#include <optional>
#include <vector>

#include "problems/free_view.h"
#include "solvers/hessian_band.h"
#include "splines/normal_band.h"

namespace batten {

/// The terms of a free problem that are not affine or have a loss (FreeView::curved_terms), summed
/// into a model of E in the control points.
class CurvedTerms {
 public:
  explicit CurvedTerms(const FreeView& view);

  bool empty() const { return terms_.empty(); }
  /// Products with second derivatives that an exact sum takes.
  int num_products() const { return hessian_.has_value() ? hessian_->num_products() : 0; }
  /// Adds energy, half gradient and half Hessian at all variables x (`exact`: with second
  /// derivatives, else Gauss and Newton's J'J, weighed by rho' of losses), and to `diagonal` that
  /// of J'J, n d numbers. `band`: blocks of d x d, p + 1 to a row, cyclic where the curve is
  /// closed. False where E or a derivative is not finite; sums are then of no use.
  bool AddTo(const Eigen::VectorXd& x, bool exact, double* energy, Eigen::VectorXd* half_gradient,
             NormalBand* band, std::vector<double>* diagonal);

 private:
  /// `band` null: the diagonal alone.
  bool AddGaussNewton(const BlockFamily& term, const Eigen::VectorXd& x, NormalBand* band,
                      std::vector<double>* diagonal) const;
  void AddHessian(NormalBand* band) const;
  /// Of coordinates a and b, once for each pair.
  void AddEntry(int a, int b, double value, NormalBand* band) const;

  const BsplineBasis& basis_;
  const std::vector<const BlockFamily*>& terms_;
  int dimension_;
  int offset_;
  std::optional<HessianBand> hessian_;  // none: no terms
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_CURVED_TERMS_H_
