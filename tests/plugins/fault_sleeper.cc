// Sleeps for an hour in its second step.
#include <unistd.h>

#include "tests/plugins/fault.h"

class Faulty final : public FaultySolver {
 public:
  using FaultySolver::FaultySolver;

 private:
  std::optional<batten::Outcome> DoStep(Eigen::VectorXd* x) override {
    if (num_steps() == 1) sleep(3600);
    return GoodStep(x);
  }
};

BATTEN_PLUGIN(registry) { registry->AddSolver<Faulty>(); }
