#include <cmath>
#include <string>

#include "cost_functions/foot_feet.h"
#include "problems/fit_problem.h"

namespace batten {

const char* ToString(ParameterKind kind) {
  switch (kind) {
    case ParameterKind::kFixed:
      return "fixed";
    case ParameterKind::kFree:
      return "free";
    case ParameterKind::kProjected:
      return "projected";
  }
  return "unknown";
}

bool FromString(const std::string& text, ParameterKind* kind) {
  for (const ParameterKind known :
       {ParameterKind::kFixed, ParameterKind::kFree, ParameterKind::kProjected}) {
    if (text != ToString(known)) continue;
    *kind = known;
    return true;
  }
  return false;
}

const char* DistanceTermOf(ParameterKind kind) {
  switch (kind) {
    case ParameterKind::kFree:
      return "free_parameter";
    case ParameterKind::kProjected:
      return "foot_point";
    default:
      return "interpolation";
  }
}

OrderedParameters CurveFit::Order(const Eigen::VectorXd& t) const {
  const int held = setting_.ends_held ? 1 : 0;
  return OrderOnCurve(*basis_, t.segment(held, t.size() - 2 * held));
}

Eigen::VectorXd CurveFit::OrderedIfKept(Eigen::VectorXd t) const {
  if (!setting_.keep_order) return t;
  const OrderedParameters order = Order(t);
  t.segment(setting_.ends_held ? 1 : 0, order.t.size()) = order.t;
  return t;
}

Eigen::VectorXd CurveFit::Parameters(const Eigen::VectorXd& x) const {
  if (is_projected()) return FeetOf(x);
  if (!has_free_parameters()) return parameters_;
  Eigen::VectorXd t = OrderedIfKept(x.segment(setting_.parameter_offset, parameters_.size()));
  for (double& value : t) value = basis_->Wrap(value);
  return t;
}

/// As the term foot_point has them, in the domain.
Eigen::VectorXd CurveFit::FeetOf(const Eigen::VectorXd& x) const {
  const Points scaled = (data_.points.rowwise() -
                         Eigen::Map<const Eigen::RowVectorXd>(setting_.center, dimension())) *
                        setting_.scale;
  Eigen::VectorXd all(x.size() + scaled.rows());
  all.head(x.size()) = x;
  FindFeet(*basis_, dimension(), setting_.control_point_offset, scaled, &all);
  Eigen::VectorXd feet = all.tail(scaled.rows());
  for (double& t : feet) t = basis_->Wrap(t);
  return feet;
}

bool CurveFit::CheckEnds(std::string* error) const {
  if (spec_.keep_order && spec_.parameter_kind != ParameterKind::kFree) {
    *error = std::string("the points' order is to be kept, but the parameters are ") +
             ToString(spec_.parameter_kind);
    return false;
  }
  if (!spec_.hold_ends) return true;
  if (spec_.parameter_kind == ParameterKind::kFree && !spec_.closed) return true;
  *error = std::string("ends are to be held, but ") +
           (spec_.closed ? "the curve is closed"
                         : std::string("the parameters are ") + ToString(spec_.parameter_kind));
  return false;
}

/// Projected parameters and the term that has them go together.
bool CurveFit::CheckKind(const NameSpec& name, const Term& term, std::string* error) const {
  if (term.Info().foot_points == is_projected()) return true;
  if (!is_projected()) {
    *error = "term " + name.ToString() + " needs projected parameters; this problem's are " +
             ToString(spec_.parameter_kind);
    return false;
  }
  if (!term.Info().free_parameters && name.name != "interpolation") return true;
  *error = "term " + name.ToString() + " has parameters of its own, but they are projected; use " +
           "foot_point";
  return false;
}

/// Of closed curves moved by whole periods, so that they go on rather than back.
Eigen::VectorXd CurveFit::InOrder(Eigen::VectorXd t) const {
  const double period = basis_->domain_length();
  for (Eigen::Index i = 1; spec_.closed && i < t.size(); ++i) {
    t[i] -= std::round((t[i] - t[i - 1]) / period) * period;
  }
  return OrderedIfKept(t);
}

void CurveFit::AddParameters(Problem* problem, std::vector<LinearConstraint>* constraints) {
  setting_.parameter_offset = problem->num_variables();
  setting_.keep_order = spec_.keep_order;
  setting_.ends_held = spec_.hold_ends;
  const auto last = parameters_.size() - 1;
  if (spec_.hold_ends) {
    parameters_[0] = basis_->domain_begin();
    parameters_[last] = basis_->domain_end();
  }
  if (spec_.keep_order) parameters_ = InOrder(parameters_);
  problem->AddVariables("parameters", parameters_);
  if (!spec_.hold_ends) return;
  for (const Eigen::Index i : {Eigen::Index(0), last}) {
    LinearConstraint constraint;
    constraint.name = "t_" + std::to_string(i) + " held";
    constraint.coefficients = {{setting_.parameter_offset + static_cast<int>(i), 1.0}};
    constraint.value = parameters_[i];
    constraints->push_back(std::move(constraint));
  }
}

}  // namespace batten
