#include "solvers/hessian_band.h"

#include <algorithm>
#include <utility>

#include "cost_functions/block_reach.h"

namespace batten {
namespace {

RowShape BandShape(const BsplineBasis& basis, int dimension, int reach) {
  RowShape shape;
  shape.num_columns = basis.num_control_points() * dimension;
  shape.width = (std::min(reach, basis.num_control_points() - 1) + 1) * dimension;
  shape.dimension = 1;
  shape.cyclic = basis.periodic() && 2 * reach + 1 <= basis.num_control_points();
  return shape;
}

/// Where a curve has so few control points that ways around meet, all of them meet.
int ReachOf(const BsplineBasis& basis, int dimension, const std::vector<const BlockFamily*>& terms,
            const Eigen::VectorXd& any) {
  const int n = basis.num_control_points();
  int reach = 0;
  for (const BlockFamily* term : terms) {
    reach = std::max(reach, LargestReach(basis, dimension, *term, any));
  }
  return basis.periodic() && 2 * reach + 1 > n ? n - 1 : reach;
}

}  // namespace

HessianBand::HessianBand(const BsplineBasis& basis, int dimension, int offset,
                         std::vector<const BlockFamily*> terms, const Eigen::VectorXd& any)
    : basis_(basis),
      dimension_(dimension),
      offset_(offset),
      terms_(std::move(terms)),
      reach_(ReachOf(basis, dimension, terms_, any)),
      shape_(BandShape(basis, dimension, reach_)),
      band_(shape_) {
  MakeColours();
}

/// Runs of about equal length, each of as many control points as meet or more: points that have the
/// same place in their runs do not.
void HessianBand::MakeColours() {
  const int n = basis_.num_control_points();
  const int num_runs = std::max(1, n / (2 * reach_ + 1));
  colours_.resize(static_cast<std::size_t>(n));
  for (int run = 0; run < num_runs; ++run) {
    const int begin = static_cast<int>(static_cast<long long>(n) * run / num_runs);
    const int end = static_cast<int>(static_cast<long long>(n) * (run + 1) / num_runs);
    for (int j = begin; j < end; ++j) colours_[static_cast<std::size_t>(j)] = j - begin;
    num_colours_ = std::max(num_colours_, end - begin);
  }
}

/// From the rows at and before it: row i's entry k stands for column i + k.
void HessianBand::SetColumn(int j, int c, const Eigen::VectorXd& product) {
  const int n = basis_.num_control_points(), d = dimension_, width = band_.width();
  for (int back = 0; back <= reach_; ++back) {
    const int i = j - back >= 0 || !band_.cyclic() ? j - back : j - back + n;
    if (i < 0) break;
    for (int e = 0; e < d; ++e) {
      const int row = i * d + e;
      const int k = back * d + c - e;
      if (k >= 0) {
        band_.band()[static_cast<std::size_t>(row) * width + k] = product[offset_ + row];
      }
    }
  }
}

Status HessianBand::Sum(const Eigen::VectorXd& x, const std::function<bool()>& allow) {
  const int n = basis_.num_control_points(), d = dimension_;
  Eigen::VectorXd direction(x.size()), product(x.size());
  std::fill(band_.band().begin(), band_.band().end(), 0.0);
  for (int colour = 0; colour < num_colours_; ++colour) {
    for (int c = 0; c < d; ++c) {
      direction.setZero();
      product.setZero();
      for (int j = 0; j < n; ++j) {
        if (colours_[static_cast<std::size_t>(j)] == colour) direction[offset_ + j * d + c] = 1.0;
      }
      if (!allow()) return Status::kStop;
      for (const BlockFamily* term : terms_) {
        const Status status = term->AddHessianTimes(x, direction, &product);
        if (status != Status::kOk) return status;
      }
      if (!product.allFinite()) return Status::kNonFinite;
      for (int j = 0; j < n; ++j) {
        if (colours_[static_cast<std::size_t>(j)] == colour) SetColumn(j, c, product);
      }
    }
  }
  return Status::kOk;
}

}  // namespace batten
