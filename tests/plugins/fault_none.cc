// The solver of fault.h as it is: the check must pass it.
#include "tests/plugins/fault.h"

class Faulty final : public FaultySolver {
 public:
  using FaultySolver::FaultySolver;

 private:
  std::optional<batten::Outcome> DoStep(Eigen::VectorXd* x) override { return GoodStep(x); }
};

BATTEN_PLUGIN(registry) { registry->AddSolver<Faulty>(); }
