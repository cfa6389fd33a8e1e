#ifndef BATTEN_SOLVERS_FOOT_MODEL_H_
#define BATTEN_SOLVERS_FOOT_MODEL_H_

#include <vector>

#include "problems/free_view.h"
#include "solvers/curved_terms.h"
#include "solvers/worker_pool.h"
#include "splines/banded_cholesky.h"
#include "splines/normal_band.h"
#include "splines/substituted_band.h"

namespace batten {

/// Which quadratic model of E in the control points a FootModel sums up, the parameters eliminated.
/// With r = C(t) - Q, C' and C'' at t_i, and B the basis functions there, point i adds
///   w B B' (x) I - a g g',  g = B (x) C' (+ B' (x) r for kNewton)
/// to the half Hessian and w B (x) r - a (C' . r) g to the half gradient. With a loss, w is the
/// point's weight times rho'(s), the model then being that of a sum of squares that touches E from
/// above, rho being concave; kNewton has the curvature of rho too, with c = 2 w_i^2 / W rho''(s):
///   + c B B' (x) r r',  g + c / w (C' . r) B (x) r,  1 / a + c / w^2 (C' . r)^2.
/// Damping times |C'|^2 is at least damping times a thousandth of the mean of |C'|^2 on the curve.
enum class FootModelKind {
  kPoint,      ///< PDM: a = 0. t stays.
  kTangent,    ///< TDM, and Gauss-Newton with t eliminated: a = w / (|C'|^2 + damping |C'|^2).
  kCurvature,  ///< SDM: a = w min(1 / |C'|^2, 1 / (|C'|^2 + r . C'')).
  kNewton,     ///< Newton with t eliminated: a = w / (|C'|^2 + r . C'' + damping |C'|^2).
};

/// The reduced model of a free problem in its band (blocks of d x d, bandwidth (p + 1) d), the
/// border of closed curves included: one pass over the points, sums of each span in their own
/// place, so that the bits do not depend on the number of threads. Where constraints bind control
/// points, P = offset + Z y, steps are those of y, from the band of Z'(half Hessian) Z. Terms that
/// are not affine are summed by second derivatives for kNewton, else by Gauss and Newton's. Sum,
/// Factor, Solve, Move and ImproveFeet allocate nothing after their first call, but for what
/// BandedCholesky says and for terms that are not affine; the threads wait for the next pass.
class FootModel {
 public:
  FootModel(const FreeView& view, int threads);

  /// Sums the model up at all variables x. False where a sum is not finite.
  bool Sum(const Eigen::VectorXd& x, FootModelKind kind, double damping);
  double energy() const { return energy_; }
  FootModelKind kind() const { return kind_; }
  /// Products with second derivatives that a Sum of this kind takes.
  int NumProducts(FootModelKind kind) const {
    return kind == FootModelKind::kNewton ? curved_terms_.num_products() : 0;
  }
  double parameter_damping() const { return damping_; }
  /// What E is a difference of: sum_i w_i |Q_i|^2, for its rounding; losses only lessen it.
  double scale() const { return scale_; }
  /// Factors the half Hessian + damping * (its diagonal for a = 0). False if that is not positive
  /// definite to working precision.
  bool Factor(double damping);
  /// Factor with this damping, at least what makes a singular system solvable; more, up to 1e16
  /// times, until it is.
  bool FactorSingular(double damping);
  /// -(half Hessian)^-1 (half gradient), n d numbers; after Factor.
  void Solve(Eigen::VectorXd* step);
  /// A step of length 1 along which the half Hessian is about least, measured by what Factor has
  /// added, and E does not rise to first order: inverse iteration; after Factor.
  void LeastDirection(Eigen::VectorXd* step);
  /// Half gradient in the control points, t eliminated.
  const Eigen::VectorXd& half_gradient() const { return half_gradient_; }
  /// The same in the coordinates that constraints leave: Z'(half gradient).
  const Eigen::VectorXd& free_half_gradient() const {
    return map_ == nullptr ? half_gradient_ : free_half_gradient_;
  }
  /// *step = Z y.
  void Expand(const Eigen::VectorXd& y, Eigen::VectorXd* step) const;
  /// In the control points, t eliminated, without Factor's damping.
  const NormalBand& half_hessian() const { return band_; }
  /// Moves each parameter among all variables `x` nearer to the foot of its point, by at most
  /// `steps` Newton steps within its span; never away from it. Leaves no sums behind.
  void ImproveFeet(int steps, Eigen::VectorXd* x);
  /// Row sums of |half Hessian| in the coordinates that constraints leave.
  std::vector<double> RowSums();
  /// *next = the control points moved by `step` and each parameter by what goes with it, held ones
  /// and those pressed against an end of the domain excepted. Returns what the model says that E
  /// falls by. After Sum of the same x.
  double Move(const Eigen::VectorXd& x, const Eigen::VectorXd& step, Eigen::VectorXd* next);

