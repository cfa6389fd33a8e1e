#include "splines/nearest_solution.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "splines/banded_qr.h"
#include "splines/fold_rows.h"
#include "splines/least_norm_fronts.h"
#include "splines/levelled_rows.h"

namespace batten {
namespace {

using Eigen::MatrixXd;

/// The columns cut into stretches, each a separator of width - 1 columns, which no row reaches
/// across, and an interior. first holds the rows that begin in a stretch, in the displacements from
/// the start; second says that displacements are to be small.
class Stretches : public RowConsumer {
 public:
  Stretches(const RowShape& shape, const Points& start);
  void Consume(const RowBlock& block) override;
  /// Eliminates everything; call once, after the last row.
  void Eliminate(LeastNormFronts* fronts);

 private:
  void FoldPending();
  int num_stretches() const { return static_cast<int>(begins_.size()) - 1; }
  std::vector<int> Range(int begin, int end) const;
  /// Of stretch k; that of the first one too where a cyclic matrix closes, none after an open one.
  std::vector<int> Separator(int k) const;

  RowShape shape_;
  const Points& start_;
  int separator_;
  std::vector<int> begins_;  // first column of each stretch, then n
  std::vector<Front> fronts_;
  std::vector<double> pending_;   // rows of one window, as for FoldAny
  std::vector<double> triangle_;  // width x (width + dimension)
  int pending_column_ = -1;
};

Stretches::Stretches(const RowShape& shape, const Points& start)
    : shape_(shape),
      start_(start),
      separator_(std::min(shape.width - 1, shape.num_columns)),
      pending_(static_cast<std::size_t>(kMaxRowsPerBlock) * (shape.width + shape.dimension)),
      triangle_(static_cast<std::size_t>(shape.width) * (shape.width + shape.dimension), 0.0) {
  // Long enough that pivots have a choice, short enough for dense matrices.
  const int length = separator_ + std::max(16, 2 * separator_);
  const int count = std::max(1, shape.num_columns / length);
  for (int k = 0; k <= count; ++k) {
    begins_.push_back(static_cast<int>(static_cast<long>(shape.num_columns) * k / count));
  }
  for (int k = 0; k < count; ++k) {
    Front front;
    front.columns = Range(begins_[k], begins_[k + 1]);
    const auto size = static_cast<Eigen::Index>(front.columns.size());
    for (const int column : Separator(k + 1)) front.columns.push_back(column);
    const auto width = static_cast<Eigen::Index>(front.columns.size()) + shape.dimension;
    front.first.resize(0, width);
    front.second = MatrixXd::Identity(size, width);
    front.second.rightCols(shape.dimension).setZero();
    fronts_.push_back(std::move(front));
  }
}

std::vector<int> Stretches::Range(int begin, int end) const {
  std::vector<int> columns(static_cast<std::size_t>(end - begin));
  std::iota(columns.begin(), columns.end(), begin);
  return columns;
}

std::vector<int> Stretches::Separator(int k) const {
  if (k == num_stretches()) {
    // One stretch that closes on itself has all columns already.
    return shape_.cyclic && k > 1 ? Separator(0) : std::vector<int>();
  }
  if (k == 0 && !shape_.cyclic) return {};
  return Range(begins_[k], begins_[k] + separator_);
}

void Stretches::Consume(const RowBlock& block) {
  if (block.first_column != pending_column_) {
    FoldPending();
    pending_column_ = block.first_column;
  }
  const int stride = block.stride;
  std::copy_n(block.coefficients, shape_.width * stride, pending_.data());
  double* const right = pending_.data() + shape_.width * stride;
  std::copy_n(block.right_hand_sides, shape_.dimension * stride, right);
  for (int j = 0; j < shape_.width; ++j) {
    const int column = (block.first_column + j) % shape_.num_columns;
    for (int c = 0; c < shape_.dimension; ++c) {
      for (int i = 0; i < stride; ++i) {
        right[c * stride + i] -= block.coefficients[j * stride + i] * start_(column, c);
      }
    }
  }
  const PackedRows rows = {AsPacks(pending_.data()), stride / kPackLanes, stride / kPackLanes};
  FoldAny(shape_.width, shape_.dimension, rows, triangle_.data(), shape_.width + shape_.dimension);
}

void Stretches::FoldPending() {
  if (pending_column_ < 0) return;
  const auto next = std::upper_bound(begins_.begin(), begins_.end() - 1, pending_column_);
  Front& front = fronts_[static_cast<std::size_t>(next - begins_.begin() - 1)];
  const int row_size = shape_.width + shape_.dimension;
  double largest = 0.0;
  for (int i = 0; i < shape_.width; ++i) {
    for (int k = 0; k < shape_.width; ++k) {
      largest = std::max(largest, std::abs(triangle_[static_cast<std::size_t>(i * row_size + k)]));
    }
  }
  for (int i = 0; i < shape_.width; ++i) {
    double* const row = triangle_.data() + i * row_size;
    // Windows with fewer independent rows than columns leave rows of nothing but rounding.
    constexpr double kRounding = 64.0 * std::numeric_limits<double>::epsilon();
    const auto is_noise = [&](double entry) { return std::abs(entry) <= kRounding * largest; };
    if (std::all_of(row, row + shape_.width - i, is_noise)) continue;
    const Eigen::Index last = front.first.rows();
    front.first.conservativeResize(last + 1, front.first.cols());
    front.first.row(last).setZero();
    for (int k = i; k < shape_.width; ++k) {
      const int column = (pending_column_ + k) % shape_.num_columns;
      const auto place = std::find(front.columns.begin(), front.columns.end(), column);
      front.first(last, place - front.columns.begin()) += row[k - i];
    }
    for (int c = 0; c < shape_.dimension; ++c) {
      front.first(last, front.first.cols() - shape_.dimension + c) = row[shape_.width + c];
    }
  }
  std::fill(triangle_.begin(), triangle_.end(), 0.0);
  pending_column_ = -1;
}

void Stretches::Eliminate(LeastNormFronts* fronts) {
  FoldPending();
  // Front i goes from separator bounds[i] to bounds[i + 1].
  std::vector<int> bounds(fronts_.size() + 1);
  std::iota(bounds.begin(), bounds.end(), 0);
  const auto ends = [&](std::size_t first, std::size_t last) {
    std::vector<int> kept = Separator(bounds[first]);
    const std::vector<int> right = Separator(bounds[last]);
    kept.insert(kept.end(), right.begin(), right.end());
    return kept;
  };
  for (std::size_t i = 0; fronts_.size() > 1 && i < fronts_.size(); ++i) {
    fronts_[i] = fronts->Eliminate({&fronts_[i]}, ends(i, i + 1));
  }
  while (fronts_.size() > 2) {
    std::vector<Front> merged;
    std::vector<int> merged_bounds;
    for (std::size_t i = 0; i < fronts_.size(); i += 2) {
      merged_bounds.push_back(bounds[i]);
      merged.push_back(i + 1 < fronts_.size()
                           ? fronts->Eliminate({&fronts_[i], &fronts_[i + 1]}, ends(i, i + 2))
                           : std::move(fronts_[i]));
    }
    merged_bounds.push_back(bounds.back());
    fronts_ = std::move(merged);
    bounds = std::move(merged_bounds);
  }
  std::vector<const Front*> last;
  for (const Front& front : fronts_) last.push_back(&front);
  fronts->Eliminate(last, {});
}

BandedQr Factor(const RowSource& rows) {
  BandedQr qr(rows.shape());
  rows.Stream(&qr);
  qr.Finish();
  return qr;
}

/// The diagonal of R can be far from zero where A is singular: where the null vector decays towards
/// the last columns, no pivot shows it. ||(R'R)^-1 x|| / ||x|| is at most 1 / (smallest singular
/// value)^2 for any x, and for one without structure at least that over the root of n.
bool HidesASmallSingularValue(const BandedQr& qr, int n) {
  std::vector<double> x(static_cast<std::size_t>(n));
  std::mt19937 random(1);
  for (double& entry : x) entry = static_cast<double>(random()) * 0x1p-31 - 1.0;
  const auto map = [&x] { return Eigen::Map<const Eigen::VectorXd>(x.data(), x.size()); };
  const double before = map().norm();
  qr.SolveTransposedTriangle(1, x.data());
  qr.SolveTriangle(1, x.data());
  const double smallest = std::sqrt(before / map().stableNorm());
  return !(smallest > BandedQr::kRankTolerance * qr.LargestDiagonal());
}

bool HasFullRank(const BandedQr& qr, const RowShape& shape) {
  return qr.full_rank() && !HidesASmallSingularValue(qr, shape.num_columns);
}

/// Weights do not change the rank, but they can hide it.
bool HasFullRankLevelled(const RowSource& rows) {
  return HasFullRank(Factor(LevelledRows(&rows)), rows.shape());
}

}  // namespace

NearestSolution SolveNearest(const RowSource& rows, const Points& start) {
  const RowShape shape = rows.shape();
  NearestSolution result;
  result.control_points = start;
  const BandedQr qr = Factor(rows);
  result.diagonal_ratio = qr.DiagonalRatio();
  const bool finite = std::isfinite(qr.LargestDiagonal());
  if (HasFullRank(qr, shape) || (finite && shape.graded && HasFullRankLevelled(rows))) {
    qr.Solve(&result.control_points);
    result.rank = shape.num_columns;
    result.method = "banded QR";
  } else if (!finite || !start.allFinite()) {
    result.diagonal_ratio = 0.0;
  } else {
    LeastNormFronts fronts(BandedQr::kRankTolerance * qr.LargestDiagonal(), shape.dimension);
    Stretches stretches(shape, start);
    rows.Stream(&stretches);
    stretches.Eliminate(&fronts);
    result.control_points += fronts.Solve(shape.num_columns);
    result.rank = fronts.rank();
    result.method = "minimum norm, front by front";
  }
  result.found = !result.method.empty() && result.control_points.allFinite();
  result.unique = result.found && result.rank == shape.num_columns;
  if (!result.found) {
    result.control_points = start;
    result.rank = -1;
    result.method = "none, numbers are not finite";
  }
  return result;
}

}  // namespace batten
