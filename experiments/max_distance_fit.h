#ifndef BATTEN_EXPERIMENTS_MAX_DISTANCE_FIT_H_
#define BATTEN_EXPERIMENTS_MAX_DISTANCE_FIT_H_

#include <memory>
#include <string>

#include "experiments/max_distance_search.h"
#include "experiments/run.h"
#include "problems/fit_problem.h"

namespace batten {

/// What the search found, as a fit with given knots, the parameters fixed at the certified feet.
struct MaxDistanceFit {
  std::unique_ptr<Problem> problem;  ///< Starts at the curve.
  RunResult run;                     ///< Ends there; solver "max_distance".
  double largest_distance = 0.0;     ///< From a data point to its certified foot, user's units.
};

/// Least bound for coordinates up to `largest`: below it control points round too coarsely.
double LeastMaxDistance(double largest);

/// Searches for few control points no farther than `bound` (> 0, user's units) from any data point
/// of `data`, with degree and closed of `spec`, whose rule for parameters says where the search
/// starts; all its other fields are not looked at. Points of weight 0 do not count, other weights
/// play no part. Interrupted or impossible: false with one sentence in `error`.
bool FitWithinDistance(DataSet data, const FitSpec& spec, double bound, const SearchWatch& watch,
                       MaxDistanceFit* fit, std::string* error);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_MAX_DISTANCE_FIT_H_
