#ifndef BATTEN_SPLINES_INTERLEAVED_ROWS_H_
#define BATTEN_SPLINES_INTERLEAVED_ROWS_H_

#include "splines/row_block.h"

namespace batten {

/// The rows of all coordinates as those of one: column j of coordinate c stands at j * d + c, so
/// that unknowns are in the order of control points stored row-major. m d rows, d times as wide.
/// `rows` must outlive this.
class InterleavedRows final : public RowSource {
 public:
  explicit InterleavedRows(const RowSource* rows) : rows_(rows) {}
  RowShape shape() const override;
  void Stream(RowConsumer* consumer) const override;

 private:
  const RowSource* rows_;
};

}  // namespace batten

#endif  // BATTEN_SPLINES_INTERLEAVED_ROWS_H_
