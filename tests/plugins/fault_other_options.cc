// Says that it ran with another memory than it was asked for.
#include "tests/plugins/fault.h"

class Faulty final : public FaultySolver {
 public:
  static batten::SolverInfo ClassInfo() {
    batten::SolverInfo info = FaultySolver::ClassInfo();
    info.options = {batten::OptionInfo::Integer("memory", 5, 1, 9, "vectors kept"),
                    batten::OptionInfo::Word("rule", "first", {"first", "second"}, "of its steps")};
    return info;
  }
  using FaultySolver::FaultySolver;
  batten::SolverInfo Info() const override { return ClassInfo(); }

 private:
  std::optional<batten::Outcome> DoStart(Eigen::VectorXd* /*x*/) override {
    context()->Note("options that ran", "faulty/memory=6/rule=first");
    return std::nullopt;
  }
  std::optional<batten::Outcome> DoStep(Eigen::VectorXd* x) override { return GoodStep(x); }
};

BATTEN_PLUGIN(registry) { registry->AddSolver<Faulty>(); }
