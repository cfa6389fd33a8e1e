#include "experiments/nearest_point.h"

#include <glog/logging.h>

#include <algorithm>
#include <numeric>

namespace batten {
namespace {

constexpr int kLeaf = 8;  // points that are looked at one by one

}  // namespace

NearestPoint::NearestPoint(const Points& points) : points_(points) {
  CHECK_GE(points.rows(), 1);
  order_.resize(static_cast<std::size_t>(points.rows()));
  std::iota(order_.begin(), order_.end(), 0);
  axes_.resize(order_.size());
  Build(0, static_cast<int>(order_.size()));
  for (Eigen::Index i = 0; i < points.rows(); ++i) points_.row(i) = points.row(order_[i]);
  order_.clear();
}

void NearestPoint::Build(int begin, int end) {
  if (end - begin <= kLeaf) return;
  Eigen::RowVectorXd low = points_.row(order_[begin]);
  Eigen::RowVectorXd high = low;
  for (int k = begin + 1; k < end; ++k) {
    low = low.cwiseMin(points_.row(order_[k]));
    high = high.cwiseMax(points_.row(order_[k]));
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  const int middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](int a, int b) { return points_(a, axis) < points_(b, axis); });
  axes_[middle] = static_cast<signed char>(axis);
  Build(begin, middle);
  Build(middle + 1, end);
}

double NearestPoint::SquaredDistance(const double* query, int point) const {
  double sum = 0.0;
  for (Eigen::Index c = 0; c < points_.cols(); ++c) {
    const double difference = query[c] - points_(point, c);
    sum += difference * difference;
  }
  return sum;
}

NearestPoint::Found NearestPoint::Find(const double* query, int guess) const {
  Found best = {guess, SquaredDistance(query, guess)};
  Search(query, 0, static_cast<int>(points_.rows()), &best);
  return best;
}

void NearestPoint::Search(const double* query, int begin, int end, Found* best) const {
  const auto look_at = [&](int point) {
    const double squared = SquaredDistance(query, point);
    if (squared < best->squared_distance) *best = {point, squared};
  };
  if (end - begin <= kLeaf) {
    for (int point = begin; point < end; ++point) look_at(point);
    return;
  }
  const int middle = begin + (end - begin) / 2;
  look_at(middle);
  const double beyond = query[axes_[middle]] - points_(middle, axes_[middle]);
  const bool is_low = beyond < 0.0;
  Search(query, is_low ? begin : middle + 1, is_low ? middle : end, best);
  if (beyond * beyond >= best->squared_distance) return;
  Search(query, is_low ? middle + 1 : begin, is_low ? end : middle, best);
}

}  // namespace batten
