#ifndef BATTEN_PROBLEMS_OBJECTIVE_H_
#define BATTEN_PROBLEMS_OBJECTIVE_H_

#include <memory>
#include <vector>

#include "problems/curve_view.h"
#include "problems/evaluation_monitor.h"
#include "problems/free_view.h"
#include "problems/problem.h"

namespace batten {

/// The evaluator of a problem's E that every solver uses: in the free variables that remain after
/// the problem's linear constraints are eliminated, counted by a monitor. Nothing is evaluated
/// before it is asked for; what is compiled on the way (rows, normal band) is compiled at its first
/// use.
class Objective {
 public:
  struct Options {
    /// False: everything goes through the autodiff functors, block by block.
    bool compile = true;
  };

  /// `problem` and `monitor` (null: nobody counts) must outlive this.
  Objective(const Problem* problem, EvaluationMonitor* monitor, Options options);
  Objective(const Problem* problem, EvaluationMonitor* monitor)
      : Objective(problem, monitor, Options()) {}

  const Problem& problem() const { return *problem_; }
  const Options& options() const { return options_; }
  int num_variables() const { return num_variables_; }  ///< Free ones: the size of x below.
  Eigen::VectorXd start() const;
  /// All of the problem's variables at the free ones x.
  Eigen::VectorXd Expand(const Eigen::VectorXd& x) const;

  Status Energy(const Eigen::VectorXd& x, double* energy);
  Status EnergyAndGradient(const Eigen::VectorXd& x, double* energy, Eigen::VectorXd* gradient);
  /// The gradient alone; of a quadratic from the normal band, at no cost per data point.
  Status Gradient(const Eigen::VectorXd& x, Eigen::VectorXd* gradient);
  /// Residuals r and J = dr/dx of all blocks such that E = ||r||^2; losses and weights are in both,
  /// as their Gauss-Newton model (r scaled by the root of weight * rho', J likewise).
  Status Jacobian(const Eigen::VectorXd& x, Eigen::VectorXd* residuals, SparseRows* jacobian);
  /// Second derivative of E times v: exact.
  Status HessianTimes(const Eigen::VectorXd& x, const Eigen::VectorXd& v, Eigen::VectorXd* product);
  /// Energies of blocks begin..end-1 of one term, in its own numbering.
  Status PartialEnergy(const Eigen::VectorXd& x, int term, int begin, int end, double* energy);

  /// E is quadratic and compiled: HessianTimes does not depend on x, and
  /// E(x + v) - E(x) = g'v + v'(HessianTimes v) / 2 without cancellation.
  bool is_quadratic() const { return view_ != nullptr; }
  /// The structure geometric methods ask for; null where not all of E is compiled rows.
  CurveView* curve_view() { return view_.get(); }

  /// The structure of problems with free parameters; null for others. Made at the first call.
  const FreeView* free_view() const;

  /// Whether a method is to call Seat at its iterates.
  bool seats() const { return seats_; }
  /// Moves x, at equal E, to where the gradient is 0 at minima over parameters in order and in the
  /// domain only: BlockFamily::Seat. False if x is there.
  bool Seat(Eigen::VectorXd* x) const;
  /// Turns a direction from x, which is seated and where E has this gradient, to where a step may
  /// lead: no parameters pass each other or an end before its end, none part that the gradient
  /// keeps together, and the slope of E along it is gradient . direction.
  void Aim(const Eigen::VectorXd& x, const Eigen::VectorXd& gradient,
           Eigen::VectorXd* direction) const;

  /// Counts an evaluation at x that a library does itself, from problem().terms(). False: it must
  /// not be done, as after kStop.
  bool Allow(Evaluation kind, const Eigen::VectorXd* x) {
    return monitor_ == nullptr || monitor_->Allow(kind, x);
  }
  /// Where E is evaluated; projected parameters are projected there. Else as Allow.
  bool AllowAt(Evaluation kind, const Eigen::VectorXd& x) {
    return AllowProjection(x) && Allow(kind, &x);
  }

  // Not counted: for run control and reports.
  /// Size below which |g| is noise: 4 eps times the norm of sum |J|'(|J||x| + |r|), doubled as the
  /// gradient of E without factor 1/2 is.
  double GradientRoundingFloor(const Eigen::VectorXd& x) const;
  /// What residuals near x are differences of: the norm of |r(0)| + |r(x) - r(0)|, for r = A P - Q
  /// that of |Q| + |A P|. If r has no value at 0, the norm of r(x).
  double ResidualSize(const Eigen::VectorXd& x) const;
  /// Size of the rounding of E = ||r||^2: each residual carries a few roundings of what it is a
  /// difference of, so that E carries 4 eps (2 sqrt(E) ResidualSize + E), and a difference of two
  /// values at most twice as much.
  static double EnergyRoundingFloor(double energy, double residual_size);
  std::vector<double> TermEnergies(const Eigen::VectorXd& x) const;

 private:
  /// Counts that the points are projected at x, once for all that is evaluated there.
  bool AllowProjection(const Eigen::VectorXd& x);
  Status EvaluateTerms(const Eigen::VectorXd& all, double* energy, Eigen::VectorXd* gradient) const;
  Status EvaluateRows(const Eigen::VectorXd& x, double* energy, Eigen::VectorXd* gradient) const;

  const Problem* problem_;
  EvaluationMonitor* monitor_;
  Options options_;
  int num_variables_;
  std::unique_ptr<CurveView> view_;
  bool seats_;
  bool projects_;  // parameters are projected
  Eigen::VectorXd projected_at_;
  mutable bool free_view_is_made_ = false;
  mutable std::unique_ptr<const FreeView> free_view_;
};

}  // namespace batten

#endif  // BATTEN_PROBLEMS_OBJECTIVE_H_
