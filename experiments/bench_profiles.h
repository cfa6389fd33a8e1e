#ifndef BATTEN_EXPERIMENTS_BENCH_PROFILES_H_
#define BATTEN_EXPERIMENTS_BENCH_PROFILES_H_

#include <cstdint>
#include <vector>

#include "experiments/ratio_statistics.h"

namespace batten {

// Statistics of benchmarks on plain tables. A cost is positive; infinity: the solver failed; NaN:
// it was not run, and the problem counts for the others alone.

/// costs[problem][solver].
using CostTable = std::vector<std::vector<double>>;

/// A step function that goes up: y[k] from x[k] on, y = 0 before x[0].
struct Steps {
  std::vector<double> x;
  std::vector<double> y;
  double At(double place) const;
};

/// For each solver the share of all problems that it solves within a factor x of the best solver's
/// cost: Dolan & More, Mathematical Programming 91 (2002) 201-213. A problem nobody solves counts
/// in the share.
std::vector<Steps> PerformanceProfiles(const CostTable& costs);
/// The same of two solvers alone. A profile of more than two is no order: who is best with one
/// rival removed may be another (Gould & Scott, ACM TOMS 43 (2016) 15).
std::vector<Steps> PairProfiles(const CostTable& costs, std::size_t first, std::size_t second);

/// For each solver the share of problems it solves at a cost of x units of the problem's own:
/// More & Wild, SIAM Journal on Optimization 20 (2009) 172-191, where costs are evaluations of E
/// and the unit is n + 1 of them.
std::vector<Steps> DataProfiles(const CostTable& costs, const std::vector<double>& units);

/// Share of all entries that are at most x: with one entry per problem and target the runtime
/// distribution of Hansen, Auger, Ros, Mersmann, Tusar & Brockhoff, Optimization Methods and
/// Software 36 (2021) 114-144, without restarts.
Steps Distribution(std::vector<double> costs);

/// exp(mean(log(v + shift))) - shift; NaN for no values.
double ShiftedGeometricMean(const std::vector<double>& values, double shift);

/// Failures charged: infinite costs become `factor` times the largest finite cost of their problem.
/// Problems that nobody solves are left out. NaN stays.
CostTable ChargeFailures(const CostTable& costs, double factor);

/// The median and its 95 % interval by the bootstrap's percentiles (Efron & Tibshirani, An
/// Introduction to the Bootstrap, 1993, ch. 13): 2,000 resamples, drawn from `seed`. NaN for no
/// values; the value itself, three times, for one.
MedianWithInterval BootstrapMedian(const std::vector<double>& values, std::uint64_t seed);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_BENCH_PROFILES_H_
