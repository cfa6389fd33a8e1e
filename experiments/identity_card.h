#ifndef BATTEN_EXPERIMENTS_IDENTITY_CARD_H_
#define BATTEN_EXPERIMENTS_IDENTITY_CARD_H_

#include <string>

#include "experiments/run.h"

namespace batten {

/// What the solvers of a run say in their note kOptionsThatRan otherwise than they were asked:
/// "asked memory=5, ran memory=6"; empty: nothing.
std::string OptionsThatDiffer(const RunResult& run);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_IDENTITY_CARD_H_
