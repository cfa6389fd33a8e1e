#ifndef BATTEN_SOLVERS_EXACT_NEWTON_H_
#define BATTEN_SOLVERS_EXACT_NEWTON_H_

#include <optional>
#include <vector>

#include "problems/fit_problem.h"
#include "solvers/stepper.h"
#include "splines/banded_cholesky.h"
#include "splines/substituted_band.h"

namespace batten {

/// The second derivatives of E in the control points of a fit with fixed parameters, in their band
/// (blocks of d x d), whatever its terms are. Control points further apart than a residual block
/// reaches do not meet: one product of the Hessian with a vector that has a 1 at all points of one
/// colour tells their columns at once (Curtis, Powell & Reid, J. IMA 13, 1974).
class HessianBand {
 public:
  explicit HessianBand(const Problem& problem);
  /// At all control points; each product is counted. False: one was refused or is not finite,
  /// as *status says.
  bool Sum(Objective* objective, const Eigen::VectorXd& all, Status* status);
  const NormalBand& band() const { return band_; }
  NormalBand& band() { return band_; }
  const RowShape& shape() const { return shape_; }  ///< Of band().
  int num_colours() const { return num_colours_; }
  int dimension() const { return dimension_; }

 private:
  int LargestReach() const;
  void MakeColours();
  /// Column (j, c) of the Hessian from its product with the vectors of the column's colour.
  void SetColumn(int j, int c, const Eigen::VectorXd& product);

  const Problem& problem_;
  const BsplineBasis& basis_;
  int dimension_;
  int reach_;  // the furthest neighbour a control point meets
  int num_colours_ = 0;
  std::vector<int> colours_;  // of the control points
  RowShape shape_;
  NormalBand band_;
};

/// Newton's method on a fit with fixed parameters whose energy is not quadratic: (H + damping
/// diag|H|) s = -g, the damping 0 where such steps lower E as foretold, so that the end is
/// quadratic.
class ExactNewton final : public Stepper {
 public:
  SolverInfo Info() const override;
  /// Empty where second derivatives stand in a band of the control points.
  static std::string WhyNot(const Objective& objective, const std::string& name);
  std::string WhyUnsupported(const Objective& objective) const override {
    return WhyNot(objective, Info().name);
  }
  std::vector<double> State() const override { return {damping_}; }
  void Restore(const std::vector<double>& state) override { damping_ = state[0]; }

 private:
  std::optional<Outcome> DoStart(Eigen::VectorXd* x) override;
  std::optional<Outcome> DoStep(Eigen::VectorXd* x) override;
  /// The step with the present damping; false where H + damping diag|H| is not positive definite.
  bool FindStep(Eigen::VectorXd* step);
  void RaiseDamping();

  std::optional<HessianBand> hessian_;
  std::optional<SubstitutedBand> free_band_;  // none: no constraints
  NormalBand damped_{RowShape()};
  BandedCholesky factor_;
  Eigen::VectorXd gradient_;
  double energy_ = 0.0;
  double damping_ = 0.0;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_EXACT_NEWTON_H_
