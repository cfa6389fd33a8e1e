#ifndef BATTEN_EXPERIMENTS_BENCH_MANIFEST_H_
#define BATTEN_EXPERIMENTS_BENCH_MANIFEST_H_

#include <string>

#include "experiments/bench_suite.h"

namespace batten {

/// What a run of `bench` was told beside its suite.
struct BenchSession {
  int jobs = 1;
  int shard = 1;
  int num_shards = 1;
};

/// Adds a session to FOLDER/manifest.json, which says what made the results: suite and its hash,
/// program, compiler and flags, libraries, processor, load. False with one sentence in `error`.
bool WriteManifest(const BenchSuite& suite, const BenchSession& session, const std::string& folder,
                   std::string* error);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_BENCH_MANIFEST_H_
