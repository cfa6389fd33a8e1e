#ifndef BATTEN_SPLINES_BEZIER_LOOPS_H_
#define BATTEN_SPLINES_BEZIER_LOOPS_H_

#include "splines/bezier_cutter.h"
#include "splines/bezier_piece_list.h"

namespace batten {

// The ways through the pieces of a curve. Each fills an empty `list`, and of `result` the rounds,
// the number of failing pieces and the end. `points`: the curve's control points.

/// Only pieces that fail are cut, the first one of the curve first. False where that takes more
/// than options.max_pieces; `list` and `result` are then worth nothing.
bool CutAdaptively(const double* points, const SubdivisionOptions& options, PieceCutter* cutter,
                   PieceList* list, Subdivision* result);

/// As many pieces as options.max_pieces allows, spent where they are needed most: the piece that
/// is farthest from passing is halved, from the whole curve on.
void HalveWorstFirst(const double* points, const SubdivisionOptions& options, PieceCutter* cutter,
                     PieceList* list, Subdivision* result);

/// Every piece is cut in each round, until all pass.
void CutInRounds(const double* points, const SubdivisionOptions& options, PieceCutter* cutter,
                 PieceList* list, Subdivision* result);

}  // namespace batten

#endif  // BATTEN_SPLINES_BEZIER_LOOPS_H_
