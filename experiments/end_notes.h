#ifndef BATTEN_EXPERIMENTS_END_NOTES_H_
#define BATTEN_EXPERIMENTS_END_NOTES_H_

#include "experiments/curve_fairness.h"
#include "experiments/run.h"
#include "problems/problem.h"

namespace batten {

/// Where E is quadratic with one minimum, and the run claims to have reached it (IsSuccess) with
/// control points farther than 1e-6 of the data's size from the direct answer, a note that says how
/// far: beside heavy terms |g| is small, or rounding noise, long before P is near. Costs one QR of
/// the rows in their band; nothing after banded_qr, which is that answer.
void NoteDistanceFromMinimum(const Problem& problem, RunResult* run);

/// A note on each term curve_fairing (bending, without a loss or weights of spans) whose Gauss rule
/// is off by more than a hundredth of the integral that `fairness` has of the same curve: what is
/// minimised bends sharply between the rule's points.
void NoteErrorsOfRules(const Problem& problem, const CurveFairness& fairness, RunResult* run);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_END_NOTES_H_
