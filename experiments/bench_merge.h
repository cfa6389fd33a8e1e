#ifndef BATTEN_EXPERIMENTS_BENCH_MERGE_H_
#define BATTEN_EXPERIMENTS_BENCH_MERGE_H_

#include <string>
#include <vector>

namespace batten {

/// What merging has to say beside its files.
struct MergeReport {
  int cells = 0;                       // in the merged folder
  int duplicates = 0;                  // rows that were in it, or came, more than once
  int missing = 0;                     // cells of the suite that no folder has
  std::vector<std::string> bad_lines;  // of the parts: BenchData::bad_lines
};

/// Puts results of one suite and one program into the folder `out`, which is created if missing and
/// keeps what it has: rows, instances, traces, iterates and logs. Of a cell that is there more than
/// once the first row stays. False with one sentence in `error`, before anything is written, for
/// folders of another suite or program.
bool MergeBenches(const std::string& out, const std::vector<std::string>& folders,
                  MergeReport* report, std::string* error);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_BENCH_MERGE_H_
