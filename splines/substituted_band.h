#ifndef BATTEN_SPLINES_SUBSTITUTED_BAND_H_
#define BATTEN_SPLINES_SUBSTITUTED_BAND_H_

#include <Eigen/SparseCore>

#include "splines/normal_band.h"

namespace batten {

/// Z'N Z for a symmetric N in its band and a sparse Z (n x n', a constraint's elimination), in the
/// band again: of n' columns, as wide as the columns of Z ask for that meet in one entry of N. What
/// meets is told by the shape alone, so that sums of many N need no memory. The band is cyclic
/// where that makes it narrower: N is, or Z ties its end to its begin.
class SubstitutedBand {
 public:
  using SparseRowMajor = Eigen::SparseMatrix<double, Eigen::RowMajor>;

  /// Nothing yet.
  SubstitutedBand() : band_(RowShape()) {}
  /// `z` must outlive this. N is one of blocks of block x block: in row j entries from
  /// width - j modulo block on are zero.
  SubstitutedBand(const RowShape& shape, int block, const SparseRowMajor* z);

  /// band() = Z'N Z of an N of this shape.
  void Sum(const NormalBand& matrix);
  const NormalBand& band() const { return band_; }

 private:
  int Reach(int row) const { return reach_ - row % block_; }
  int Partner(int row, int k) const;
  void Add(int i, int j, double entry);
  template <typename Visitor>
  void VisitEntries(const Visitor& visit) const;

  RowShape shape_;
  int block_ = 1;
  int reach_ = 0;  // entries of a block's first row
  const SparseRowMajor* z_ = nullptr;
  NormalBand band_;
};

}  // namespace batten

#endif  // BATTEN_SPLINES_SUBSTITUTED_BAND_H_
