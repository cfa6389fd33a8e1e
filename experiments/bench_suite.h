#ifndef BATTEN_EXPERIMENTS_BENCH_SUITE_H_
#define BATTEN_EXPERIMENTS_BENCH_SUITE_H_

#include <optional>
#include <string>
#include <vector>

#include "experiments/run.h"
#include "problems/catalogue.h"

namespace batten {

/// Points on a known spline: data whose answer is known.
struct SyntheticTruth {
  std::string shape;   // star (closed) or wave (open)
  int points = 0;      // >= 2
  double noise = 0.0;  // standard deviation of each coordinate; the truth has a size of about 1
};

/// One problem of a suite, before its terms and seeds are chosen.
struct BenchProblem {
  std::string label;  // unique in the suite: the name, and /KEY=VALUE for what stands in a grid
  std::string place;  // in the suite file: /problems/3
  CatalogueEntry entry;
  std::optional<SyntheticTruth> truth;  // then the entry has no files
  std::vector<NameSpec> own_terms;      // of the problem file; empty: those usual for its kind
};

/// Terms instead of the problem's own ones.
struct BenchTerms {
  std::string label;            // as written
  std::vector<NameSpec> terms;  // `distance` is the term of that kind; empty: the problem's own
};

/// Cells that are left out: all lists match (an empty one matches everything). `*` in a pattern
/// stands for any text.
struct BenchExclusion {
  std::string place;
  std::vector<std::string> problems;
  std::vector<std::string> terms;
  std::vector<std::string> solvers;
};

/// What one cell's process may use.
struct BenchLimits {
  double cpu_seconds = 0.0;   // 0: twice the wall time, per thread
  double wall_seconds = 0.0;  // 0: three times the seconds of the rule, and 30 for the rest
  int memory_mb = 4096;
};

struct BenchSeeds {
  std::vector<int> data = {1};    // of the noise
  std::vector<int> start;         // of disturbed starts; empty: the problem's own start
  std::vector<int> solver = {1};  // of what is random in a solver
};

/// For BenchSuite::keep_iterates: as many as a cell can hold (MostIterates).
constexpr int kAllIterates = -1;

/// A scripted benchmark: problems x terms x solvers x seeds x repetitions (docs/formats.md).
struct BenchSuite {
  std::string path;
  std::string name;
  std::string summary;
  std::vector<BenchProblem> problems;
  std::vector<BenchTerms> terms;  // at least one
  std::vector<NameSpec> solvers;
  std::vector<BenchExclusion> exclusions;
  std::vector<double> gap_targets = {1e-1, 1e-3, 1e-6};
  RunSpec run;  // mode, tolerances, budgets, threads
  BenchLimits limits;
  BenchSeeds seeds;
  int repetitions = 3;
  bool shuffled = true;  // cells in random order
  int order_seed = 1;
  int warm_up = 1;                   // runs in a cell's process before the one that counts
  int keep_iterates = kAllIterates;  // at most so many of each cell of repetition 1, or 0
};

/// Reads and checks all of a suite, its problems and data included: each problem is made once with
/// each of its terms. False with one line in `error`: `FILE: /JSON/path: found ...; allowed: ...`.
bool ReadBenchSuite(const std::string& path, BenchSuite* suite, std::string* error);

/// Problems of one entry of "problems", its grid spread (bench_suite_problems.cc). The entry is a
/// name or an object.
class StrictObject;
bool ReadBenchProblems(const StrictObject& entry, const std::string& suite_path,
                       const std::string& place, std::vector<BenchProblem>* problems,
                       std::string* error);

/// The solvers of "solvers", with their option grids spread (bench_suite_solvers.cc).
bool ReadBenchSolvers(const StrictObject& file, std::vector<NameSpec>* solvers);

/// The choices of "terms" (bench_suite_terms.cc).
bool ReadBenchTerms(const StrictObject& file, BenchSuite* suite);
/// Whether each choice is another problem than those before it, on one of the problems at least;
/// where it is not, its cells do not run (BenchMatrix).
bool CheckRepeatedTerms(const StrictObject& file, const BenchSuite& suite);

/// `text` with `*` for any text, possibly none.
bool MatchesPattern(const std::string& pattern, const std::string& text);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_BENCH_SUITE_H_
