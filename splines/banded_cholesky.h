#ifndef BATTEN_SPLINES_BANDED_CHOLESKY_H_
#define BATTEN_SPLINES_BANDED_CHOLESKY_H_

#include <vector>

#include "splines/normal_band.h"

namespace batten {

/// N = U' D U in the band, U with unit diagonal. Cyclic matrices carry their last width - 1 columns
/// along as a border, but only as far as the fill in it has not decayed; what is left at the end,
/// and small overlapping matrices (n < 2 width - 1), are dense. Matrices of one shape after the
/// first one are factored without an allocation, overlapping ones excepted, and solved with none
/// where width * d is at most 2048.
class BandedCholesky {
 public:
  /// False if a pivot is not above n * eps * (its diagonal entry) or not finite: N is singular to
  /// working precision, nothing can be solved.
  bool Factor(const NormalBand& matrix);
  /// The same in the memory of the matrix, which is lost.
  bool Factor(NormalBand&& matrix);
  /// x = N^-1 x, n x d row-major.
  void Solve(double* x, int dimension) const;
  /// Estimated ||N||_1 ||N^-1||_1 (Hager's and Higham's estimator), at least 1.
  double ConditionEstimate() const;
  int size() const { return n_; }

 private:
  /// What is left of the rows after the eliminated ones.
  struct Pending {
    std::vector<double> band;  // width x width: rows j.., row i from its diagonal to j + width - 2
    std::vector<double> border;  // (width - 1) x (width - 1): rows j.., border columns
    std::vector<double> corner;  // border x border
  };
  void FirstPending(const LargeArray& band, Pending* first) const;
  /// Factor() into `factor`, num_swept x width or more: factor_'s memory or the band's own.
  bool FactorInto(const NormalBand& matrix, LargeArray* factor);
  /// Of the matrix: what pivots are held against, and the norm.
  void MeasureMatrix(const NormalBand& matrix, int dense_size);
  /// Eliminates columns 0..num_swept_ - 1 into `factor`, which may be the band. kWidth < 0: any
  /// width. False as Factor().
  template <int kWidth>
  bool Sweep(const double* band, double* factor, Pending* pending);
  /// The border's part of column j, whose row of the factor is u. False once the fill is zero.
  template <int kWidth>
  bool SweepBorder(int j, const double* u, Pending* pending);
  void FillDense(const NormalBand& matrix, const Pending& pending);
  template <int kWidth, int kDimension>
  void SolveBand(double* x, int dimension) const;
  /// Rows begin..end - 1, all of them with fill in the border or none.
  template <int kWidth, int kDimension, bool kBordered>
  void SolveForward(int begin, int end, double* x, int dimension) const;
  template <int kWidth, int kDimension, bool kBordered>
  void SolveBackward(int begin, int end, double* x, int dimension) const;

  int n_ = 0;
  int width_ = 0;
  int num_swept_ = 0;     // columns eliminated in the band; the others are dense
  int num_border_ = 0;    // width - 1 if cyclic without overlap
  int num_bordered_ = 0;  // rows with fill in the border
  double norm_ = 0.0;
  double largest_diagonal_ = 0.0;  // with a border only
  LargeArray factor_;              // num_swept_ x width or more: 1 / D_jj, U(j, j + 1), ...
  LargeArray border_;              // as many rows x num_border_: U(j, n - num_border_ + b)
  std::vector<double> dense_;      // upper triangle, row-major, 1 / D on its diagonal
  // Of Factor alone, kept for the next one.
  Pending pending_;
  std::vector<double> limits_;
};

}  // namespace batten

#endif  // BATTEN_SPLINES_BANDED_CHOLESKY_H_
