#include <glog/logging.h>

#include <algorithm>

#include "cost_functions/curve_fairing.h"
#include "cost_functions/end_condition.h"
#include "cost_functions/fairing.h"
#include "cost_functions/foot_point.h"
#include "cost_functions/free_parameter.h"
#include "cost_functions/interpolation.h"
#include "cost_functions/made_or_error.h"
#include "cost_functions/term.h"

namespace batten {
namespace {

// The built-in terms: one line each.
constexpr std::unique_ptr<Term> (*kBuiltInTerms[])() = {
    &MakeInterpolationTerm, &MakeFreeParameterTerm, &MakeFootPointTerm,    &MakeFairingTerm,
    &MakeEndPointTerm,      &MakeEndTangentTerm,    &MakeEndCurvatureTerm, &MakeCurveFairingTerm,
};

}  // namespace

std::vector<OptionInfo> CommonTermOptions() {
  return {OptionInfo::Real("weight", 1.0, 0.0, 1e30, "factor of the term's energy"),
          OptionInfo::Word("loss", "none", {"none", "huber", "cauchy", "tukey", "soft_l1"},
                           "robust loss applied to each block's squared residual"),
          OptionInfo::Real("loss_scale", 1.0, 1e-6, 1e6,
                           "residual size at which the loss departs from the square, in units of "
                           "the longest side of the data's box; mad: estimated from the residuals "
                           "of Huber's fit before the run")};
}

std::unique_ptr<BlockFamily> MakeFamilyOf(const Term& term, const FitSetting& setting,
                                          const OptionValues& options, std::string* error) {
  return MadeOrError(
      "term " + term.Info().name, [&] { return term.MakeFamily(setting, options, error); }, error);
}

TermRegistry& TermRegistry::Global() {
  static TermRegistry& registry = *[] {
    auto* made = new TermRegistry;
    for (const auto make : kBuiltInTerms) made->Register(make());
    return made;
  }();
  return registry;
}

void TermRegistry::Register(std::unique_ptr<Term> term) {
  const std::string name = term->Info().name;
  CHECK(terms_.emplace(name, std::move(term)).second) << "two terms are named " << name;
}

std::vector<std::string> TermRegistry::Names() const {
  std::vector<std::string> names;
  for (const auto& [name, term] : terms_) names.push_back(name);
  return names;
}

const Term* TermRegistry::Find(const std::string& name) const {
  const auto found = terms_.find(name);
  return found == terms_.end() ? nullptr : found->second.get();
}

bool TermRegistry::Resolve(const NameSpec& spec, const Term** term, OptionValues* options,
                           std::string* error) const {
  *term = Find(spec.name);
  if (*term == nullptr) {
    *error = UnknownNameMessage("term", spec.name, Names());
    return false;
  }
  if (spec.wrapped != nullptr) {
    *error = "term " + spec.name + " wraps nothing; found :" + spec.wrapped->ToString();
    return false;
  }
  const auto has = [&spec](const char* name) {
    return std::any_of(spec.options.begin(), spec.options.end(),
                       [name](const auto& option) { return option.first == name; });
  };
  if (has("loss_scale") && !has("loss")) {
    *error = "term " + spec.name + ": loss_scale is given without a loss; add /loss=NAME";
    return false;
  }
  std::vector<OptionInfo> infos = (*term)->Info().options;
  for (OptionInfo& info : CommonTermOptions()) infos.push_back(std::move(info));
  // A scale to be estimated, which problems do, is no number yet.
  NameSpec known = spec;
  known.options.erase(std::remove(known.options.begin(), known.options.end(),
                                  std::pair<std::string, std::string>("loss_scale", "mad")),
                      known.options.end());
  return ResolveOptions(infos, known, options, error);
}

}  // namespace batten
