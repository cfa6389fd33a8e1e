// Steps differently once it has been run before in the same process.
#include "tests/plugins/fault.h"

class Faulty final : public FaultySolver {
 public:
  using FaultySolver::FaultySolver;

 private:
  std::optional<batten::Outcome> DoStep(Eigen::VectorXd* x) override {
    static int calls = 0;
    const Eigen::VectorXd before = *x;
    const auto outcome = GoodStep(x);
    if (++calls > 100 && !outcome.has_value()) *x = before + 0.5 * (*x - before);
    return outcome;
  }
};

BATTEN_PLUGIN(registry) { registry->AddSolver<Faulty>(); }
