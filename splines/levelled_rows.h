#ifndef BATTEN_SPLINES_LEVELLED_ROWS_H_
#define BATTEN_SPLINES_LEVELLED_ROWS_H_

#include "splines/row_block.h"

namespace batten {

/// The rows of a source, each with its right-hand sides divided by the norm of its coefficients;
/// rows of zeros stay. Another least-squares problem of the same rank.
class LevelledRows : public RowSource {
 public:
  /// `source` must outlive this.
  explicit LevelledRows(const RowSource* source) : source_(source) {}
  RowShape shape() const override;
  void Stream(RowConsumer* consumer) const override;

 private:
  const RowSource* source_;
};

}  // namespace batten

#endif  // BATTEN_SPLINES_LEVELLED_ROWS_H_
