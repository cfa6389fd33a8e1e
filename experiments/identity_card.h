#ifndef BATTEN_EXPERIMENTS_IDENTITY_CARD_H_
#define BATTEN_EXPERIMENTS_IDENTITY_CARD_H_

#include <string>

#include "experiments/run.h"

namespace batten {

/// What the solvers of a run say in their note kOptionsThatRan otherwise than they were asked:
/// "asked memory=5, ran memory=6"; empty: nothing.
std::string OptionsThatDiffer(const RunResult& run);

/// The solver with all options as it ran, of wrapped ones too: those that a note kOptionsThatRan
/// names as it says, the others as they were resolved from defaults and what was asked, as in
/// SolverIdentity(). What a note names beyond the solvers that were asked for stands behind it.
std::string EffectiveIdentity(const RunResult& run);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_IDENTITY_CARD_H_
