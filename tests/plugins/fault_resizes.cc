// Makes x longer in its second step.
#include "tests/plugins/fault.h"

class Faulty final : public FaultySolver {
 public:
  using FaultySolver::FaultySolver;

 private:
  std::optional<batten::Outcome> DoStep(Eigen::VectorXd* x) override {
    const auto outcome = GoodStep(x);
    if (num_steps() == 2) x->conservativeResize(x->size() + 1);
    return outcome;
  }
};

BATTEN_PLUGIN(registry) { registry->AddSolver<Faulty>(); }
