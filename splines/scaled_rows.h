#ifndef BATTEN_SPLINES_SCALED_ROWS_H_
#define BATTEN_SPLINES_SCALED_ROWS_H_

#include <vector>

#include "splines/row_block.h"

namespace batten {

/// The rows of a source with their right-hand sides, row i (in the order of Stream) times
/// factors[i]: a weighted least-squares problem, the weights being the factors' squares.
class ScaledRows : public RowSource {
 public:
  /// `source` must outlive this; one factor per row.
  ScaledRows(const RowSource* source, std::vector<double> factors);
  RowShape shape() const override { return source_->shape(); }
  void Stream(RowConsumer* consumer) const override;

 private:
  const RowSource* source_;
  std::vector<double> factors_;
};

/// Euclidean norms of the residuals A P - Q of a source's rows over all coordinates, at control
/// points n x d row-major.
std::vector<double> ResidualNorms(const RowSource& source, const double* control_points);

}  // namespace batten

#endif  // BATTEN_SPLINES_SCALED_ROWS_H_
