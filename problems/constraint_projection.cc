#include "problems/constraint_projection.h"

#include <Eigen/QR>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "problems/curve_constraints.h"

namespace batten {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// h and dh / dy, y the free variables, one row for each constraint; dh / dx of all variables, too.
struct Linearized {
  Eigen::VectorXd h;
  Eigen::MatrixXd jacobian;
  SparseRows by_all;
};

bool Linearize(const Problem& problem, const Eigen::VectorXd& x, Linearized* made) {
  const ConstraintFamily& constraints = *problem.nonlinear_constraints();
  if (constraints.Residuals(x, &made->h) != Status::kOk) return false;
  std::vector<Eigen::Triplet<double>> entries;
  if (constraints.Jacobian(x, 0, &entries) != Status::kOk) return false;
  made->by_all.resize(constraints.size(), x.size());
  made->by_all.setFromTriplets(entries.begin(), entries.end());
  const LinearElimination& elimination = problem.elimination();
  made->jacobian = elimination.trivial()
                       ? Eigen::MatrixXd(made->by_all)
                       : Eigen::MatrixXd(SparseRows(made->by_all * elimination.z()));
  return made->jacobian.allFinite();
}

/// Rows of `held` only.
Linearized Part(const Linearized& all, const std::vector<int>& held) {
  return {all.h(held), all.jacobian(held, Eigen::all), {}};
}

/// The map from forces on y to moves of least length in x = offset + Z y: (Z'Z)^-1.
class Metric {
 public:
  explicit Metric(const LinearElimination& elimination) : trivial_(elimination.trivial()) {
    if (trivial_) return;
    const Eigen::SparseMatrix<double> z = elimination.z();
    factor_.compute(Eigen::SparseMatrix<double>(z.transpose() * z));
  }
  Eigen::MatrixXd Inverse(const Eigen::MatrixXd& right) const {
    return trivial_ ? right : Eigen::MatrixXd(factor_.solve(right));
  }

 private:
  bool trivial_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
};

/// Equations, and the inequalities that are missed or that x stands at.
std::vector<int> Held(const ConstraintFamily& constraints, const Eigen::VectorXd& h) {
  std::vector<int> held;
  for (int k = 0; k < constraints.size(); ++k) {
    if (!constraints.is_inequality(k) || h[k] <= kConstraintTolerance) held.push_back(k);
  }
  return held;
}

Eigen::VectorXd LeastSquares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  return matrix.completeOrthogonalDecomposition().solve(right);
}

/// Parameters of constraints where they start, inside the domain: past its ends nothing changes
/// with them.
void PlaceInside(const Problem& problem, Eigen::VectorXd* x) {
  for (const VariableRange& range : problem.ranges()) {
    if (range.name != kConstraintParameters) continue;
    x->segment(range.begin, range.size) = problem.start().segment(range.begin, range.size);
  }
}

/// Whether no two inequalities ask for opposite sides: unit normals of opposite sign, and distances
/// whose sum is negative.
bool CheckOpposites(const ConstraintFamily& constraints, const Linearized& all,
                    std::string* error) {
  constexpr double kAlike = 1e-9;
  for (int i = 0; i < constraints.size(); ++i) {
    for (int k = 0; k < i; ++k) {
      const double a = all.jacobian.row(i).norm(), b = all.jacobian.row(k).norm();
      if (!constraints.is_inequality(i) || !constraints.is_inequality(k) || a == 0.0 || b == 0.0) {
        continue;
      }
      const double apart = (all.jacobian.row(i) / a + all.jacobian.row(k) / b).norm();
      if (apart > kAlike || all.h[i] / a + all.h[k] / b >= 0.0) continue;
      *error = "constraints \"" + constraints.name(k) + "\" and \"" + constraints.name(i) +
               "\" contradict each other";
      return false;
    }
  }
  return true;
}

