#ifndef BATTEN_COST_FUNCTIONS_GAUSS_SITES_H_
#define BATTEN_COST_FUNCTIONS_GAUSS_SITES_H_

#include <memory>

#include "cost_functions/fit_setting.h"

namespace batten {

/// The `points` places of Gauss and Legendre's rule in every non-empty span of the domain, as sites
/// without data: the weights of site g are those of the rule, so that the sum of weight_g f(u_g) is
/// `factor` times the integral of f over the domain, each span times its factor in
/// setting.span_weights if there are any.
std::shared_ptr<const Sites> MakeGaussSites(const FitSetting& setting, int points, double factor);

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_GAUSS_SITES_H_
