#ifndef BATTEN_EXPERIMENTS_BENCH_MATRIX_H_
#define BATTEN_EXPERIMENTS_BENCH_MATRIX_H_

#include <string>
#include <vector>

#include "experiments/bench_problem.h"
#include "experiments/bench_suite.h"

namespace batten {

/// One run of one solver: what one process does, and a row of cells.jsonl.
struct BenchCell {
  std::size_t problem = 0;  // in BenchSuite::problems
  std::size_t terms = 0;
  std::size_t solver = 0;
  CellSeeds seeds;
  int repetition = 1;  // from 1
  int instance = 0;    // cells of one instance differ in solver, its seed and repetition alone
};

/// All cells of a suite, in the order in which they run: repetition by repetition, each in a random
/// order of its own (but with "shuffled": false). Of choices of terms that are the same on a
/// problem the first runs.
std::vector<BenchCell> BenchMatrix(const BenchSuite& suite);
/// One sentence for each problem and choice of terms that is left out as the same as an earlier
/// one.
std::vector<std::string> RepeatedTerms(const BenchSuite& suite);
/// Those of part `shard` of `num_shards`, counted from 1: whole instances, so that solvers that are
/// compared run on one machine.
std::vector<BenchCell> ShardOf(const std::vector<BenchCell>& cells, int shard, int num_shards);

/// Repetitions walk the same way: one of them is drawn.
bool KeepsIterates(const BenchSuite& suite, const BenchCell& cell);

/// "rhino | own | lbfgs | data 1 start 2 seed 1 | repetition 3"
std::string CellText(const BenchSuite& suite, const BenchCell& cell);

/// What decides whether a finished row is the row that would be computed now: this program,
/// loaded plugins with the libraries that they bring in, the problem, its data, terms, solver with
/// all its options, rule, limits and seeds.
std::string BenchCellKey(const BenchSuite& suite, const BenchCell& cell);
/// The same of what all cells of an instance share.
std::string InstanceKey(const BenchSuite& suite, const BenchCell& cell);
/// Of all that a suite says, whatever its spelling.
std::string SuiteHash(const BenchSuite& suite);

/// The name with all options as they are used, of wrapped ones too:
/// "anderson/window=5/...:lspia/...".
std::string SolverIdentity(const NameSpec& solver);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_BENCH_MATRIX_H_
