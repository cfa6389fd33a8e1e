#ifndef BATTEN_EXPERIMENTS_BENCH_NOTES_H_
#define BATTEN_EXPERIMENTS_BENCH_NOTES_H_

#include "experiments/bench_results.h"

namespace batten {

/// Fills in results->notes and what they imply.
void AddNotes(BenchResults* results);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_BENCH_NOTES_H_