std::set<std::string> NamesOf(const std::vector<LinearConstraint>& linear,
                              const Eigen::VectorXd& force) {
  // Those that have to do with it: all others would only make the matrix larger.
  std::map<int, int> row_of;
  for (int v = 0; v < force.size(); ++v) {
    if (force[v] != 0.0) row_of.emplace(v, static_cast<int>(row_of.size()));
  }
  std::set<std::size_t> reached;
  for (std::size_t before = linear.size() + 1; reached.size() != before;) {
    before = reached.size();
    for (std::size_t i = 0; i < linear.size(); ++i) {
      const auto& coefficients = linear[i].coefficients;
      const bool touches =
          std::any_of(coefficients.begin(), coefficients.end(),
                      [&](const auto& entry) { return row_of.count(entry.first) > 0; });
      if (!touches || !reached.insert(i).second) continue;
      for (const auto& entry : coefficients) {
        row_of.emplace(entry.first, static_cast<int>(row_of.size()));
      }
    }
  }
  const auto num_rows = static_cast<Eigen::Index>(row_of.size());
  Eigen::MatrixXd gradients =
      Eigen::MatrixXd::Zero(num_rows, static_cast<Eigen::Index>(reached.size()));
  Eigen::VectorXd right = Eigen::VectorXd::Zero(num_rows);
  for (const auto& [variable, row] : row_of) right[row] = force[variable];
  Eigen::Index column = 0;
  for (const std::size_t i : reached) {
    for (const auto& [variable, value] : linear[i].coefficients) {
      gradients(row_of[variable], column) += value;
    }
    ++column;
  }
  std::set<std::string> names;
  if (reached.empty()) return names;
  const Eigen::VectorXd factors = LeastSquares(gradients, right);
  constexpr double kNoPart = 1e-9;
  column = 0;
  for (const std::size_t i : reached) {
    const double share = std::abs(factors[column]) * gradients.col(column).norm();
    if (share > kNoPart * right.norm()) names.insert(linear[i].name);
    ++column;
  }
  return names;
}

std::string Listed(const std::set<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "\"" : " and \"") + name + "\"";
  return text;
}

/// Of equations whose combination does not depend on the free variables and is not zero.
std::string ContradictionMessage(const ConstraintFamily& constraints,
                                 const Eigen::VectorXd& combination, const Linearized& all,
                                 const std::vector<LinearConstraint>& linear) {
  std::set<std::string> names;
  double largest = 0.0;
  for (int k = 0; k < combination.size(); ++k) {
    if (combination[k] == 0.0) continue;
    names.insert(constraints.name(k));
    largest = std::max(largest, std::abs(combination[k]) * all.by_all.row(k).norm());
  }
  // What is left of gradients that cancel each other is rounding.
  constexpr double kRounding = 1e-9;
  const Eigen::VectorXd force = all.by_all.transpose() * combination;
  std::string beside;
  if (force.norm() > kRounding * largest) beside = LinearConstraintsOf(linear, force);
  if (!beside.empty()) beside = " the linear constraints " + beside;
  if (names.size() > 1) {
    return "constraints " + Listed(names) + " contradict each other" +
           (beside.empty() ? "" : " under" + beside);
  }
  return "constraint " + Listed(names) + " contradicts" +
         (beside.empty() ? " the linear constraints" : beside);
}

}  // namespace

std::string LinearConstraintsOf(const std::vector<LinearConstraint>& linear,
                                const Eigen::VectorXd& force) {
  return Listed(NamesOf(linear, force));
}

Violation MeasureViolation(const Problem& problem, const Eigen::VectorXd& x) {
  Violation violation;
  const ConstraintFamily* const constraints = problem.nonlinear_constraints();
  if (constraints == nullptr) return violation;
  Eigen::VectorXd h;
  if (constraints->Residuals(x, &h) != Status::kOk) return {kInfinity, 0};
  for (int k = 0; k < constraints->size(); ++k) {
    const double missed = constraints->is_inequality(k) ? std::max(-h[k], 0.0) : std::abs(h[k]);
    if (violation.constraint >= 0 && missed <= violation.largest) continue;
    violation = {missed, k};
  }
  return violation;
}

bool MakeLagrangianGradient(const Problem& problem, const Eigen::VectorXd& x,
                            const Eigen::VectorXd& g, LagrangianGradient* made) {
  const ConstraintFamily& constraints = *problem.nonlinear_constraints();
  Linearized all;
  if (!Linearize(problem, x, &all)) return false;
  std::vector<int> held = Held(constraints, all.h);
  made->multipliers.setZero(constraints.size());
  while (!held.empty()) {
    const Linearized part = Part(all, held);
    const Eigen::VectorXd lambda = LeastSquares(part.jacobian.transpose(), -g);
    // An inequality that would have to pull does not hold x: the worst of them is let go.
    int worst = -1;
    for (int i = 0; i < lambda.size(); ++i) {
      const bool pulls =
          constraints.is_inequality(held[static_cast<std::size_t>(i)]) && lambda[i] > 0.0;
      if (pulls && (worst < 0 || lambda[i] > lambda[worst])) worst = i;
    }
    if (worst < 0) {
      for (int i = 0; i < lambda.size(); ++i) {
        made->multipliers[held[static_cast<std::size_t>(i)]] = lambda[i];
      }
      break;
    }
    held.erase(held.begin() + worst);
  }
  made->gradient = g + all.jacobian.transpose() * made->multipliers;
  return made->gradient.allFinite();
}

