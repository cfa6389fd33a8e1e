#include "solvers/ceres_problem.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "solvers/ceres_spans.h"
#include "solvers/eliminated_cost.h"
#include "solvers/solver.h"

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

Eigen::VectorXd IntoBounds(const Problem& problem, const Eigen::VectorXd& x) {
  if (!problem.has_bounds()) return x;
  return x.cwiseMax(problem.lower_bounds()).cwiseMin(problem.upper_bounds());
}

/// Groups of all variables that the terms' blocks ask for at x. False if some overlap.
bool FindGroups(const Problem& problem, const Eigen::VectorXd& x, VariableGroups* groups) {
  std::vector<int> begins;
  std::vector<int> sizes;
  for (const Problem::TermInstance& term : problem.terms()) {
    for (int block = 0; block < term.family->size(); ++block) {
      term.family->Bind(x, block, &begins, &sizes);
      for (std::size_t i = 0; i < begins.size(); ++i) {
        if (!groups->Add(begins[i], sizes[i])) return false;
      }
    }
  }
  return true;
}

}  // namespace

std::string WhyNoCeresProblem(const Problem& problem, const std::string& solver_name) {
  std::string why = WhyNoNonlinearConstraints(problem, solver_name);
  if (!why.empty()) return why;
  VariableGroups groups(problem.num_variables());
  if (!FindGroups(problem, problem.start(), &groups)) {
    return solver_name + " needs terms that group the variables alike; use lbfgs";
  }
  why = WhyNoWindows(problem, solver_name);
  if (!why.empty() || !problem.has_bounds()) return why;
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
    : objective_(objective),
      derivative_(derivative),
      state_(IntoBounds(objective->problem(), x)),
      moving_(objective->problem(), &state_),
      problem_(ProblemOptions(this)) {}

void CeresProblem::PrepareForEvaluation(bool evaluate_jacobians, bool /*new_evaluation_point*/) {
  if (stopped_) return;
  stopped_ = !objective_->AllowAt(Evaluation::kEnergy, state_) ||
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
  const Eigen::VectorXd x = objective_->Expand(state_);
  VariableGroups all(problem.num_variables());
  CHECK(FindGroups(problem, x, &all));
  const FreeGroups free(problem.elimination(), all);
  AddGroups(free.groups());
  std::vector<int> begins;
  std::vector<int> sizes;
  for (const Problem::TermInstance& term : problem.terms()) {
    for (int block = 0; block < term.family->size(); ++block) {
      term.family->Bind(x, block, &begins, &sizes);
      auto cost = free.Rewrite(term.family->MakeCeresCostFunction(x, block), &begins);
      AddBlock(std::move(cost), term.family->MakeCeresLoss(), begins);
    }
  }
  for (const BindingWindow& window : moving_.windows()) {
    double* value = state_.data() + window.variable;
    problem_.SetParameterLowerBound(value, 0, window.low);
    problem_.SetParameterUpperBound(value, 0, window.high);
  }
}

std::vector<int> CeresProblem::Pressed() {
  double energy = 0.0;
  Eigen::VectorXd gradient;
  Eigen::VectorXd at_ends = state_;
  for (const BindingWindow& window : moving_.windows()) {
    double& place = at_ends[window.variable];
    place = std::clamp(place, window.low, window.high);
  }
  const Status status = objective_->EnergyAndGradient(at_ends, &energy, &gradient);
  stopped_ = status == Status::kStop;
  return status == Status::kOk ? moving_.Pressed(at_ends, gradient) : std::vector<int>();
}

void CeresProblem::HoldPressed() {
  if (!moving_.AnyIsAtAnEnd()) return;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kUnbounded = std::numeric_limits<double>::max();  // as Ceres has it
  held_ = Pressed();
  std::vector<char> is_held(static_cast<std::size_t>(state_.size()), 0);
  for (const int variable : held_) is_held[static_cast<std::size_t>(variable)] = 1;
  for (const BindingWindow& window : moving_.windows()) {
    if (is_held[static_cast<std::size_t>(window.variable)] == 0) continue;
    double* value = state_.data() + window.variable;
    problem_.SetParameterBlockConstant(value);
    problem_.SetParameterLowerBound(value, 0, -kUnbounded);
    problem_.SetParameterUpperBound(value, 0, kUnbounded);
    const bool is_at_low = window.low_is_end && *value <= window.low;
    *value = std::nextafter(*value, is_at_low ? -kInfinity : kInfinity);
  }
}

bool CeresProblem::PressedHaveChanged() {
  if (!moving_.AnyIsAtAnEnd()) return false;
  const bool changed = Pressed() != held_;
  return changed && !stopped_;
}

std::shared_ptr<ceres::ParameterBlockOrdering> CeresProblem::MovingFirst() {
  auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  std::vector<double*> blocks;
  problem_.GetParameterBlocks(&blocks);
  for (double* block : blocks) ordering->AddElementToGroup(block, 1);
  for (const BindingWindow& window : moving_.windows()) {
    ordering->AddElementToGroup(state_.data() + window.variable, 0);
  }
  return ordering;
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
