#ifndef BATTEN_SPLINES_BLOCK_ENERGY_H_
#define BATTEN_SPLINES_BLOCK_ENERGY_H_

#include "splines/row_block.h"

namespace batten {

/// What is summed over the rows [A|Q] of a block.
enum class BlockQuantity {
  kEnergy,             ///< ||A P - Q||^2
  kEnergyAndGradient,  ///< That and 2 A'(A P - Q).
  kProductNorm         ///< ||A P||^2
};

/// points: P of the block's window (width x dimension, row-major). gradient: as large, written for
/// kEnergyAndGradient only.
using BlockEnergyKernel = double(const RowShape& shape, const RowBlock& block, const double* points,
                                 double* gradient);

/// The kernel for blocks of one shape: four rows at a time where the processor has AVX2, elsewhere
/// two; the last bits may differ between the two.
BlockEnergyKernel* FindBlockEnergyKernel(const RowShape& shape, BlockQuantity quantity);
/// That of processors without AVX2, in tests on others too.
BlockEnergyKernel* FindBlockEnergyKernelOfAnyProcessor(const RowShape& shape,
                                                       BlockQuantity quantity);

}  // namespace batten

#endif  // BATTEN_SPLINES_BLOCK_ENERGY_H_
