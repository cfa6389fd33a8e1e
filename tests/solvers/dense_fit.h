#ifndef BATTEN_TESTS_SOLVERS_DENSE_FIT_H_
#define BATTEN_TESTS_SOLVERS_DENSE_FIT_H_

#include <Eigen/Core>

#include "problems/fit_problem.h"

namespace batten {

/// A fit with the interpolation term as a dense least-squares problem ||A P - Q||^2 in the units
/// inside, from the recursive definition of the basis, and its solution nearest to the start.
struct DenseFit {
  explicit DenseFit(const Problem& problem);

  /// Of control point j in C(t).
  static double Coefficient(const BsplineBasis& basis, double t, int j);
  Points PointsOf(const Eigen::VectorXd& x) const {
    return Eigen::Map<const Points>(x.data(), a.cols(), q.cols());
  }
  Eigen::VectorXd solution_x() const {
    return Eigen::Map<const Eigen::VectorXd>(solution.data(), solution.size());
  }
  /// E(x) - E*.
  double Gap(const Eigen::VectorXd& x) const;
  /// Minimiser nearest to `start`, each control point's distance weighted by the root of `weights`.
  Points NearestMinimiser(const Points& start, const Eigen::VectorXd& weights) const;
  double condition() const { return largest / smallest; }  ///< Of A, on its row space.
  /// How far x can be from the solution in what the rows see, when |g| is as given.
  double DistanceFor(double gradient_norm) const {
    return 0.5 * gradient_norm / (smallest * smallest);
  }

  Eigen::MatrixXd a;
  Eigen::MatrixXd q;
  Points solution;
  int rank = 0;
  double smallest = 0.0;  // singular value that is not zero
  double largest = 0.0;
};

}  // namespace batten

#endif  // BATTEN_TESTS_SOLVERS_DENSE_FIT_H_
