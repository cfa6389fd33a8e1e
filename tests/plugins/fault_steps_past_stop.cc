// Asks for nothing after a stop, but moves x once more.
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
    while (context->Iterate(*x) == batten::Status::kOk) {
      if (objective->Gradient(*x, &gradient) != batten::Status::kOk) break;
      *x -= 0.01 * gradient;
    }
    *x -= 0.01 * gradient;
    return {context->stop_reason(), ""};
  }
};

BATTEN_PLUGIN(registry) { registry->AddSolver<Faulty>(); }
