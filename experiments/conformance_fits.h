#ifndef BATTEN_EXPERIMENTS_CONFORMANCE_FITS_H_
#define BATTEN_EXPERIMENTS_CONFORMANCE_FITS_H_

#include <memory>
#include <string>
#include <vector>

#include "problems/fit_problem.h"

namespace batten {

/// The fits that plugins are tried on: small, without symmetry, the same at each call.
struct ExampleProblem {
  std::string name;
  std::unique_ptr<Problem> problem;
};

/// Closed and open, 2-D and 3-D, weighted, through all points, with free and with projected
/// parameters.
std::vector<ExampleProblem> ExampleProblems();

/// The same kinds with `term` (a name with options) alone, or beside the distance from the data
/// where `with_distance`; those that cannot be formed are left out.
std::vector<ExampleProblem> ExampleProblemsOf(const std::string& term, bool with_distance);

/// One whose control points are so many that their array ends 8 bytes before a page does, for
/// GuardedVector; of the kinds of ExampleProblems(). `term` empty: the distance.
std::vector<ExampleProblem> PageSizedProblems(const std::string& term);

/// All variables near the start, moved by at most `by` each, without any pattern; `seed` tells
/// different ones apart.
Eigen::VectorXd NearStart(const Problem& problem, double by, unsigned seed);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_CONFORMANCE_FITS_H_
