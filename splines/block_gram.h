#ifndef BATTEN_SPLINES_BLOCK_GRAM_H_
#define BATTEN_SPLINES_BLOCK_GRAM_H_

#include "splines/row_block.h"

namespace batten {

/// gram (row-major, width x (width + dimension)) = the upper triangle of A'A and all of A'Q of the
/// block's rows [A|Q]; what stands below the diagonal is left alone. Returns ||Q||^2.
/// Four rows at a time where the processor has AVX2, elsewhere two: the last bits may differ
/// between the two.
double BlockGram(const RowShape& shape, const RowBlock& block, double* gram);
/// The same on processors without AVX2, and in tests on others.
double BlockGramOfAnyProcessor(const RowShape& shape, const RowBlock& block, double* gram);

}  // namespace batten

#endif  // BATTEN_SPLINES_BLOCK_GRAM_H_
