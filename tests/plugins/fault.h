// A gradient method that works, for plugins with one fault each.
#ifndef BATTEN_TESTS_PLUGINS_FAULT_H_
#define BATTEN_TESTS_PLUGINS_FAULT_H_

#include "solvers/plugin.h"

/// Cauchy's step on quadratics: x -= (g'g / g'H g) g. Plugins override DoStep and break it.
class FaultySolver : public batten::Stepper {
 public:
  static batten::SolverInfo ClassInfo() {
    batten::SolverInfo info;
    info.name = "faulty";
    info.summary = "has a fault";
    info.source = "tests/plugins";
    return info;
  }
  explicit FaultySolver(const batten::OptionValues& /*options*/) {}
  batten::SolverInfo Info() const override { return ClassInfo(); }
  std::string WhyUnsupported(const batten::Objective& objective) const override {
    return batten::WhyNoUnboundedCurveView(objective, "faulty");
  }

 protected:
  std::optional<batten::Outcome> GoodStep(Eigen::VectorXd* x) {
    Eigen::VectorXd gradient, product;
    batten::Status status = objective()->Gradient(*x, &gradient);
    if (status == batten::Status::kOk) status = objective()->HessianTimes(*x, gradient, &product);
    if (status != batten::Status::kOk) return Ended(status);
    if (gradient.isZero(0.0)) return batten::Outcome{batten::StopReason::kSolved, "g is 0"};
    *x -= gradient.squaredNorm() / gradient.dot(product) * gradient;
    ++num_steps_;
    return std::nullopt;
  }
  int num_steps() const { return num_steps_; }

 private:
  std::optional<batten::Outcome> DoStart(Eigen::VectorXd* /*x*/) override { return std::nullopt; }

  int num_steps_ = 0;
};

#endif  // BATTEN_TESTS_PLUGINS_FAULT_H_
