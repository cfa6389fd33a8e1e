// Takes memory without end in its second step, and uses it.
#include <vector>

#include "tests/plugins/fault.h"

class Faulty final : public FaultySolver {
 public:
  using FaultySolver::FaultySolver;

 private:
  std::optional<batten::Outcome> DoStep(Eigen::VectorXd* x) override {
    static std::vector<std::vector<char>> hoard;
    while (num_steps() == 1) hoard.emplace_back(1 << 24, 'x');
    return GoodStep(x);
  }
};

BATTEN_PLUGIN(registry) { registry->AddSolver<Faulty>(); }
