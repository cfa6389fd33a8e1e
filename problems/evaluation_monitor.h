#ifndef BATTEN_PROBLEMS_EVALUATION_MONITOR_H_
#define BATTEN_PROBLEMS_EVALUATION_MONITOR_H_

#include <Eigen/Core>

namespace batten {

enum class Evaluation { kEnergy, kGradient, kJacobian, kProduct, kProjection };

/// Told of every evaluation that a solver asks for, before it is done.
class EvaluationMonitor {
 public:
  virtual ~EvaluationMonitor() = default;
  /// `x` is the point, null for products that belong to no point. False: the budget is used up, the
  /// evaluation is not done and the solver gets Status::kStop.
  virtual bool Allow(Evaluation kind, const Eigen::VectorXd* x) = 0;
};

}  // namespace batten

#endif  // BATTEN_PROBLEMS_EVALUATION_MONITOR_H_
