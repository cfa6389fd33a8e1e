#ifndef BATTEN_SOLVERS_CERES_SPANS_H_
#define BATTEN_SOLVERS_CERES_SPANS_H_

#include <ceres/cost_function.h>

#include <memory>
#include <vector>

#include "problems/curve_view.h"

namespace batten {

/// All rows of one span as one residual block.
struct SpanBlock {
  std::vector<int>
      begins;  ///< Where its points begin in x: its parameter blocks, dimension() each.
  std::unique_ptr<ceres::CostFunction> cost;
};

/// E = ||A P - Q||^2, span by span: with the rows of a span factored as A = O (R; 0), O orthogonal,
///   ||A P - Q||^2 = ||R P - C||^2 + ||C'||^2,  O'Q = (C; C'),
/// a block has the residuals R P - C, at most (p + 1) d numbers however many rows there are, and
/// the derivative R. The second part does not depend on P and is left out.
std::vector<SpanBlock> MakeSpanBlocks(const CurveView& view);

}  // namespace batten

#endif  // BATTEN_SOLVERS_CERES_SPANS_H_
