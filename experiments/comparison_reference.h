#ifndef BATTEN_EXPERIMENTS_COMPARISON_REFERENCE_H_
#define BATTEN_EXPERIMENTS_COMPARISON_REFERENCE_H_

#include <string>
#include <vector>

#include "experiments/run.h"
#include "problems/objective.h"

namespace batten {

/// The direct answer P* of a problem (QR of the rows in their band), and how far from it others
/// are. Points x below are all variables, scaled as inside, as in RunResult. Not thread-safe.
class DirectReference {
 public:
  /// `problem` must outlive this.
  explicit DirectReference(const Problem& problem);

  /// False where E is not quadratic: there is no direct answer, and everything below is NaN.
  bool known() const { return known_; }
  /// The rows have full rank, by BandedQr::kRankTolerance.
  bool unique() const { return unique_; }
  /// E*, in the user's units.
  double minimum_energy() const;
  /// (E(x) - E*) / (E(start) - E*) as ||A(P - P*)||^2 over the same of the start. NaN where the
  /// start is the minimum, to rounding.
  double Gap(const Eigen::VectorXd& x) const;
  /// E(x) - E* in the user's units as (P - P*)'N(P - P*): costs nothing per data point.
  double Excess(const Eigen::VectorXd& x) const;
  /// Over the data's size: the largest distance of a control point from P*; where the minimum is
  /// not unique, the largest |A(P - P*)| of a row.
  double Distance(const Eigen::VectorXd& x) const;
  /// What Distance may be at the end of a run with this |g|, see the .cc; infinite where unknown.
  double AllowedDistance(const RunResult& run) const;

 private:
  Eigen::VectorXd FromMinimum(const Eigen::VectorXd& x) const;  // P - P*, free variables
  double LargestRowProduct(const Eigen::VectorXd& v) const;
  double SmallestEigenvalue() const;  // of N; 0 if singular to working precision
  double SquaredProductFloor() const;
  double StartProduct() const;       // ||A(start - P*)||^2; 0 if that is noise
  double GradientAtMinimum() const;  // |g(P*)| as computed, and its rounding

  const Problem* problem_;
  mutable Objective objective_;
  bool known_ = false;
  bool unique_ = false;
  double scaled_size_ = 1.0;  // of the data, as inside
  Eigen::VectorXd minimum_;   // free variables
  // Below 0: not known yet. Rows stay out of memory until one is asked for.
  mutable double gradient_at_minimum_ = -1.0;
  mutable double start_product_ = -1.0;
  mutable double smallest_eigenvalue_ = -1.0;
};

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_COMPARISON_REFERENCE_H_
