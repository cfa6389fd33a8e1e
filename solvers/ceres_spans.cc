#include "solvers/ceres_spans.h"

#include <Eigen/QR>
#include <algorithm>
#include <utility>

namespace batten {
namespace {

/// Rows that are gathered before they are reduced to a triangle: a span may hold a million.
constexpr int kMaxGatheredRows = 4096;

/// R P - C, for a triangle R with one column per point and C with one per coordinate.
class SpanCost final : public ceres::CostFunction {
 public:
  /// triangle = (R C).
  SpanCost(Points triangle, int dimension) : triangle_(std::move(triangle)), dimension_(dimension) {
    set_num_residuals(static_cast<int>(triangle_.rows()) * dimension);
    mutable_parameter_block_sizes()->assign(static_cast<std::size_t>(num_points()), dimension);
  }

  bool Evaluate(double const* const* points, double* residuals, double** jacobians) const override {
    for (int i = 0; i < triangle_.rows(); ++i) {
      for (int c = 0; c < dimension_; ++c) {
        double sum = -triangle_(i, num_points() + c);
        for (int j = i; j < num_points(); ++j) sum += triangle_(i, j) * points[j][c];
        residuals[i * dimension_ + c] = sum;
      }
    }
    if (jacobians == nullptr) return true;
    for (int j = 0; j < num_points(); ++j) {
      if (jacobians[j] == nullptr) continue;
      std::fill_n(jacobians[j], num_residuals() * dimension_, 0.0);
      const int last = std::min(j, static_cast<int>(triangle_.rows()) - 1);
      for (int i = 0; i <= last; ++i) {
        for (int c = 0; c < dimension_; ++c) {
          jacobians[j][(i * dimension_ + c) * dimension_ + c] = triangle_(i, j);
        }
      }
    }
    return true;
  }

 private:
  int num_points() const { return static_cast<int>(triangle_.cols()) - dimension_; }

  Points triangle_;
  int dimension_;
};

/// Gathers the rows (A Q) of one span after the other and reduces each to its triangle.
class SpanCollector final : public RowConsumer {
 public:
  explicit SpanCollector(const RowShape& shape)
      : shape_(shape), num_points_(std::min(shape.width, shape.num_columns)) {}

  void Consume(const RowBlock& block) override {
    if (block.first_column != first_column_) {
      Finish();
      first_column_ = block.first_column;
    }
    if (num_rows_ + block.num_rows > kMaxGatheredRows) Reduce();
    const int needed = num_rows_ + block.num_rows;
    if (rows_.rows() < needed) rows_.conservativeResize(2 * needed, num_points_ + shape_.dimension);
    rows_.middleRows(num_rows_, block.num_rows).setZero();
    for (int i = 0; i < block.num_rows; ++i, ++num_rows_) {
      // Cyclic rows wider than the matrix meet the same point again.
      for (int j = 0; j < shape_.width; ++j) {
        rows_(num_rows_, j % num_points_) += block.coefficients[j * block.stride + i];
      }
      for (int c = 0; c < shape_.dimension; ++c) {
        rows_(num_rows_, num_points_ + c) = block.right_hand_sides[c * block.stride + i];
      }
    }
  }

  std::vector<SpanBlock> Take() {
    Finish();
    return std::move(blocks_);
  }

 private:
  /// Rows become the upper triangle of their QR factorization, C' included.
  void Reduce() {
    if (num_rows_ <= rows_.cols()) return;
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(rows_.topRows(num_rows_));
    num_rows_ = static_cast<int>(rows_.cols());
    rows_.topRows(num_rows_) = qr.matrixQR().topRows(num_rows_).triangularView<Eigen::Upper>();
  }

  void Finish() {
    if (num_rows_ == 0) return;
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(rows_.topRows(num_rows_));
    const int num_kept = std::min(num_rows_, num_points_);
    Points triangle = qr.matrixQR().topRows(num_kept).triangularView<Eigen::Upper>();
    SpanBlock block;
    for (int j = 0; j < num_points_; ++j) {
      block.begins.push_back((first_column_ + j) % shape_.num_columns * shape_.dimension);
    }
    block.cost = std::make_unique<SpanCost>(std::move(triangle), shape_.dimension);
    blocks_.push_back(std::move(block));
    num_rows_ = 0;
  }

  RowShape shape_;
  int num_points_;
  int first_column_ = -1;
  int num_rows_ = 0;  // gathered, of rows_
  Points rows_;
  std::vector<SpanBlock> blocks_;
};

}  // namespace

std::vector<SpanBlock> MakeSpanBlocks(const CurveView& view) {
  SpanCollector collector(view.row_source().shape());
  view.row_source().Stream(&collector);
  return collector.Take();
}

}  // namespace batten
