#ifndef BATTEN_SOLVERS_CERES_PROBLEM_H_
#define BATTEN_SOLVERS_CERES_PROBLEM_H_

#include <ceres/cost_function.h>
#include <ceres/evaluation_callback.h>
#include <ceres/loss_function.h>
#include <ceres/problem.h>

#include <memory>
#include <string>
#include <vector>

#include "problems/objective.h"
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
  /// `x`: the start in the free variables; it is moved into the bounds. An evaluation counts as one
  /// of kEnergy and, where Ceres wants derivatives, as one of `derivative` as well.
  CeresProblem(Objective* objective, Evaluation derivative, const Eigen::VectorXd& x);
  CeresProblem(const CeresProblem&) = delete;
  CeresProblem& operator=(const CeresProblem&) = delete;

  /// All blocks of all terms: the families' own, or where linear constraints determine one of a
  /// block's variables, its like in the free ones. Either this or AddSpans, once.
  void AddTerms();
  /// One block per span of the curve view, which must be there, instead of one per row.
  void AddSpans();

  ceres::Problem* problem() { return &problem_; }
  const Eigen::VectorXd& state() const { return state_; }
  bool stopped() const { return stopped_; }  ///< The monitor has said no.

 private:
  void PrepareForEvaluation(bool evaluate_jacobians, bool new_evaluation_point) override;
  /// Parameter blocks, their bounds, and the gate on the first one.
  void AddGroups(const VariableGroups& groups);
  void AddBlock(std::unique_ptr<ceres::CostFunction> cost,
                std::unique_ptr<ceres::LossFunction> loss, const std::vector<int>& begins);

  Objective* objective_;
  Evaluation derivative_;
  Eigen::VectorXd state_;
  bool stopped_ = false;
  ceres::Problem problem_;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_CERES_PROBLEM_H_
