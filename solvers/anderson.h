#ifndef BATTEN_SOLVERS_ANDERSON_H_
#define BATTEN_SOLVERS_ANDERSON_H_

#include <memory>
#include <vector>

#include "solvers/solver_registry.h"
#include "solvers/stall_guard.h"
#include "solvers/stepper.h"

namespace batten {

/// Anderson acceleration of a fixed-point map G, safeguarded by E: docs/solvers/anderson.md. With
/// f = G(x) - x and the differences of the last steps, gamma = argmin |f - dF gamma|, and
/// x+ = G(x) - dG gamma if E does not rise, else G(x).
class AndersonSolver final : public Stepper {
 public:
  static SolverInfo ClassInfo();
  AndersonSolver(const OptionValues& options, std::unique_ptr<Solver> base);
  SolverInfo Info() const override { return ClassInfo(); }
  std::string WhyUnsupported(const Objective& objective) const override;
  std::vector<double> State() const override;
  void Restore(const std::vector<double>& state) override;

 private:
  std::optional<Outcome> DoStart(Eigen::VectorXd* x) override;
  std::optional<Outcome> DoStep(Eigen::VectorXd* x) override;
  void AtEnd() override;
  /// Value and gradient where E is quadratic (the gradient alone), else the value alone.
  Status Evaluate(const Eigen::VectorXd& x, double* energy, Eigen::VectorXd* gradient);
  void Remember();
  Eigen::VectorXd Accelerated() const;
  /// Sets `rises` where E(candidate) is above E(x); leaves its value and gradient in next_*.
  Status TryCandidate(const Eigen::VectorXd& x, bool* rises);
  /// Whether E has risen by more than its rounding, from x to the candidate.
  bool IsBeyondRounding(const Eigen::VectorXd& x);

  int window_;
  std::unique_ptr<Solver> base_;
  FixedPoint* map_;  // base_, if it is one

  Eigen::VectorXd image_;  // G(x)
  Eigen::VectorXd move_;   // f = G(x) - x
  Eigen::VectorXd candidate_;
  double energy_ = 0.0;
  double next_energy_ = 0.0;
  double rise_ = 0.0;            // of E to the candidate
  double residual_size_ = -1.0;  // Objective::ResidualSize, once it was asked for
  Eigen::VectorXd gradient_;
  Eigen::VectorXd next_gradient_;
  Eigen::VectorXd last_image_;  // empty before the first step
  Eigen::VectorXd last_move_;
  std::vector<Eigen::VectorXd> image_differences_;  // oldest first
  std::vector<Eigen::VectorXd> move_differences_;
  StallGuard guard_;
  bool base_raises_ = false;
  int num_tried_ = 0;     // accelerated points
  int num_rejected_ = 0;  // at which E would have risen
};

/// The registry's row: takes the base.
SolverEntry AndersonEntry();

}  // namespace batten

#endif  // BATTEN_SOLVERS_ANDERSON_H_
