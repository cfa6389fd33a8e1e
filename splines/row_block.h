#ifndef BATTEN_SPLINES_ROW_BLOCK_H_
#define BATTEN_SPLINES_ROW_BLOCK_H_

#include "splines/points.h"

namespace batten {

/// Rows of a linear least-squares problem in the control points, all in one span's columns and
/// alike for all coordinates: residual of row i, coordinate c =
///   sum_j coefficients[j * stride + i] * P(first_column + j, c) - right_hand_sides[c * stride +
///   i],
/// j = 0..width-1, columns taken modulo num_columns where the matrix is cyclic (so that with
/// num_columns < width one column may stand several times in a row: its coefficients add).
/// Both arrays are aligned to 32 bytes, stride is a multiple of kRowPack, and the rows from
/// num_rows to stride are zero: loops run over whole packs.
inline constexpr int kRowPack = 4;
inline constexpr int kMaxRowsPerBlock = 128;

struct RowBlock {
  int first_column = 0;
  int num_rows = 0;  // 1..kMaxRowsPerBlock
  int stride = 0;
  const double* coefficients = nullptr;      // width x stride
  const double* right_hand_sides = nullptr;  // dimension x stride
};

struct RowShape {
  int num_rows = 0;
  int num_columns = 0;  // n
  int width = 0;        // columns a row touches: p + 1 for an interpolation term
  int dimension = 0;    // d: right-hand sides
  bool cyclic = false;
  /// Rows may differ in size by many orders of magnitude: they are those of several terms, whose
  /// weights say how they compare.
  bool graded = false;
};

class RowConsumer {
 public:
  virtual ~RowConsumer() = default;
  virtual void Consume(const RowBlock& block) = 0;
};

/// Something that can hand out all its rows, block by block, with first_column never decreasing
/// (cyclic too: 0..num_columns-1). A second call hands out the same rows.
class RowSource {
 public:
  virtual ~RowSource() = default;
  virtual RowShape shape() const = 0;
  virtual void Stream(RowConsumer* consumer) const = 0;

  /// Parts that several threads can ask for at once, always the same: one, or an even number.
  /// One after the other they are Stream(). Two even ones touch no column in common, nor do two
  /// odd ones, so that each half can be summed without locks.
  virtual int num_parts() const { return 1; }
  virtual void StreamPart(int /*part*/, RowConsumer* consumer) const { Stream(consumer); }
};

}  // namespace batten

#endif  // BATTEN_SPLINES_ROW_BLOCK_H_
