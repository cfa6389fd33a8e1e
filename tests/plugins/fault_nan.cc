// Writes no number into x from its third step on.
#include <cmath>

#include "tests/plugins/fault.h"

class Faulty final : public FaultySolver {
 public:
  using FaultySolver::FaultySolver;

 private:
  std::optional<batten::Outcome> DoStep(Eigen::VectorXd* x) override {
    const auto outcome = GoodStep(x);
    if (num_steps() > 2) (*x)[0] = std::nan("");
    return outcome;
  }
};

BATTEN_PLUGIN(registry) { registry->AddSolver<Faulty>(); }
