#ifndef BATTEN_PROBLEMS_FIT_GUARD_H_
#define BATTEN_PROBLEMS_FIT_GUARD_H_

#include <optional>
#include <string>
#include <vector>

#include "cost_functions/options.h"

namespace batten {

/// Adds what keeps a curve with free parameters from running where no point is nearest to it, which
/// costs nothing otherwise: `length` bounds the length of stretches without data by a small part of
/// the integral of |C'|^2, `bending` how they turn by one of |C''|^2 (option weight: per data
/// point). A guard is a fairing term of the problem, so that every solver honours it. `none` adds
/// nothing. False with one sentence in `error` for a guard that is not known.
bool ApplyGuard(const NameSpec& guard, int num_points, std::vector<NameSpec>* terms,
                std::string* error);

/// One is asked for: `none`, which says that there shall be none, is not.
bool HasGuard(const std::optional<NameSpec>& guard);

/// The guard `length` as a term of this weight.
NameSpec LengthGuard(double weight);

}  // namespace batten

#endif  // BATTEN_PROBLEMS_FIT_GUARD_H_
