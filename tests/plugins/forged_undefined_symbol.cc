#include "solvers/plugin.h"

namespace batten {
void FunctionThatNoBattenHas(int);  // of another version
}

BATTEN_PLUGIN(registry) { batten::FunctionThatNoBattenHas(registry == nullptr ? 0 : 1); }
