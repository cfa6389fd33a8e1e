#ifndef BATTEN_SOLVERS_CERES_PROBLEM_H_
#define BATTEN_SOLVERS_CERES_PROBLEM_H_

#include <ceres/cost_function.h>
#include <ceres/evaluation_callback.h>
#include <ceres/loss_function.h>
#include <ceres/ordered_groups.h>
#include <ceres/problem.h>

#include <memory>
#include <string>
#include <vector>

#include "problems/objective.h"
#include "solvers/moving_variables.h"
#include "solvers/variable_groups.h"

namespace batten {

/// Why `problem` cannot be written as a ceres::Problem, as a sentence for WhyUnsupported; or empty.
std::string WhyNoCeresProblem(const Problem& problem, const std::string& solver_name);

/// A problem in Ceres' own form: its cost is E / 2, its parameter blocks point into state() and
/// stand in the order of the variables, its residual blocks in the order of the terms and of their
/// blocks. The objective's monitor is asked before Ceres evaluates; after its first no every
/// evaluation fails, without a look at the terms.
class CeresProblem final : private ceres::EvaluationCallback {
 public:
  /// `x`: the start in the free variables; it is moved into the bounds and windows. An evaluation
  /// counts as one of kEnergy and, where Ceres wants derivatives, as one of `derivative` as well.
  CeresProblem(Objective* objective, Evaluation derivative, const Eigen::VectorXd& x);
  CeresProblem(const CeresProblem&) = delete;
  CeresProblem& operator=(const CeresProblem&) = delete;

  /// All blocks of all terms: the families' own, or where linear constraints determine one of a
  /// block's variables, its like in the free ones. Blocks with a window are bound at state(), and
  /// their variable is bounded to it. Either this or AddSpans, once.
  void AddTerms();
  /// One block per span of the curve view, which must be there, instead of one per row.
  void AddSpans();

  /// After AddTerms: variables at an end of an open curve past which E still falls are constant in
  /// this problem, a hair past it, where they do not count in the gradient. Without that, each step
  /// takes account of a move that its bound then cuts off. Asks for a gradient if one is at an end.
  void HoldPressed();
  /// At state() HoldPressed would hold others. Asks for a gradient if one was at an end then.
  bool PressedHaveChanged();
  /// Moving variables in group 0, which Schur's complement eliminates, all others in group 1.
  std::shared_ptr<ceres::ParameterBlockOrdering> MovingFirst();

  ceres::Problem* problem() { return &problem_; }
  const MovingVariables& moving() const { return moving_; }
  const Eigen::VectorXd& state() const { return state_; }
  bool stopped() const { return stopped_; }  ///< The monitor has said no.

 private:
  void PrepareForEvaluation(bool evaluate_jacobians, bool new_evaluation_point) override;
  /// Moving variables pressed against an end at state(); none where E has no gradient.
  std::vector<int> Pressed();
  /// Parameter blocks, their bounds, and the gate on the first one.
  void AddGroups(const VariableGroups& groups);
  void AddBlock(std::unique_ptr<ceres::CostFunction> cost,
                std::unique_ptr<ceres::LossFunction> loss, const std::vector<int>& begins);

  Objective* objective_;
  Evaluation derivative_;
  Eigen::VectorXd state_;
  MovingVariables moving_;  // puts state_ into the windows
  std::vector<int> held_;
  bool stopped_ = false;
  ceres::Problem problem_;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_CERES_PROBLEM_H_
