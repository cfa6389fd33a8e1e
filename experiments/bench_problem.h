#ifndef BATTEN_EXPERIMENTS_BENCH_PROBLEM_H_
#define BATTEN_EXPERIMENTS_BENCH_PROBLEM_H_

#include <memory>
#include <string>
#include <vector>

#include "experiments/bench_suite.h"

namespace batten {

/// The seeds of one cell; those that do not apply are 0.
struct CellSeeds {
  int data = 0;
  int start = 0;
  int solver = 1;
};

/// The problem of a cell; null with one sentence in `error`. The same seeds give the same problem,
/// bit by bit.
std::unique_ptr<Problem> MakeBenchProblem(const BenchProblem& problem, const BenchTerms& terms,
                                          const CellSeeds& seeds, std::string* error);

/// Terms as they are used: `distance` replaced, the problem's own ones where none are named.
std::vector<NameSpec> TermsOf(const BenchProblem& problem, const BenchTerms& terms);

/// Those terms with all their options, in alphabetical order: equal ones make one problem.
std::string TermsIdentity(const BenchProblem& problem, const BenchTerms& terms);

/// Data of a synthetic problem, with the column t: C(t_i) + noise, at uniform t_i.
DataSet SyntheticData(const SyntheticTruth& truth, const FitSpec& spec, int seed);
/// The control points of the truth, n x 2: star: around the unit circle, its radius waving; wave:
/// along [0, 1], going up and down.
Points TruthControlPoints(const SyntheticTruth& truth, const FitSpec& spec);

/// Whether an axis of seeds changes this problem.
bool UsesDataSeed(const BenchProblem& problem);
bool UsesStartSeed(const BenchProblem& problem);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_BENCH_PROBLEM_H_
