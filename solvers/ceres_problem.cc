#include "solvers/ceres_problem.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "solvers/ceres_spans.h"
#include "solvers/eliminated_cost.h"

namespace batten {
namespace {

ceres::Problem::Options ProblemOptions(ceres::EvaluationCallback* callback) {
  ceres::Problem::Options options;
  options.evaluation_callback = callback;
  return options;
}

/// The first block: no part of E, always zero. Once the monitor has said no it fails, and Ceres
/// skips all other blocks. Asking in each block instead would cost a call per data point.
class Gate final : public ceres::CostFunction {
 public:
  Gate(const bool* closed, int size) : closed_(closed) {
    set_num_residuals(1);
    mutable_parameter_block_sizes()->push_back(size);
  }
  bool Evaluate(double const* const* /*parameters*/, double* residuals,
                double** jacobians) const override {
    residuals[0] = 0.0;
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      std::fill_n(jacobians[0], parameter_block_sizes()[0], 0.0);
    }
    return !*closed_;
  }

 private:
  const bool* closed_;
};

/// Groups of all variables that the terms' blocks ask for. False if some overlap.
bool FindGroups(const Problem& problem, VariableGroups* groups) {
  std::vector<int> begins;
  std::vector<int> sizes;
  for (const Problem::TermInstance& term : problem.terms()) {
    for (int block = 0; block < term.family->size(); ++block) {
      term.family->Bind(problem.start(), block, &begins, &sizes);
      for (std::size_t i = 0; i < begins.size(); ++i) {
        if (!groups->Add(begins[i], sizes[i])) return false;
      }
    }
  }
  return true;
}

}  // namespace

std::string WhyNoCeresProblem(const Problem& problem, const std::string& solver_name) {
  VariableGroups groups(problem.num_variables());
  if (!FindGroups(problem, &groups)) {
    return solver_name + " needs terms that group the variables alike; use lbfgs";
  }
  if (!problem.has_bounds()) return "";
  if (!problem.elimination().trivial()) {
    return solver_name + " takes bounds or linear constraints, not both";
  }
  if ((problem.lower_bounds().array() >= problem.upper_bounds().array()).any()) {
    return solver_name +
           " needs room between lower and upper bounds; hold a variable by a linear "
           "constraint instead";
  }
  return "";
}

CeresProblem::CeresProblem(Objective* objective, Evaluation derivative, const Eigen::VectorXd& x)
    : objective_(objective), derivative_(derivative), state_(x), problem_(ProblemOptions(this)) {
  const Problem& problem = objective_->problem();
  if (problem.has_bounds()) {
    state_ = state_.cwiseMax(problem.lower_bounds()).cwiseMin(problem.upper_bounds());
  }
}

void CeresProblem::PrepareForEvaluation(bool evaluate_jacobians, bool /*new_evaluation_point*/) {
  if (stopped_) return;
  stopped_ = !objective_->Allow(Evaluation::kEnergy, &state_) ||
             (evaluate_jacobians && !objective_->Allow(derivative_, &state_));
}

void CeresProblem::AddGroups(const VariableGroups& groups) {
  const Problem& problem = objective_->problem();
  bool is_first = true;
  for (int begin = 0; begin < groups.num_variables(); ++begin) {
    const int size = groups.size_at(begin);
    if (size == 0) continue;
    double* values = state_.data() + begin;
    problem_.AddParameterBlock(values, size);
    if (is_first) AddBlock(std::make_unique<Gate>(&stopped_, size), nullptr, {begin});
    is_first = false;
    if (!problem.has_bounds()) continue;
    for (int i = 0; i < size; ++i) {
      const double lower = problem.lower_bounds()[begin + i];
      const double upper = problem.upper_bounds()[begin + i];
      if (std::isfinite(lower)) problem_.SetParameterLowerBound(values, i, lower);
      if (std::isfinite(upper)) problem_.SetParameterUpperBound(values, i, upper);
    }
  }
}

void CeresProblem::AddBlock(std::unique_ptr<ceres::CostFunction> cost,
                            std::unique_ptr<ceres::LossFunction> loss,
                            const std::vector<int>& begins) {
  std::vector<double*> pointers;
  for (const int begin : begins) pointers.push_back(state_.data() + begin);
  problem_.AddResidualBlock(cost.release(), loss.release(), pointers);  // it owns them now
}

void CeresProblem::AddTerms() {
  const Problem& problem = objective_->problem();
  VariableGroups all(problem.num_variables());
  CHECK(FindGroups(problem, &all));
  const FreeGroups free(problem.elimination(), all);
  AddGroups(free.groups());
  std::vector<int> begins;
  std::vector<int> sizes;
  // Which variables a block has may depend on where the run starts, not the problem.
  const Eigen::VectorXd start = objective_->Expand(state_);
  for (const Problem::TermInstance& term : problem.terms()) {
    for (int block = 0; block < term.family->size(); ++block) {
      term.family->Bind(start, block, &begins, &sizes);
      auto cost = free.Rewrite(term.family->MakeCeresCostFunction(start, block), &begins);
      AddBlock(std::move(cost), term.family->MakeCeresLoss(), begins);
    }
  }
}

void CeresProblem::AddSpans() {
  const CurveView& view = *objective_->curve_view();
  VariableGroups groups(objective_->num_variables());
  for (int j = 0; j < view.num_points(); ++j) groups.Add(j * view.dimension(), view.dimension());
  AddGroups(groups);
  for (SpanBlock& span : MakeSpanBlocks(view)) {
    AddBlock(std::move(span.cost), nullptr, span.begins);
  }
}

}  // namespace batten
