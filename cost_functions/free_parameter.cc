#include "cost_functions/free_parameter.h"

#include <utility>

#include "cost_functions/free_family.h"
#include "cost_functions/ordered_family.h"

namespace batten {
namespace {

class FreeParameterTerm final : public Term {
 public:
  TermInfo Info() const override { return FreeParameterResidual::Info(); }
  std::unique_ptr<BlockFamily> MakeFamily(const FitSetting& setting, const OptionValues& options,
                                          std::string* error) const override {
    if (setting.parameter_offset < 0) {
      *error = "term free_parameter needs a problem with free parameters; this one's are fixed";
      return nullptr;
    }
    auto family = std::make_unique<FreeFamily<FreeParameterResidual>>(
        setting, FreeParameterResidual(), options.Real("weight"), MakeLoss(options, setting.size));
    // Two points whose parameters are held have no order to lose.
    const bool none_moves = setting.ends_held && setting.data->size <= 2;
    if (!setting.keep_order || none_moves) return family;
    return std::make_unique<OrderedFamily>(setting, std::move(family),
                                           MakeLoss(options, setting.size));
  }
};

}  // namespace

TermInfo FreeParameterResidual::Info() {
  TermInfo info;
  info.name = "free_parameter";
  info.summary = "distance of the curve from each data point at a parameter that is a variable";
  info.source = "Zheng, Bo, Liu & Wang, CAGD 29, 2012, arXiv:1201.0070";
  info.free_parameters = true;
  return info;
}

std::unique_ptr<Term> MakeFreeParameterTerm() { return std::make_unique<FreeParameterTerm>(); }

}  // namespace batten
