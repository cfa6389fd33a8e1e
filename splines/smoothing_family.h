#ifndef BATTEN_SPLINES_SMOOTHING_FAMILY_H_
#define BATTEN_SPLINES_SMOOTHING_FAMILY_H_

#include <vector>

#include "splines/banded_rows.h"
#include "splines/normal_band.h"

namespace batten {

/// The minimisers of |A P - Q|^2 + |B P - R|^2 + weight |D P - G|^2 for data rows A, rows B that
/// are no data (or none), fairing rows D and any weight, each by one QR in the band.
class SmoothingFamily {
 public:
  /// All of the same columns, dimension and kind; they are copied. `others`: B, null for none.
  SmoothingFamily(const RowSource& data, const RowSource& fairing,
                  const RowSource* others = nullptr);

  struct Member {
    double weight = 0.0;
    Points control_points;
    double residual = 0.0;  ///< |A P - Q|^2
    double bend = 0.0;      ///< |D P - G|^2
    /// Trace of the hat matrix of the data rows: effective number of control points, each
    /// coordinate's.
    double trace = 0.0;
  };
  /// False where there is no finite answer.
  bool At(double weight, Member* member) const;

  /// Rows of the data that are not zero: m, or fewer where points have no weight.
  int num_data() const { return num_data_; }
  int num_control_points() const { return normal_.size(); }
  /// Weight at which both terms are alike in size: trace(A'A) / trace(D'D).
  double BalancedWeight() const;

 private:
  BandedRows data_;
  BandedRows fairing_;
  BandedRows others_;
  BandedRows all_;                // of all of them
  std::vector<char> is_fairing_;  // which of these
  NormalBand normal_;             // A'A
  double trace_of_fairing_ = 0.0;
  int num_data_ = 0;
};

}  // namespace batten

#endif  // BATTEN_SPLINES_SMOOTHING_FAMILY_H_
