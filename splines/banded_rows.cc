#include "splines/banded_rows.h"

#include <algorithm>

#include "splines/row_pack.h"

namespace batten {
namespace {

constexpr int kLineSize = kCacheLine / sizeof(double);

/// Open matrices have no column n: a row that was padded on the right is moved left instead.
int PaddedFirstColumn(const RowShape& shape, int first_column) {
  return shape.cyclic ? first_column : std::min(first_column, shape.num_columns - shape.width);
}

/// Rows per first column, of one source after the other.
class RowCounter : public RowConsumer {
 public:
  explicit RowCounter(const RowShape& shape) : shape_(shape), counts_(shape.num_columns + 1, 0) {}
  void Consume(const RowBlock& block) override {
    counts_[PaddedFirstColumn(shape_, block.first_column)] += block.num_rows;
  }
  const std::vector<int>& counts() const { return counts_; }

 private:
  RowShape shape_;
  std::vector<int> counts_;
};

RowShape CommonShape(const std::vector<const RowSource*>& sources) {
  RowShape common = sources.empty() ? RowShape() : sources.front()->shape();
  common.num_rows = 0;
  common.graded = sources.size() > 1;
  for (const RowSource* source : sources) {
    common.width = std::max(common.width, source->shape().width);
    common.graded = common.graded || source->shape().graded;
  }
  // A source without rows may be wider than its matrix.
  if (!common.cyclic) common.width = std::min(common.width, common.num_columns);
  return common;
}

}  // namespace

/// Second pass: copies rows to where the counts of the first one put them.
class BandedRowsBuilder : public RowConsumer {
 public:
  BandedRowsBuilder(BandedRows* rows, const std::vector<int>& counts) : rows_(rows) {
    std::size_t size = 0;
    const RowShape& shape = rows_->shape_;
    first_block_.reserve(counts.size());
    for (std::size_t column = 0; column < counts.size(); ++column) {
      first_block_.push_back(rows_->blocks_.size());
      for (int left = counts[column]; left > 0; left -= kMaxRowsPerBlock) {
        const int num_rows = std::min(left, kMaxRowsPerBlock);
        const int stride = PaddedRows(num_rows);
        rows_->blocks_.push_back(
            {static_cast<int>(column), num_rows, stride, size, rows_->shape_.num_rows});
        size += static_cast<std::size_t>(stride) * (shape.width + shape.dimension);
        rows_->shape_.num_rows += num_rows;
      }
    }
    rows_->data_.resize(size);
    filled_.assign(counts.size(), 0);
  }

  void set_source_width(int width) { source_width_ = width; }

  void Consume(const RowBlock& block) override {
    const int column = PaddedFirstColumn(rows_->shape_, block.first_column);
    const int shift = block.first_column - column;
    for (int copied = 0; copied < block.num_rows;) {
      const int position = filled_[column];
      const auto& entry = rows_->blocks_[first_block_[column] + position / kMaxRowsPerBlock];
      const int row = position % kMaxRowsPerBlock;
      const int count = std::min(block.num_rows - copied, entry.num_rows - row);
      if (row == 0) Clear(entry);
      CopyRows(block, copied, count, shift, entry, row);
      copied += count;
      filled_[column] += count;
    }
  }

 private:
  void Clear(const BandedRows::Entry& entry) {
    const int columns = rows_->shape_.width + rows_->shape_.dimension;
    std::fill_n(rows_->data_.data() + entry.begin, entry.stride * columns, 0.0);
  }

  void CopyRows(const RowBlock& block, int from, int count, int shift,
                const BandedRows::Entry& entry, int to) {
    const RowShape& shape = rows_->shape_;
    double* target = rows_->data_.data() + entry.begin + to;
    const int width = std::min(source_width_, shape.width - shift);
    for (int j = 0; j < width; ++j) {
      std::copy_n(block.coefficients + j * block.stride + from, count,
                  target + (j + shift) * entry.stride);
    }
    target += shape.width * entry.stride;
    for (int c = 0; c < shape.dimension; ++c) {
      std::copy_n(block.right_hand_sides + c * block.stride + from, count,
                  target + c * entry.stride);
    }
  }

  BandedRows* rows_;
  int source_width_ = 0;
  std::vector<std::size_t> first_block_;  // of each first column
  std::vector<int> filled_;               // rows copied so far, of each first column
};

BandedRows::BandedRows(const std::vector<const RowSource*>& sources)
    : shape_(CommonShape(sources)) {
  RowCounter counter(shape_);
  for (const RowSource* source : sources) source->Stream(&counter);
  BandedRowsBuilder builder(this, counter.counts());
  for (const RowSource* source : sources) {
    builder.set_source_width(source->shape().width);
    source->Stream(&builder);
  }
}

RowBlock BandedRows::block(std::size_t index) const {
  const Entry& entry = blocks_[index];
  RowBlock block;
  block.first_column = entry.first_column;
  block.num_rows = entry.num_rows;
  block.stride = entry.stride;
  block.coefficients = data_.data() + entry.begin;
  block.right_hand_sides = block.coefficients + shape_.width * entry.stride;
  return block;
}

RowBlock BandedRows::BlockAndPrefetch(std::size_t index) const {
  if (index + 1 < blocks_.size()) {
    const Entry& next = blocks_[index + 1];
    const double* const data = data_.data() + next.begin;
    const int size = next.stride * (shape_.width + shape_.dimension);
    for (int k = 0; k < size; k += kLineSize) __builtin_prefetch(data + k);
  }
  return block(index);
}

void BandedRows::Stream(RowConsumer* consumer) const {
  for (std::size_t index = 0; index < blocks_.size(); ++index) {
    consumer->Consume(BlockAndPrefetch(index));
  }
}

}  // namespace batten
