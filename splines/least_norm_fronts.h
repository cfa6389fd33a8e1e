#ifndef BATTEN_SPLINES_LEAST_NORM_FRONTS_H_
#define BATTEN_SPLINES_LEAST_NORM_FRONTS_H_

#include <Eigen/Core>
#include <vector>

#include "splines/points.h"

namespace batten {

/// Two least-squares problems in the same few unknowns, of which the second counts only where the
/// first leaves a choice: rows of `first` and `second` are coefficients, one for each of `columns`,
/// then right-hand sides.
struct Front {
  std::vector<int> columns;  // unknowns, by their index in the whole problem
  Eigen::MatrixXd first;
  Eigen::MatrixXd second;
};

/// Eliminates the unknowns of a lexicographic least-squares problem front by front (as a
/// multifrontal QR does, Duff & Reid, ACM TOMS 9, 1983), each with column exchanges: which unknowns
/// are determined is decided among all that a front eliminates together, since a decision column by
/// column from the left amounts to shooting and loses all digits. Internal to splines/.
class LeastNormFronts {
 public:
  /// Pivots up to `threshold` are zero. `dimension`: of the right-hand sides.
  LeastNormFronts(double threshold, int dimension) : threshold_(threshold), dimension_(dimension) {}

  /// The fronts added up, all their unknowns but those in `kept` eliminated, which no other front
  /// may have: a front in the others, and in those whose elimination has to wait for a better pivot
  /// among the kept ones. second must determine what first leaves free.
  Front Eliminate(const std::vector<const Front*>& parts, const std::vector<int>& kept);
  /// All unknowns, once all are eliminated: n x dimension.
  Points Solve(int num_columns) const;
  /// Unknowns that first determines.
  int rank() const { return rank_; }

 private:
  class Split;
  struct Merged;
  struct Record {  // interior unknowns = solution * (boundary unknowns, 1)
    std::vector<int> interior;
    std::vector<int> boundary;
    Eigen::MatrixXd solution;
  };
  /// The choice that `second` (interior, boundary, right-hand sides) makes of the free part v2 f of
  /// the interior is added to `solution`; what is left of second, in the boundary, is returned.
  Eigen::MatrixXd SettleFree(const Eigen::MatrixXd& second, const Eigen::MatrixXd& v2,
                             Eigen::MatrixXd* solution) const;
  double threshold_;
  int dimension_;
  int rank_ = 0;
  std::vector<Record> records_;
};

}  // namespace batten

#endif  // BATTEN_SPLINES_LEAST_NORM_FRONTS_H_
