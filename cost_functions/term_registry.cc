#include <glog/logging.h>

#include <limits>

#include "cost_functions/interpolation.h"
#include "cost_functions/term.h"

namespace batten {
namespace {

// The built-in terms: one line each.
constexpr std::unique_ptr<Term> (*kBuiltInTerms[])() = {
    &MakeInterpolationTerm,
};

}  // namespace

std::vector<OptionInfo> CommonTermOptions() {
  constexpr double kLargest = 1e300;
  return {OptionInfo::Real("weight", 1.0, 0.0, kLargest, "factor of the term's energy"),
          OptionInfo::Word("loss", "none", {"none", "huber", "cauchy", "tukey", "soft_l1"},
                           "robust loss applied to each block's squared residual"),
          OptionInfo::Real("loss_scale", 1.0, 1e-300, kLargest,
                           "residual size at which the loss departs from the square, in units of "
                           "the data scaled to the unit box")};
}

std::shared_ptr<const ceres::LossFunction> MakeLoss(const OptionValues& options) {
  const std::string& loss = options.Word("loss");
  const double scale = options.Real("loss_scale");
  if (loss == "huber") return std::make_shared<ceres::HuberLoss>(scale);
  if (loss == "cauchy") return std::make_shared<ceres::CauchyLoss>(scale);
  if (loss == "tukey") return std::make_shared<ceres::TukeyLoss>(scale);
  if (loss == "soft_l1") return std::make_shared<ceres::SoftLOneLoss>(scale);
  return nullptr;
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
  std::vector<OptionInfo> infos = (*term)->Info().options;
  for (OptionInfo& info : CommonTermOptions()) infos.push_back(std::move(info));
  return ResolveOptions(infos, spec, options, error);
}

}  // namespace batten
