#ifndef BATTEN_EXPERIMENTS_REPORT_BENCH_H_
#define BATTEN_EXPERIMENTS_REPORT_BENCH_H_

#include <map>
#include <string>
#include <vector>

namespace batten {

/// What the tables of a folder of `bench` know of its runs beside their rows, by the keys of these.
struct BenchFacts {
  std::map<std::string, double> unit_seconds;  ///< Of one evaluation of E, where it was measured.
  std::map<std::string, double> truth;         ///< E of the truth, where the data's noise is known.
  std::map<std::string, double> num_variables;
  std::map<std::string, double> start;  ///< E of the instance's start, from which gaps count.
  std::vector<double> targets;  ///< Gaps of the suite, then 0 for the noise floor if it has one.
  // Where there is no direct answer, so that E may have several minima:
  std::map<std::string, double> best;  ///< E of the instance's best basin.
  std::map<std::string, double> own;   ///< E of the basin that the run ends in, where it is known.
  std::map<std::string, int> basin;    ///< That basin; 1: the best.
};

/// As the tables of `bench` have them; empty for other folders.
BenchFacts ReadBenchFacts(const std::string& folder);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_REPORT_BENCH_H_
