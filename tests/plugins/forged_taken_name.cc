#include "solvers/plugin.h"

// The first could be registered; it must not be there without the second.
struct First : batten::TermAtDataPoints {
  using TermAtDataPoints::TermAtDataPoints;
  static batten::TermInfo Info() { return batten::MakeTermInfo("first", "is free", "none"); }
  template <typename SiteType, typename T>
  bool operator()(const SiteType&, const T* const*, T*) const {
    return false;
  }
};

class Second final : public batten::SimpleStepper<Second> {
 public:
  static constexpr char kName[] = "lbfgs";
  static constexpr char kSummary[] = "has a name that is taken";
  static constexpr char kSource[] = "none";
  using SimpleStepper::SimpleStepper;

 private:
  std::optional<batten::Outcome> DoStep(Eigen::VectorXd* /*x*/) override { return std::nullopt; }
};

BATTEN_PLUGIN(registry) {
  batten::AddTerm<First>(registry);
  registry->AddSolver<Second>();
}
