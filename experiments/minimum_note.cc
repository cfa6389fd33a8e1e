#include "experiments/minimum_note.h"

#include "experiments/comparison_reference.h"
#include "experiments/short_number.h"

namespace batten {

void NoteDistanceFromMinimum(const Problem& problem, RunResult* run) {
  constexpr double kFar = 1e-6;
  if (!IsSuccess(run->outcome.reason) || !run->x.allFinite()) return;
  const DirectReference direct(problem);
  if (!direct.known() || !direct.unique()) return;
  const double distance = direct.Distance(run->x);
  if (!(distance > kFar)) return;
  run->notes.emplace_back("far from the minimum",
                          "control points are up to " + ShortNumber(distance, 2) +
                              " of the data's size away from it, though |g| is small: E is "
                              "ill-conditioned; banded_qr keeps more digits");
}

}  // namespace batten
