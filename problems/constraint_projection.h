#ifndef BATTEN_PROBLEMS_CONSTRAINT_PROJECTION_H_
#define BATTEN_PROBLEMS_CONSTRAINT_PROJECTION_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "problems/problem.h"

namespace batten {

/// What nonlinear constraints are held to at a solution: 1e-10 of the data's size, which inside is
/// more than 1/2.
inline constexpr double kConstraintTolerance = 5e-11;

/// By how much a problem's nonlinear constraints are missed at all variables x: the largest |h_k|
/// of equations and -h_k of inequalities, and whose it is. Infinite where one has no value; 0 where
/// there are none.
struct Violation {
  double largest = 0.0;
  int constraint = -1;
};
Violation MeasureViolation(const Problem& problem, const Eigen::VectorXd& x);

/// Multipliers and gradient of the Lagrangian E + sum_k lambda_k h_k.
struct LagrangianGradient {
  Eigen::VectorXd gradient;     ///< In the free variables.
  Eigen::VectorXd multipliers;  ///< <= 0 for inequalities, 0 for those that do not hold x back.
};
/// Of E's gradient g in the free variables at all variables x: lambda makes its length least. At a
/// minimum under the constraints it is 0 (Karush, Kuhn and Tucker). False where no number is found.
bool MakeLagrangianGradient(const Problem& problem, const Eigen::VectorXd& x,
                            const Eigen::VectorXd& g, LagrangianGradient* made);

/// Moves the free variables y to a point that meets the nonlinear constraints, by Newton's steps of
/// the least length in all variables (control points, scaled, and parameters), until rounding.
/// Inequalities are met as equations where their multiplier is not 0. False, *y as it was, if they
/// do not come to kConstraintTolerance.
bool ProjectOntoConstraints(const Problem& problem, const Eigen::VectorXd& multipliers,
                            Eigen::VectorXd* y);

/// Names, quoted and with "and" between, of the linear constraints whose gradients add up to
/// `force`, a vector of all variables. Empty: none do.
std::string LinearConstraintsOf(const std::vector<LinearConstraint>& linear,
                                const Eigen::VectorXd& force);

/// Whether no equations contradict each other or the problem's `linear` constraints wherever the
/// variables are: a combination of them that does not depend on the free variables and is not zero.
/// Else false, with one sentence that names them, linear ones too, in `error`.
bool CheckForContradictions(const Problem& problem, const std::vector<LinearConstraint>& linear,
                            std::string* error);

}  // namespace batten

#endif  // BATTEN_PROBLEMS_CONSTRAINT_PROJECTION_H_
