#ifndef BATTEN_PROBLEMS_TEST_FUNCTIONS_H_
#define BATTEN_PROBLEMS_TEST_FUNCTIONS_H_

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "problems/problem.h"

namespace batten {

/// A sum of squares (no factor 1/2) on which minimisers have been compared since 1981, with its
/// standard start and its answers.
struct TestFunction {
  struct Minimum {
    Eigen::VectorXd point;
    double energy = 0.0;
  };
  std::string name;
  Eigen::VectorXd start;
  /// Local minima, the least first. More than one: a descent method may end in any of them.
  std::vector<Minimum> minima;
  std::string citation;
  double min_energy() const { return minima.front().energy; }
};

/// Rosenbrock's function and nine others of More, Garbow and Hillstrom, ACM TOMS 7 (1981) 17-41,
/// numbered there: freudenstein_roth, powell_badly_scaled, brown_badly_scaled, beale,
/// helical_valley, powell_singular (the Hessian is singular at the minimiser), wood, brown_dennis
/// (residuals do not vanish), trigonometric (n = 10).
std::vector<TestFunction> TestFunctions();

/// The function of that name as a problem: variables "x", one term of automatically differentiated
/// Ceres cost functions. Null for an unknown name.
std::unique_ptr<Problem> MakeTestProblem(const std::string& name);

}  // namespace batten

#endif  // BATTEN_PROBLEMS_TEST_FUNCTIONS_H_
