// Throws in its second step.
#include <stdexcept>

#include "tests/plugins/fault.h"

class Faulty final : public FaultySolver {
 public:
  using FaultySolver::FaultySolver;

 private:
  std::optional<batten::Outcome> DoStep(Eigen::VectorXd* x) override {
    if (num_steps() == 1) throw std::runtime_error("no such luck");
    return GoodStep(x);
  }
};

BATTEN_PLUGIN(registry) { registry->AddSolver<Faulty>(); }
