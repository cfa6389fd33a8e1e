#ifndef BATTEN_SOLVERS_PLUGIN_H_
#define BATTEN_SOLVERS_PLUGIN_H_

// All that a plugin in C++ includes; docs/plugins.md.

#include <exception>
#include <optional>
#include <string>

#include "cost_functions/functor_family.h"
#include "solvers/plugin_card.h"
#include "solvers/plugin_registry.h"
#include "solvers/stepper.h"

namespace batten {

/// Where most terms have their blocks: one at each data point, one residual a coordinate.
/// A functor derived from it adds Info() and operator(); with `kAffine = true` it is compiled.
struct TermAtDataPoints {
  static constexpr bool kAffine = false;
  static constexpr int kDerivatives = 0;
  static constexpr int NumResiduals(int dimension) { return dimension; }
  explicit TermAtDataPoints(const OptionValues& /*options*/) {}
  std::shared_ptr<const Sites> MakeSites(const FitSetting& setting) const {
    return std::shared_ptr<const Sites>(std::shared_ptr<const Sites>(), setting.data);
  }
};

/// What list and help say of a term without options.
inline TermInfo MakeTermInfo(std::string name, std::string summary, std::string source) {
  TermInfo info;
  info.name = std::move(name);
  info.summary = std::move(summary);
  info.source = std::move(source);
  return info;
}

/// A Stepper without options, for any E without bounds: Derived has kName, kSummary and kSource and
/// overrides DoStep, and DoStart and WhyUnsupported where it needs them.
template <typename Derived>
class SimpleStepper : public Stepper {
 public:
  static SolverInfo ClassInfo() {
    SolverInfo info;
    info.name = Derived::kName;
    info.summary = Derived::kSummary;
    info.source = Derived::kSource;
    return info;
  }
  explicit SimpleStepper(const OptionValues& /*options*/) {}
  SolverInfo Info() const override { return Derived::ClassInfo(); }
  std::string WhyUnsupported(const Objective& objective) const override {
    const std::string why = WhyNoBounds(objective, Derived::kName);
    return why.empty() ? WhyNoOrder(objective.problem(), Derived::kName) : why;
  }

 private:
  std::optional<Outcome> DoStart(Eigen::VectorXd* /*x*/) override { return std::nullopt; }
};

/// A functor (cost_functions/functor_family.h) as a term of the plugin.
template <typename Functor>
void AddTerm(PluginRegistry* registry) {
  registry->Add(std::make_unique<FunctorTerm<Functor>>());
}

}  // namespace batten

/// The two symbols of a plugin, and what it registers:
///   BATTEN_PLUGIN(registry) { registry->AddSolver<MySolver>(); }
/// The function may throw: the plugin is then refused with what() as the reason.
#define BATTEN_PLUGIN(registry)                                                           \
  static void BattenRegisterPlugin(::batten::PluginRegistry* registry);                   \
  extern "C" BATTEN_EXPORT const batten_card* batten_plugin_card(void) {                  \
    return &::batten::kThisCard;                                                          \
  }                                                                                       \
  extern "C" BATTEN_EXPORT void batten_plugin_register(::batten::PluginRegistry* added) { \
    BattenRegisterPlugin(added);                                                          \
  }                                                                                       \
  static void BattenRegisterPlugin(::batten::PluginRegistry* registry)

#endif  // BATTEN_SOLVERS_PLUGIN_H_
