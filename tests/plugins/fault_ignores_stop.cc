// Goes on evaluating and booking after it was told to stop.
#include "tests/plugins/fault.h"

class Faulty final : public batten::Solver {
 public:
  static batten::SolverInfo ClassInfo() { return FaultySolver::ClassInfo(); }
  explicit Faulty(const batten::OptionValues& /*options*/) {}
  batten::SolverInfo Info() const override { return ClassInfo(); }
  std::string WhyUnsupported(const batten::Objective& objective) const override {
    return batten::WhyNoUnboundedCurveView(objective, "faulty");
  }

 private:
  batten::Outcome DoMinimize(batten::Objective* objective, batten::RunContext* context,
                             Eigen::VectorXd* x) override {
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(x->size());
    context->Iterate(*x);
    for (int step = 0; step < 50; ++step) {
      objective->Gradient(*x, &gradient);
      *x -= 0.01 * gradient;
      context->Iterate(*x);
    }
    return {context->stop_reason(), ""};
  }
};

BATTEN_PLUGIN(registry) { registry->AddSolver<Faulty>(); }
