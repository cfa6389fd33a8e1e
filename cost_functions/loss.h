#ifndef BATTEN_COST_FUNCTIONS_LOSS_H_
#define BATTEN_COST_FUNCTIONS_LOSS_H_

#include <ceres/loss_function.h>

#include <memory>

#include "cost_functions/options.h"

namespace batten {

/// Loss of CommonTermOptions(); null for none. rho and its derivatives are those of Ceres' losses
/// of these names (loss_function.h) to rounding; unlike there, rho(s) keeps its digits where s is
/// small against the scale: log1p(x) instead of log(1 + x), and so on. `size` is what loss_scale is
/// given in units of: the longest side of the data's box, in the units of residuals.
std::shared_ptr<const ceres::LossFunction> MakeLoss(const OptionValues& options, double size);

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_LOSS_H_
