#include "splines/points.h"

#include <algorithm>

namespace batten {
namespace {

template <int kDimension>
void FindBox(const Points& points, Eigen::RowVectorXd* low, Eigen::RowVectorXd* high) {
  // Several points at a time: a minimum waits for the one before it.
  constexpr int kTogether = kDimension <= 2 ? 4 : 2;
  constexpr std::ptrdiff_t kAhead = 512;
  using Rows = Eigen::Array<double, 1, kTogether * kDimension>;
  const double* const values = points.data();
  const Eigen::Index m = points.rows();
  low->resize(kDimension);
  high->resize(kDimension);
  const auto take = [low, high](const double* lows, const double* highs) {
    for (int c = 0; c < kDimension; ++c) {
      (*low)[c] = std::min((*low)[c], lows[c]);
      (*high)[c] = std::max((*high)[c], highs[c]);
    }
  };
  std::copy_n(values, kDimension, low->data());
  std::copy_n(values, kDimension, high->data());
  Eigen::Index i = 0;
  if (m >= kTogether) {
    Rows lows = Eigen::Map<const Rows>(values);
    Rows highs = lows;
    for (i = kTogether; i + kTogether <= m; i += kTogether) {
      // The processor by itself does not read on past the end of a page.
      __builtin_prefetch(values + i * kDimension + kAhead);
      const Eigen::Map<const Rows> rows(values + i * kDimension);
      lows = lows.min(rows);
      highs = highs.max(rows);
    }
    for (int k = 0; k < kTogether; ++k) {
      take(lows.data() + k * kDimension, highs.data() + k * kDimension);
    }
  }
  for (; i < m; ++i) take(values + i * kDimension, values + i * kDimension);
}

}  // namespace

void FindBoundingBox(const Points& points, Eigen::RowVectorXd* low, Eigen::RowVectorXd* high) {
  switch (points.cols()) {
    case 1:
      return FindBox<1>(points, low, high);
    case 2:
      return FindBox<2>(points, low, high);
    case 3:
      return FindBox<3>(points, low, high);
    case 4:
      return FindBox<4>(points, low, high);
    default:
      *low = points.colwise().minCoeff();
      *high = points.colwise().maxCoeff();
  }
}

}  // namespace batten
