#include "splines/block_gram.h"

#include "splines/processor.h"
#include "splines/row_pack.h"

namespace batten {
namespace {

namespace any_processor {
#define BATTEN_GRAM_LANES 2
#include "splines/gram_passes.inc"
#undef BATTEN_GRAM_LANES
}  // namespace any_processor

#if BATTEN_HAS_AVX2_KERNELS
#pragma GCC push_options
#pragma GCC target("avx2,fma")
namespace with_avx2 {
#define BATTEN_GRAM_LANES 4
#include "splines/gram_passes.inc"
#undef BATTEN_GRAM_LANES
}  // namespace with_avx2
#pragma GCC pop_options
#endif

/// gram by kernel(width, dimension), which takes right-hand sides that follow the coefficients, as
/// almost everywhere; by plain products for other sizes and places.
template <typename Kernel>
double GramBy(const RowShape& shape, const RowBlock& block, double* gram, const Kernel& kernel) {
  const int packs = block.stride / kPackLanes;
  const RowPack* const a = AsPacks(block.coefficients);
  const RowPack* const q = AsPacks(block.right_hand_sides);
  const bool adjoin = q == a + shape.width * packs;
  return WithFixedShape(shape.width, shape.dimension, [&](auto width, auto dimension) {
    if constexpr (width > 0) {
      if (adjoin) return kernel(width, dimension);
    }
    const int columns = shape.width + shape.dimension;
    for (int j = 0; j < shape.width; ++j) {
      double* row = gram + j * columns;
      for (int k = j; k < shape.width; ++k) row[k] = DotPacks(a + j * packs, a + k * packs, packs);
      for (int c = 0; c < shape.dimension; ++c) {
        row[shape.width + c] = DotPacks(a + j * packs, q + c * packs, packs);
      }
    }
    return DotPacks(q, q, shape.dimension * packs);
  });
}

}  // namespace

double BlockGramOfAnyProcessor(const RowShape& shape, const RowBlock& block, double* gram) {
  return GramBy(shape, block, gram, [&](auto width, auto dimension) {
    return any_processor::FixedGram<width, dimension>(block.coefficients, block.stride, gram);
  });
}

double BlockGram(const RowShape& shape, const RowBlock& block, double* gram) {
#if BATTEN_HAS_AVX2_KERNELS
  if (HasAvx2()) {
    return GramBy(shape, block, gram, [&](auto width, auto dimension) {
      return with_avx2::FixedGram<width, dimension>(block.coefficients, block.stride, gram);
    });
  }
#endif
  return BlockGramOfAnyProcessor(shape, block, gram);
}

}  // namespace batten
