#include "problems/problem.h"

#include <glog/logging.h>

#include "problems/fit_problem.h"

namespace batten {

Problem::Problem(std::string name) : name_(std::move(name)) {}
Problem::~Problem() = default;
Problem::Problem(Problem&&) noexcept = default;
Problem& Problem::operator=(Problem&&) noexcept = default;

void Problem::AddVariables(const std::string& range_name, const Eigen::VectorXd& start) {
  const auto begin = start_.size();
  ranges_.push_back({range_name, static_cast<int>(begin), static_cast<int>(start.size())});
  start_.conservativeResize(begin + start.size());
  start_.tail(start.size()) = start;
}

void Problem::SetStart(const Eigen::VectorXd& start) {
  CHECK_EQ(start.size(), start_.size());
  start_ = start;
}

void Problem::AddTerm(std::string term_name, std::shared_ptr<const BlockFamily> family) {
  terms_.push_back({std::move(term_name), std::move(family)});
}

void Problem::SetBounds(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  CHECK_EQ(lower.size(), start_.size());
  CHECK_EQ(upper.size(), start_.size());
  lower_bounds_ = lower;
  upper_bounds_ = upper;
}

bool Problem::SetLinearConstraints(const std::vector<LinearConstraint>& constraints,
                                   std::string* error) {
  return LinearElimination::Make(num_variables(), constraints, &elimination_, error);
}

void Problem::SetNonlinearConstraints(std::shared_ptr<const ConstraintFamily> constraints) {
  nonlinear_constraints_ = std::move(constraints);
}

void Problem::SetCurveFit(std::shared_ptr<const CurveFit> fit) { curve_fit_ = std::move(fit); }

Problem Problem::WithPenalty(std::string term_name,
                             std::shared_ptr<const BlockFamily> penalty) const {
  Problem made(name_);
  made.ranges_ = ranges_;
  made.start_ = start_;
  made.lower_bounds_ = lower_bounds_;
  made.upper_bounds_ = upper_bounds_;
  made.elimination_ = elimination_;
  made.units_ = units_;
  made.curve_fit_ = curve_fit_;
  made.terms_ = terms_;
  made.AddTerm(std::move(term_name), std::move(penalty));
  return made;
}

}  // namespace batten
