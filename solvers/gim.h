#ifndef BATTEN_SOLVERS_GIM_H_
#define BATTEN_SOLVERS_GIM_H_

#include <vector>

#include "solvers/stepper.h"
#include "splines/bspline_basis.h"

namespace batten {

/// Geometric iteration method (progressive-iterative approximation): P_j += Q - C at the parameter
/// paired with j, as many control points as points. docs/solvers/gim.md.
class GimSolver final : public FixedPoint {
 public:
  static SolverInfo ClassInfo();
  explicit GimSolver(const OptionValues& /*options*/) {}
  SolverInfo Info() const override { return ClassInfo(); }
  std::string WhyUnsupported(const Objective& objective) const override;
  Status Map(const Eigen::VectorXd& x, Eigen::VectorXd* g_of_x) override;

 private:
  std::optional<Outcome> DoStart(Eigen::VectorXd* x) override;
  double SpectralRadius() const;

  std::vector<int> control_point_of_row_;
  Points residuals_;
};

/// Pairs data points with control points: in the order of the parameters, and of the Greville
/// abscissae; on closed curves with the rotation that brings them closest. result[row] = j; rows
/// are numbered in the order of their parameters' spans.
std::vector<int> PairWithControlPoints(const BsplineBasis& basis,
                                       const std::vector<double>& parameters_by_row);

}  // namespace batten

#endif  // BATTEN_SOLVERS_GIM_H_
