#ifndef BATTEN_PROBLEMS_PROBLEM_H_
#define BATTEN_PROBLEMS_PROBLEM_H_

#include <Eigen/Core>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cost_functions/block_family.h"
#include "cost_functions/constraint_family.h"
#include "problems/linear_elimination.h"

namespace batten {

class CurveFit;

/// A named part of the variables: "control_points", "parameters".
struct VariableRange {
  std::string name;
  int begin = 0;
  int size = 0;
};

/// What one unit inside is worth in the user's units: shown value = inside value * factor. All are
/// powers of two.
struct Units {
  double length = 1.0;
  double energy = 1.0;
  double gradient = 1.0;
};

/// E(x) = sum of its terms' energies, to be lowered from `start` within bounds, linear constraints
/// and others. A curve fit is one kind (curve_fit() not null).
class Problem {
 public:
  struct TermInstance {
    std::string name;  ///< As the user wrote it: name and options.
    std::shared_ptr<const BlockFamily> family;
  };

  explicit Problem(std::string name);
  ~Problem();
  Problem(Problem&&) noexcept;
  Problem& operator=(Problem&&) noexcept;

  const std::string& name() const { return name_; }
  int num_variables() const { return static_cast<int>(start_.size()); }
  const std::vector<VariableRange>& ranges() const { return ranges_; }
  const Eigen::VectorXd& start() const { return start_; }
  const std::vector<TermInstance>& terms() const { return terms_; }
  /// Empty, or one per variable, infinite where there is none.
  const Eigen::VectorXd& lower_bounds() const { return lower_bounds_; }
  const Eigen::VectorXd& upper_bounds() const { return upper_bounds_; }
  bool has_bounds() const { return lower_bounds_.size() > 0; }
  /// The one elimination that every solver works through; the identity without constraints.
  const LinearElimination& elimination() const { return elimination_; }
  /// Constraints that are not linear, or inequalities; null: none.
  const ConstraintFamily* nonlinear_constraints() const { return nonlinear_constraints_.get(); }
  const Units& units() const { return units_; }
  const CurveFit* curve_fit() const { return curve_fit_.get(); }

  void AddVariables(const std::string& range_name, const Eigen::VectorXd& start);
  /// Instead of the start of all variables.
  void SetStart(const Eigen::VectorXd& start);
  void AddTerm(std::string term_name, std::shared_ptr<const BlockFamily> family);
  /// Both of size num_variables().
  void SetBounds(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);
  /// After all variables. False, naming the constraints, if they contradict each other.
  bool SetLinearConstraints(const std::vector<LinearConstraint>& constraints, std::string* error);
  void SetNonlinearConstraints(std::shared_ptr<const ConstraintFamily> constraints);
  void SetUnits(const Units& units) { units_ = units; }
  void SetCurveFit(std::shared_ptr<const CurveFit> fit);

  /// The same problem, whose data it shares, with one more term instead of the nonlinear
  /// constraints.
  Problem WithPenalty(std::string term_name, std::shared_ptr<const BlockFamily> penalty) const;

 private:
  std::string name_;
  std::vector<VariableRange> ranges_;
  Eigen::VectorXd start_;
  Eigen::VectorXd lower_bounds_;
  Eigen::VectorXd upper_bounds_;
  LinearElimination elimination_;
  Units units_;
  // Before the terms and constraints: they refer to its data.
  std::shared_ptr<const CurveFit> curve_fit_;
  std::vector<TermInstance> terms_;
  std::shared_ptr<const ConstraintFamily> nonlinear_constraints_;
};

}  // namespace batten

#endif  // BATTEN_PROBLEMS_PROBLEM_H_
