#include "splines/block_energy.h"

#include "splines/processor.h"
#include "splines/row_window.h"

namespace batten {
namespace {

namespace energy_of_any_processor {
#define BATTEN_ENERGY_LANES 2
#include "splines/energy_passes.inc"
#undef BATTEN_ENERGY_LANES
}  // namespace energy_of_any_processor

#if BATTEN_HAS_AVX2_KERNELS
#pragma GCC push_options
#pragma GCC target("avx2,fma")
namespace energy_with_avx2 {
#define BATTEN_ENERGY_LANES 4
#include "splines/energy_passes.inc"
#undef BATTEN_ENERGY_LANES
}  // namespace energy_with_avx2
#pragma GCC pop_options
#endif

/// For sizes that no pass is compiled for: one coordinate at a time.
template <BlockQuantity kQuantity>
double EnergyByCoordinate(const RowShape& shape, const RowBlock& block, const double* points,
                          double* gradient) {
  RowPack residual[kMaxRowsPerBlock / kPackLanes];
  double energy = 0.0;
  for (int c = 0; c < shape.dimension; ++c) {
    ResidualOfCoordinate<kQuantity != BlockQuantity::kProductNorm>(shape, block, points, c,
                                                                   residual);
    energy += DotPacks(residual, residual, block.stride / kPackLanes);
    if (kQuantity == BlockQuantity::kEnergyAndGradient) {
      GradientOfCoordinate(shape, block, residual, c, 2.0, gradient);
    }
  }
  return energy;
}

template <BlockQuantity kQuantity>
BlockEnergyKernel* Find(const RowShape& shape, [[maybe_unused]] bool wide) {
  return WithFixedShape(
      shape.width, shape.dimension, [&](auto width, auto dimension) -> BlockEnergyKernel* {
        if constexpr (width < 0) {
          return EnergyByCoordinate<kQuantity>;
        } else {
#if BATTEN_HAS_AVX2_KERNELS
          if (wide) return energy_with_avx2::FixedEnergy<width, dimension, kQuantity>;
#endif
          return energy_of_any_processor::FixedEnergy<width, dimension, kQuantity>;
        }
      });
}

BlockEnergyKernel* Find(const RowShape& shape, BlockQuantity quantity, bool wide) {
  if (quantity == BlockQuantity::kEnergy) return Find<BlockQuantity::kEnergy>(shape, wide);
  if (quantity == BlockQuantity::kProductNorm) {
    return Find<BlockQuantity::kProductNorm>(shape, wide);
  }
  return Find<BlockQuantity::kEnergyAndGradient>(shape, wide);
}

}  // namespace

BlockEnergyKernel* FindBlockEnergyKernel(const RowShape& shape, BlockQuantity quantity) {
  return Find(shape, quantity, HasAvx2());
}

BlockEnergyKernel* FindBlockEnergyKernelOfAnyProcessor(const RowShape& shape,
                                                       BlockQuantity quantity) {
  return Find(shape, quantity, false);
}

}  // namespace batten
