// Steps along what stands behind the end of x.
#include "tests/plugins/fault.h"

class Faulty final : public FaultySolver {
 public:
  using FaultySolver::FaultySolver;

 private:
  std::optional<batten::Outcome> DoStep(Eigen::VectorXd* x) override {
    const auto outcome = GoodStep(x);
    const double* const numbers = x->data();
    if (numbers[x->size()] != 0.0) (*x)[0] += 1e-3;
    return outcome;
  }
};

BATTEN_PLUGIN(registry) { registry->AddSolver<Faulty>(); }
