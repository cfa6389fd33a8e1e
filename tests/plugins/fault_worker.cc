// Works without end in its second step.
#include "tests/plugins/fault.h"

class Faulty final : public FaultySolver {
 public:
  using FaultySolver::FaultySolver;

 private:
  std::optional<batten::Outcome> DoStep(Eigen::VectorXd* x) override {
    for (volatile unsigned k = 0; num_steps() == 1; k = k + 1U) {
    }
    return GoodStep(x);
  }
};

BATTEN_PLUGIN(registry) { registry->AddSolver<Faulty>(); }
