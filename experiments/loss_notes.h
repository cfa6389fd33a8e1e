#ifndef BATTEN_EXPERIMENTS_LOSS_NOTES_H_
#define BATTEN_EXPERIMENTS_LOSS_NOTES_H_

#include "experiments/run.h"
#include "problems/problem.h"

namespace batten {

/// Notes on terms with a loss, of which a user cannot see from E and |g|:
/// - `rejected points`: more than a quarter of a term's blocks have a weight rho'(|r|^2) below a
///   tenth of what they have without a loss, or control points have lost all but a thousandth of
///   the weight of their rows, so that hardly anything holds them.
/// - `far from the minimum`: the run claims a minimum (IsSuccess), and one step of reweighted least
///   squares from its end, which does not move from a minimum, moves control points by more than
///   1e-6 of the data's size. Where `irls:banded_qr` takes the problem; costs one QR in the band.
void NoteLosses(const Problem& problem, RunResult* run);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_LOSS_NOTES_H_
