#include "splines/substituted_band.h"

#include <algorithm>
#include <cstdlib>

namespace batten {

SubstitutedBand::SubstitutedBand(const RowShape& shape, int block, const SparseRowMajor* z)
    : shape_(shape), block_(block), reach_(shape.width), z_(z), band_(RowShape()) {
  const int n = static_cast<int>(z->cols());
  int open = 1, cyclic = 1;  // widths
  VisitEntries([&](int row, int, int partner) {
    for (SparseRowMajor::InnerIterator a(*z_, row); a; ++a) {
      for (SparseRowMajor::InnerIterator b(*z_, partner); b; ++b) {
        const int apart = static_cast<int>(std::abs(a.col() - b.col()));
        open = std::max(open, apart + 1);
        cyclic = std::max(cyclic, std::min(apart, n - apart) + 1);
      }
    }
  });
  RowShape made;
  made.num_columns = n;
  made.width = std::min(std::min(open, cyclic), std::max(n, 1));
  made.dimension = 1;
  made.cyclic = cyclic < open;
  band_ = NormalBand(made);
}

int SubstitutedBand::Partner(int row, int k) const {
  const int partner = row + k;
  if (partner < shape_.num_columns) return partner;
  return shape_.cyclic ? partner % shape_.num_columns : -1;
}

/// visit(row, k, column) for every entry of N's band that may be filled.
template <typename Visitor>
void SubstitutedBand::VisitEntries(const Visitor& visit) const {
  for (int row = 0; row < shape_.num_columns; ++row) {
    for (int k = 0; k < Reach(row); ++k) {
      const int partner = Partner(row, k);
      if (partner < 0) break;
      visit(row, k, partner);
    }
  }
}

/// To places (i, j) and (j, i), i != j.
void SubstitutedBand::Add(int i, int j, double entry) {
  const int width = band_.width();
  int first = std::min(i, j);
  int apart = std::max(i, j) - first;
  if (apart >= width) {  // the way around
    first = std::max(i, j);
    apart = band_.size() - apart;
  }
  band_.band()[static_cast<std::size_t>(first) * width + apart] += entry;
}

void SubstitutedBand::Sum(const NormalBand& matrix) {
  std::fill(band_.band().begin(), band_.band().end(), 0.0);
  const int width = band_.width();
  VisitEntries([&](int row, int k, int partner) {
    const double entry = matrix.band()[static_cast<std::size_t>(row) * shape_.width + k];
    if (entry == 0.0) return;
    for (SparseRowMajor::InnerIterator a(*z_, row); a; ++a) {
      for (SparseRowMajor::InnerIterator b(*z_, partner); b; ++b) {
        const double product = entry * a.value() * b.value();
        const int i = static_cast<int>(a.col()), j = static_cast<int>(b.col());
        if (i == j) {
          // Off N's diagonal the entry stands for two.
          band_.band()[static_cast<std::size_t>(i) * width] += k > 0 ? 2.0 * product : product;
        } else if (k > 0 || i < j) {
          Add(i, j, product);
        }
      }
    }
  });
}

}  // namespace batten
