#ifndef BATTEN_COST_FUNCTIONS_ORDERED_PARAMETERS_H_
#define BATTEN_COST_FUNCTIONS_ORDERED_PARAMETERS_H_

#include <Eigen/Core>
#include <vector>

#include "splines/bspline_basis.h"

namespace batten {

/// The nearest t to s with t_0 <= t_1 <= ... <= t_(m-1): the least-squares isotonic regression by
/// pooling adjacent violators (Barlow et al., Statistical Inference under Order Restrictions,
/// 1972). On closed curves also t_(m-1) <= t_0 + period: the last points and the first then are
/// neighbours, which are pooled as others are. On open curves also low <= t_0 and t_(m-1) <= high:
/// what is past an end is one block at it, as E does not change there.
struct OrderedParameters {
  OrderedParameters(const Eigen::Ref<const Eigen::VectorXd>& s, double period);
  OrderedParameters(const Eigen::Ref<const Eigen::VectorXd>& s, double low, double high);

  /// dt = (dt/ds) ds: means over the blocks of equal t, those of the last points and the first
  /// block in one where they are a period apart, 0 at the ends. dt/ds is symmetric.
  Eigen::VectorXd Apply(const Eigen::Ref<const Eigen::VectorXd>& ds) const;

  /// With g = dE/dt at t (at an end of an open curve that from inside), less the steepest descent
  /// of E(t(s)) from s = t: points of one block go together unless E falls as they part, those at
  /// an end go inwards only. It is 0 at a minimum over ordered t and nowhere else.
  Eigen::VectorXd SteepestAscent(const Eigen::Ref<const Eigen::VectorXd>& g) const;
  /// The direction d, but for points of one block that have one and the same entry in `ascent`,
  /// what SteepestAscent gave: these go with their mean, and where it is 0 at an end they stay.
  Eigen::VectorXd KeptTogether(const Eigen::Ref<const Eigen::VectorXd>& ascent,
                               const Eigen::Ref<const Eigen::VectorXd>& d) const;
  /// Block of each point; 0 of those a period after the first block.
  std::vector<int> BlockOf() const;

  Eigen::VectorXd t;
  std::vector<int> block_begins;  ///< Of points with one t; then m.
  int num_cut = 0;                ///< The last points, those a period after the first block.
  bool first_at_end = false;      ///< Whether the first block is at the begin of an open curve.
  bool last_at_end = false;       ///< Whether the last block is at its end.
};

/// Those of parameters in the domain of `basis`: across the seam, or between the ends.
inline OrderedParameters OrderOnCurve(const BsplineBasis& basis,
                                      const Eigen::Ref<const Eigen::VectorXd>& s) {
  if (basis.periodic()) return OrderedParameters(s, basis.domain_length());
  return OrderedParameters(s, basis.domain_begin(), basis.domain_end());
}

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_ORDERED_PARAMETERS_H_
