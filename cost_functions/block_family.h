#ifndef BATTEN_COST_FUNCTIONS_BLOCK_FAMILY_H_
#define BATTEN_COST_FUNCTIONS_BLOCK_FAMILY_H_

#include <ceres/cost_function.h>
#include <ceres/loss_function.h>

#include <Eigen/SparseCore>
#include <memory>
#include <vector>

#include "cost_functions/free_sites.h"
#include "splines/row_block.h"

namespace batten {

using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// kStop: leave now. kNonFinite: no number here; a line search may back up.
enum class Status { kOk, kStop, kNonFinite };

/// Where the variable that a block's binding depends on may go before Bind must be asked again.
struct BindingWindow {
  int variable = 0;
  double place = 0.0;  ///< The variable, in [low, high]: of closed curves moved by whole periods.
  double low = 0.0;
  double high = 0.0;
  /// No binding leads further on that side: it is an end of an open curve.
  bool low_is_end = false;
  bool high_is_end = false;
};

/// All residual blocks of one term, evaluated in loops rather than as single objects. Its energy is
///   weight * sum over blocks of rho(||r||^2)        (no factor 1/2)
/// with rho the loss, the identity if loss() is null. Blocks are numbered in the order of their
/// spans, 0..size()-1, each with num_residuals() residuals.
class BlockFamily {
 public:
  virtual ~BlockFamily() = default;

  virtual int size() const = 0;
  virtual int num_residuals() const = 0;
  double weight() const { return weight_; }
  const ceres::LossFunction* loss() const { return loss_.get(); }

  /// The distinct variable groups block `block` depends on at x: offsets into x, and their sizes.
  virtual void Bind(const Eigen::VectorXd& x, int block, std::vector<int>* offsets,
                    std::vector<int>* sizes) const = 0;

  /// Of the block bound at x. False, and *window as it was, where Bind does not depend on x.
  virtual bool Window(const Eigen::VectorXd& /*x*/, int /*block*/,
                      BindingWindow* /*window*/) const {
    return false;
  }

  /// Adds the energy of blocks begin..end-1 to *energy and, if `gradient` is not null, its gradient
  /// to *gradient; block by block in this order, so that partial sums are reproducible.
  Status Evaluate(const Eigen::VectorXd& x, int begin, int end, double* energy,
                  Eigen::VectorXd* gradient) const;

  /// Plain residuals of all blocks, before loss and weight: size() * num_residuals() numbers.
  Status Residuals(const Eigen::VectorXd& x, Eigen::VectorXd* residuals) const;
  /// Appends (row, column, derivative) of the plain residuals, rows numbered from first_row.
  Status Jacobian(const Eigen::VectorXd& x, int first_row,
                  std::vector<Eigen::Triplet<double>>* entries) const;
  /// Adds the second derivative of the energy times `direction` to *product: exact, with the
  /// curvature of residuals and loss.
  Status AddHessianTimes(const Eigen::VectorXd& x, const Eigen::VectorXd& direction,
                         Eigen::VectorXd* product) const;

  /// The rows sqrt(weight) * (A, Q), if every residual is affine in the control points, alike for
  /// all coordinates, and there is no loss; read from the functor's derivative. Null otherwise.
  const RowSource* rows() const { return loss_ == nullptr ? rows_without_loss() : nullptr; }
  /// The same of the plain residuals where there is a loss: block b is row b of each coordinate.
  virtual const RowSource* rows_without_loss() const { return nullptr; }

  /// The points behind the blocks, if their residuals are root(w_i) (C(t_i) - Q_i) with t_i a
  /// variable. Null otherwise.
  virtual const FreeSites* free_sites() const { return nullptr; }

  /// Whether blocks depend on each other's parameters, whose order is kept: single blocks as Ceres
  /// binds them do not know it.
  virtual bool keeps_order() const { return false; }
  /// Moves, at equal E, parameters among all variables x that E does not depend on to where it does
  /// if that lowers it: those whose order is kept to the ordered ones, those past an end of an open
  /// curve to the end if E draws them back, else a hair past it.
  virtual void Seat(Eigen::VectorXd* /*x*/) const {}
  virtual bool seats() const { return false; }  ///< Whether Seat does anything.
  /// Turns a direction from a seated x so that parameters which the gradient there keeps at one
  /// place (in order, at an end of an open curve) stay together: the slope of E along it is
  /// gradient . direction then. All three are of all variables.
  virtual void KeepTogether(const Eigen::VectorXd& /*x*/, const Eigen::VectorXd& /*gradient*/,
                            Eigen::VectorXd* /*direction*/) const {}

  /// Ceres' cost function of one block, its parameter blocks in the order of Bind at the same x,
  /// for as long as a variable with a Window stays there; the loss and weight are to be given to
  /// Ceres beside it.
  virtual std::unique_ptr<ceres::CostFunction> MakeCeresCostFunction(const Eigen::VectorXd& x,
                                                                     int block) const = 0;
  /// weight * loss for ceres::Problem, null where both are trivial. Each call makes a new one.
  std::unique_ptr<ceres::LossFunction> MakeCeresLoss() const;

 protected:
  BlockFamily(double weight, std::shared_ptr<const ceres::LossFunction> loss)
      : weight_(weight), loss_(std::move(loss)) {}

 private:
  virtual bool DoEvaluate(const Eigen::VectorXd& x, int begin, int end, double* energy,
                          Eigen::VectorXd* gradient) const = 0;
  virtual bool DoResiduals(const Eigen::VectorXd& x, Eigen::VectorXd* residuals) const = 0;
  virtual bool DoJacobian(const Eigen::VectorXd& x, int first_row,
                          std::vector<Eigen::Triplet<double>>* entries) const = 0;
  virtual bool DoAddHessianTimes(const Eigen::VectorXd& x, const Eigen::VectorXd& direction,
                                 Eigen::VectorXd* product) const = 0;

  double weight_;
  std::shared_ptr<const ceres::LossFunction> loss_;
};

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_BLOCK_FAMILY_H_
