// Writes where nothing is in its second step.
#include "tests/plugins/fault.h"

class Faulty final : public FaultySolver {
 public:
  using FaultySolver::FaultySolver;

 private:
  std::optional<batten::Outcome> DoStep(Eigen::VectorXd* x) override {
    if (num_steps() == 1) *const_cast<volatile int*>(static_cast<int*>(nullptr)) = 1;
    return GoodStep(x);
  }
};

BATTEN_PLUGIN(registry) { registry->AddSolver<Faulty>(); }
