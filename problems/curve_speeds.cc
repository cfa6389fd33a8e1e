#include "problems/curve_speeds.h"

#include <algorithm>
#include <cmath>

#include "problems/constraint_projection.h"
#include "splines/basis_functions.h"

namespace batten {
namespace {

/// The gradient of coordinate c of C'(t) by all variables, over the largest |N'_j(t)|.
Eigen::VectorXd SpeedGradient(const FitSetting& setting, int span, double t, int c,
                              Eigen::Index size) {
  const BsplineBasis& basis = *setting.basis;
  double functions[2 * kMaxOrder];
  EvaluateBasisDerivatives(basis.degree(), basis.knots().data(), span, t, 1, functions);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(size);
  double largest = 0.0;
  for (int j = 0; j <= basis.degree(); ++j) {
    largest = std::max(largest, std::abs(functions[basis.order() + j]));
    const int point = basis.ControlPointIndex(span - basis.degree() + j);
    gradient[setting.control_point_offset + point * setting.dimension + c] +=
        functions[basis.order() + j];
  }
  return gradient / largest;
}

/// Whether C'(t) is 0 for all that the linear constraints leave.
bool StandsStill(const FitSetting& setting, const Problem& problem, int span, double t) {
  constexpr double kRounding = 1e-9;  // of entries of 1, times coordinates of 1
  const LinearElimination& elimination = problem.elimination();
  const Eigen::VectorXd at =
      elimination.Expand(Eigen::VectorXd::Zero(elimination.num_free(problem.num_variables())));
  for (int c = 0; c < setting.dimension; ++c) {
    const Eigen::VectorXd gradient = SpeedGradient(setting, span, t, c, at.size());
    if (elimination.Restrict(gradient).cwiseAbs().sum() > kRounding) return false;
    if (std::abs(gradient.dot(at)) > kRounding) return false;
  }
  return true;
}

/// C' of a span is of degree p - 1: 0 throughout where it is at p places.
bool StandsStillEverywhere(const FitSetting& setting, const Problem& problem) {
  const BsplineBasis& basis = *setting.basis;
  for (int span = basis.first_span(); span <= basis.last_span(); ++span) {
    const double begin = basis.knots()[static_cast<std::size_t>(span)];
    const double length = basis.knots()[static_cast<std::size_t>(span) + 1] - begin;
    for (int i = 0; i < basis.degree() && length > 0.0; ++i) {
      const double t = begin + (i + 0.5) / basis.degree() * length;
      if (!StandsStill(setting, problem, span, t)) return false;
    }
  }
  return true;
}

}  // namespace

bool CheckSpeeds(const FitSetting& setting, const std::vector<CurveCondition>& conditions,
                 const Problem& problem, const std::vector<LinearConstraint>& linear,
                 std::string* error) {
  for (const CurveCondition& condition : conditions) {
    if (condition.kind != CurveCondition::Kind::kCurvature) continue;
    const bool is_found = condition.parameter_variable >= 0;
    const double t = is_found ? setting.basis->domain_begin() : condition.t;
    const int span = setting.basis->FindSpan(t);
    if (is_found ? !StandsStillEverywhere(setting, problem)
                 : !StandsStill(setting, problem, span, t)) {
      continue;
    }
    Eigen::VectorXd force = Eigen::VectorXd::Zero(problem.num_variables());
    for (int c = 0; c < setting.dimension; ++c) {
      force += SpeedGradient(setting, span, t, c, force.size());
    }
    const std::string names = LinearConstraintsOf(linear, force);
    *error = "constraint \"" + condition.name + "\" holds a curvature where " +
             (is_found ? "the curve is a single point" : "C' is 0") +
             (names.empty() ? ", wherever the control points are"
                            : " by the linear constraints " + names);
    return false;
  }
  return true;
}

}  // namespace batten
