#ifndef BATTEN_EXPERIMENTS_PUBLISHED_CURVES_H_
#define BATTEN_EXPERIMENTS_PUBLISHED_CURVES_H_

#include <Eigen/Core>
#include <memory>

#include "problems/fit_problem.h"

namespace batten {

/// A fit whose iteration counts are published, and the start they are counted from.
struct PublishedCurve {
  std::shared_ptr<const Problem> problem;
  Eigen::VectorXd start;  ///< Variables: every (m / (n - 1))-th data point.
};

/// The two curves of github.com/Lily11898/SaLSPIA-Reproducibility,
/// experiments/run_table3_curve_comparison.m, examples 1 and 2: 15,001 points in the plane with
/// 3,001 control points, and 10,001 points in space with 2,001. Open cubics, chord length, averaged
/// knots. `number` is 0 or 1.
PublishedCurve MakePublishedCurve(int number);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_PUBLISHED_CURVES_H_
