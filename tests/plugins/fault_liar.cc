// Says that it has solved what it has not.
#include "tests/plugins/fault.h"

class Faulty final : public FaultySolver {
 public:
  using FaultySolver::FaultySolver;

 private:
  std::optional<batten::Outcome> DoStep(Eigen::VectorXd* x) override {
    const auto outcome = GoodStep(x);
    if (outcome.has_value() || num_steps() < 2) return outcome;
    return batten::Outcome{batten::StopReason::kSolved, "so it says"};
  }
};

BATTEN_PLUGIN(registry) { registry->AddSolver<Faulty>(); }