 private:
  /// Neighbours among the points whose parameters are in one span.
  struct Run {
    int span;  // less the first one
    int begin;
    int end;
  };
  template <int P, int D>
  struct SpanPoints;
  template <int P, int D>
  struct SpanSteps;
  template <int P, int D>
  struct Kernel;
  bool has_loss() const { return sites_.loss != nullptr; }
  /// Move writes every parameter; else those that stay are as they were given, maybe past an end.
  bool moves_all() const { return basis_.periodic() && !has_held_; }
  template <typename Body>
  void WithKernel(Body body);
  void PrepareSpans();
  void PrepareCurve(const double* control_points);
  /// (p + 1) powers of t - middle x d of the curve of these control points over a span.
  void CurveOfSpan(int span, const double* control_points, double* curve) const;
  void SortBySpan(const double* parameters);
  void FindRuns(const double* parameters);
  double WeighSpan(int span);
  void ShareSpans();
  template <typename Body>
  void ForEachShare(Body body);
  void AssembleBand();
  void AddOtherTerms(const double* control_points);
  void LeaveEnds(double* parameters) const;
  std::size_t SpanStride() const {
    return static_cast<std::size_t>(local_) * (local_ + 1) + static_cast<std::size_t>(order_);
  }
  double* SpanSums(int span) { return &span_sums_[static_cast<std::size_t>(span) * SpanStride()]; }

  const FreeView& view_;
  const FreeSites& sites_;
  const BsplineBasis& basis_;
  WorkerPool workers_;
  int order_;
  int dimension_;
  int local_;  // (p + 1) d
  FootModelKind kind_ = FootModelKind::kPoint;
  double damping_ = 0.0;
  double energy_ = 0.0;
  double scale_ = 0.0;

  std::vector<double> middles_;       // of the spans
  std::vector<double> coefficients_;  // per span: (p + 1) powers of t - middle x (p + 1) functions
  std::vector<double> curve_;         // per span: (p + 1) powers x d
  std::vector<Run> found_runs_;       // in the order of the points
  std::vector<Run> runs_;             // the same by span
  std::vector<int> span_runs_;        // into it
  std::vector<int> span_begins_;      // numbers of points in the spans before
  const double* parameters_ = nullptr;  // m: t in the domain, of the last Sum or ImproveFeet
  std::vector<double> wrapped_;         // m: these, where some that were given are not in it
  std::vector<double> moves_;           // m: 0 where t is held, else 1
  bool has_held_;
  double least_speed_ = 0.0;  // |C'|^2 below which damping takes this instead
  std::vector<int> shares_;   // spans of each thread
  // m each, empty without a loss, of the last Sum: w_i rho'(s_i), and 2 w_i / W rho'' / rho'.
  std::vector<double> robust_weights_;
  std::vector<double> loss_bends_;
  const double* weights_;  // of the points: the sites' own, or robust_weights_
  // Per span: local x local of the half Hessian, upper triangle; local of the half gradient; p + 1
  // of the diagonal.
  std::vector<double> span_sums_;
  std::vector<double> span_energies_;
  std::vector<double> span_decreases_;
  NormalBand band_;
  NormalBand damped_;
  std::vector<double> diagonal_;  // n d: of Gauss and Newton's half Hessian for a = 0
  std::vector<double> added_;     // n d: to the half Hessian by Factor
  CurvedTerms curved_terms_;
  Eigen::VectorXd half_gradient_;
  Points other_residual_;      // of the other terms
  const SparseRows* map_;      // Z; null: the identity
  SubstitutedBand free_band_;  // of the half Hessian in y
  Eigen::VectorXd free_half_gradient_;
  Eigen::VectorXd free_step_;
  BandedCholesky cholesky_;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_FOOT_MODEL_H_
