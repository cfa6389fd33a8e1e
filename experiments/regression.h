#ifndef BATTEN_EXPERIMENTS_REGRESSION_H_
#define BATTEN_EXPERIMENTS_REGRESSION_H_

#include <string>
#include <vector>

#include "experiments/bench_results.h"
#include "experiments/csv_table.h"

namespace batten {

struct RegressionRule {
  double slowdown = 0.05;         // a median ratio above 1 by more than this counts
  double significance = 0.01;     // of one-sided signed-rank tests, after Holm's correction
  double energy_rounding = 1e-6;  // ends that differ by less than this part of E are alike; those
                                  // that time set are tested together, as costs are
};

struct RegressionReport {
  /// Why the second result is worse: one sentence each; empty: it is not.
  std::vector<std::string> regressions;
  /// What else differs: builds, machines, cells that only one has, runs that got better.
  std::vector<std::string> differences;
  /// A row per solver and cost, and one for all solvers: cells, median ratio (second over first),
  /// T+, p, p after Holm's correction.
  CsvTable tests;
  int matched = 0;  // runs that both have
};

/// `before` and `now` are results of suites that share instances and solvers, by their names.
RegressionReport FindRegressions(const BenchData& before_data, const BenchResults& before,
                                 const BenchData& now_data, const BenchResults& now,
                                 const RegressionRule& rule);

/// Holm, Scandinavian Journal of Statistics 6 (1979) 65-70: p-values of tests that are made
/// together, in the order given.
std::vector<double> HolmCorrected(const std::vector<double>& p_values);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_REGRESSION_H_
