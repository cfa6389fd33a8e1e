// A solver and a term that cannot be made, each in the way that it is asked for.
#include <csignal>
#include <stdexcept>

#include "tests/plugins/fault.h"

namespace {

batten::OptionInfo How() {
  return batten::OptionInfo::Word("how", "well", {"well", "throws", "crashes", "hangs"}, "fault");
}

void Make(const std::string& how) {
  if (how == "throws") throw std::runtime_error("out of order");
  if (how == "crashes") std::raise(SIGSEGV);
  for (volatile bool hangs = how == "hangs"; hangs;) {
  }
}

}  // namespace

class Faulty final : public FaultySolver {
 public:
  static batten::SolverInfo ClassInfo() {
    batten::SolverInfo info = FaultySolver::ClassInfo();
    info.options = {How()};
    return info;
  }
  explicit Faulty(const batten::OptionValues& options) : FaultySolver(options) {
    Make(options.Word("how"));
  }
  batten::SolverInfo Info() const override { return ClassInfo(); }

 private:
  std::optional<batten::Outcome> DoStep(Eigen::VectorXd* x) override { return GoodStep(x); }
};

struct FaultyTerm : batten::TermAtDataPoints {
  static batten::TermInfo Info() {
    batten::TermInfo info = batten::MakeTermInfo("faulty_term", "cannot be made", "tests/plugins");
    info.options = {How()};
    return info;
  }
  explicit FaultyTerm(const batten::OptionValues& options) : TermAtDataPoints(options) {
    Make(options.Word("how"));
  }
  template <typename SiteType, typename T>
  bool operator()(const SiteType& site, const T* const* control_points, T* residuals) const {
    for (int c = 0; c < site.dimension(); ++c) {
      residuals[c] = site.Curve(control_points, c) - site.point(c);
    }
    return true;
  }
};

BATTEN_PLUGIN(registry) {
  registry->AddSolver<Faulty>();
  batten::AddTerm<FaultyTerm>(registry);
}
