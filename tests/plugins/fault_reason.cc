// Ends for a reason that there is not.
#include "tests/plugins/fault.h"

class Faulty final : public FaultySolver {
 public:
  using FaultySolver::FaultySolver;

 private:
  std::optional<batten::Outcome> DoStep(Eigen::VectorXd* /*x*/) override {
    return batten::Outcome{static_cast<batten::StopReason>(77), ""};
  }
};

BATTEN_PLUGIN(registry) { registry->AddSolver<Faulty>(); }
