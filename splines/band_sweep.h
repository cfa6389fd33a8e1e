#ifndef BATTEN_SPLINES_BAND_SWEEP_H_
#define BATTEN_SPLINES_BAND_SWEEP_H_

#include <vector>

#include "splines/normal_band.h"

namespace batten {

/// Residuals of N P = B (B - N P) a row at a time, for methods that use new rows of P at once. P is
/// n x d row-major. Does not own `band`, which must not change.
class BandSweep {
 public:
  explicit BandSweep(const NormalBand* band);

  /// For j = 0, 1, ..., n - 1: P_j += relaxation * (B - N P)_j / N_jj with the P_j moved so far
  /// (Gauss and Seidel; successive over-relaxation). Rows whose N_jj is 0 stay.
  void Sweep(double relaxation, double* control_points) const;
  /// residual = (B - N P)_j, d numbers.
  void RowResidual(int j, const double* control_points, double* residual) const;
  /// 1 / N_jj; 0 where N_jj is 0.
  const std::vector<double>& inverse_diagonal() const { return inverse_diagonal_; }

 private:
  template <int kWidth, int kDimension>
  void SweepInside(int begin, int end, double relaxation, double* control_points) const;
  void SweepRows(int begin, int end, double relaxation, double* control_points) const;

  const NormalBand* band_;
  std::vector<double> inverse_diagonal_;
};

}  // namespace batten

#endif  // BATTEN_SPLINES_BAND_SWEEP_H_
