#ifndef BATTEN_COST_FUNCTIONS_ORDERED_PARAMETERS_H_
#define BATTEN_COST_FUNCTIONS_ORDERED_PARAMETERS_H_

#include <Eigen/Core>
#include <vector>

namespace batten {

/// The nearest t to s with t_0 <= t_1 <= ... <= t_(m-1): the least-squares isotonic regression by
/// pooling adjacent violators (Barlow et al., Statistical Inference under Order Restrictions,
/// 1972). On closed curves also t_(m-1) <= t_0 + period: the last points and the first then are
/// neighbours, which are pooled as others are.
struct OrderedParameters {
  /// period: 0 on open curves.
  OrderedParameters(const Eigen::Ref<const Eigen::VectorXd>& s, double period);

  /// dt = (dt/ds) ds: means over the blocks of equal t, those of the last points and the first
  /// block in one where they are a period apart. dt/ds is symmetric.
  Eigen::VectorXd Apply(const Eigen::Ref<const Eigen::VectorXd>& ds) const;

  /// With g = dE/dt at t, less the steepest descent of E(t(s)) from s = t: points of one block go
  /// together unless E falls as they part. It is 0 at a minimum over ordered t and nowhere else.
  Eigen::VectorXd SteepestAscent(const Eigen::Ref<const Eigen::VectorXd>& g) const;
  /// Block of each point; 0 of those a period after the first block.
  std::vector<int> BlockOf() const;

  Eigen::VectorXd t;
  std::vector<int> block_begins;  ///< Of points with one t; then m.
  int num_cut = 0;                ///< The last points, those a period after the first block.
};

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_ORDERED_PARAMETERS_H_
