#ifndef BATTEN_SPLINES_BAND_SUMS_H_
#define BATTEN_SPLINES_BAND_SUMS_H_

#include <vector>

#include "splines/normal_band.h"

namespace batten {

/// NormalBand::AbsoluteRowSums into *sums, which is allocated only if it is too small, of a matrix
/// in whose band no two entries fall on one place: not cyclic, or n >= 2 width - 1.
void AbsoluteRowSums(const NormalBand& matrix, std::vector<double>* sums);

}  // namespace batten

#endif  // BATTEN_SPLINES_BAND_SUMS_H_
