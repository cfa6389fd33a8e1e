#include "cost_functions/foot_point.h"

#include "cost_functions/foot_family.h"
#include "cost_functions/free_parameter.h"

namespace batten {
namespace {

class FootPointTerm final : public Term {
 public:
  TermInfo Info() const override {
    TermInfo info;
    info.name = "foot_point";
    info.summary = "distance of each data point from the curve, at its foot point";
    info.source = "Wang, Pottmann & Liu, ACM TOG 25, 2006, sec. 1";
    info.foot_points = true;
    return info;
  }
  std::unique_ptr<BlockFamily> MakeFamily(const FitSetting& setting, const OptionValues& options,
                                          std::string* /*error*/) const override {
    // The residual is that of free parameters; only who chooses t differs.
    return std::make_unique<FootFamily<FreeParameterResidual>>(
        setting, FreeParameterResidual(), options.Real("weight"), MakeLoss(options, setting.size));
  }
};

}  // namespace

std::unique_ptr<Term> MakeFootPointTerm() { return std::make_unique<FootPointTerm>(); }

}  // namespace batten