bool ProjectOntoConstraints(const Problem& problem, const Eigen::VectorXd& multipliers,
                            Eigen::VectorXd* y) {
  // Newton's digits double; what has not come near within so many steps does not.
  constexpr int kMostSteps = 50;
  const Metric metric(problem.elimination());
  Eigen::VectorXd at = *y;
  Eigen::VectorXd best = at;
  double least = kInfinity;
  for (int step = 0; step < kMostSteps; ++step) {
    const Eigen::VectorXd x = problem.elimination().Expand(at);
    Linearized all;
    if (!Linearize(problem, x, &all)) break;
    std::vector<int> held;
    double violation = 0.0;
    for (int k = 0; k < all.h.size(); ++k) {
      const bool is_slack = problem.nonlinear_constraints()->is_inequality(k) && all.h[k] >= 0.0 &&
                            multipliers[k] == 0.0;
      if (is_slack) continue;
      held.push_back(k);
      violation = std::max(violation, std::abs(all.h[k]));
    }
    // At rounding steps no longer help; before it a step may make things worse for a while.
    const bool settled = violation >= least && least <= kConstraintTolerance;
    if (violation < least) {
      least = violation;
      best = at;
    }
    if (settled || violation == 0.0) break;
    const Linearized part = Part(all, held);
    const Eigen::MatrixXd moves = metric.Inverse(part.jacobian.transpose());
    at -= moves * LeastSquares(part.jacobian * moves, part.h);
    if (!at.allFinite()) break;
  }
  if (!(least <= kConstraintTolerance)) return false;
  *y = best;
  return true;
}

bool CheckForContradictions(const Problem& problem, const std::vector<LinearConstraint>& linear,
                            std::string* error) {
  const ConstraintFamily& constraints = *problem.nonlinear_constraints();
  std::mt19937 random(20240501);
  Eigen::VectorXd y = problem.elimination().FreeVariables(problem.start());
  // Any point will do, unless it is a special one: the start is moved at random.
  for (double& entry : y) entry += 0.1 * (static_cast<double>(random()) / 4294967296.0 - 0.5);
  Eigen::VectorXd x = problem.elimination().Expand(y);
  PlaceInside(problem, &x);
  Linearized all;
  if (!Linearize(problem, x, &all)) return true;
  std::vector<int> equations;
  for (int k = 0; k < constraints.size(); ++k) {
    // An inequality that nothing moves is one more equation, if it is missed.
    const bool moves = all.jacobian.row(k).norm() > kConstraintTolerance;
    if (!constraints.is_inequality(k) || (!moves && all.h[k] < 0.0)) equations.push_back(k);
  }
  if (!CheckOpposites(constraints, all, error)) return false;
  if (equations.empty()) return true;
  Linearized part = Part(all, equations);
  Eigen::VectorXd norms = Eigen::VectorXd::Ones(part.h.size());
  for (Eigen::Index i = 0; i < part.h.size(); ++i) {
    const double norm = part.jacobian.row(i).norm();
    if (norm > kConstraintTolerance) norms[i] = norm;
    part.jacobian.row(i) /= norms[i];
    part.h[i] /= norms[i];
  }
  // With J P = Q R of rank r the columns of Q beyond r combine the equations to 0 = h'q.
  constexpr double kDependent = 1e-9;
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(part.jacobian);
  const Eigen::MatrixXd q = qr.householderQ();
  const Eigen::Index most = std::min(part.jacobian.rows(), part.jacobian.cols());
  Eigen::Index rank = 0;
  while (rank < most && std::abs(qr.matrixR()(rank, rank)) > kDependent) ++rank;
  for (Eigen::Index i = rank; i < q.cols(); ++i) {
    if (std::abs(q.col(i).dot(part.h)) <= kDependent) continue;
    Eigen::VectorXd combination = Eigen::VectorXd::Zero(constraints.size());
    for (Eigen::Index k = 0; k < q.rows(); ++k) {
      if (std::abs(q(k, i)) <= kDependent) continue;
      combination[equations[static_cast<std::size_t>(k)]] = q(k, i) / norms[k];
    }
    *error = ContradictionMessage(constraints, combination, all, linear);
    return false;
  }
  return true;
}

}  // namespace batten
