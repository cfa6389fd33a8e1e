#include "experiments/audit_curve.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>

namespace batten {

AuditCurve::AuditCurve(const AuditedFit& fit)
    : fit_(fit),
      p_(fit.degree),
      n_(static_cast<int>(fit.control_points.size()) / fit.dimension),
      last_(fit.periodic ? n_ + p_ - 1 : n_ - 1),
      ratios_((p_ + 1) * (p_ + 1)),
      work_(p_ + 1) {
  CHECK_GE(p_, 1);
  CHECK_EQ(fit.knots.size(), static_cast<std::size_t>(last_ + p_ + 2));
}

void AuditCurve::MoveTo(Real parameter) {
  const Real t = Wrapped(parameter);
  const double* u = fit_.knots.data();
  // The last span with u_s <= t that is not empty: the domain's end belongs to the span before.
  const double* end = std::upper_bound(u + p_, u + last_ + 1, t,
                                       [](Real value, double knot) { return value < knot; });
  span_ = static_cast<int>(end - u) - 1;
  while (span_ > p_ && u[span_] >= u[span_ + 1]) --span_;
  for (int r = 1; r <= p_; ++r) {
    for (int j = p_; j >= r; --j) {
      const int i = span_ - p_ + j;
      const Real low = u[i];
      ratios_[r * (p_ + 1) + j] = (t - low) / (static_cast<Real>(u[i + p_ - r + 1]) - low);
    }
  }
}

AuditCurve::Real AuditCurve::Coordinate(int c) {
  for (int j = 0; j <= p_; ++j) {
    work_[j] = fit_.control_points[ControlPoint(j) * fit_.dimension + c];
  }
  for (int r = 1; r <= p_; ++r) {
    for (int j = p_; j >= r; --j) {
      const Real a = ratios_[r * (p_ + 1) + j];
      work_[j] = (1 - a) * work_[j - 1] + a * work_[j];
    }
  }
  return work_[p_];
}

void AuditCurve::Transpose(int lowest) {
  std::fill(work_.begin(), work_.end(), 0);
  work_[p_] = 1;
  for (int r = p_; r > lowest; --r) {
    for (int j = r; j <= p_; ++j) {
      const Real a = ratios_[r * (p_ + 1) + j];
      work_[j - 1] += (1 - a) * work_[j];
      work_[j] *= a;
    }
  }
}

const std::vector<AuditCurve::Real>& AuditCurve::BasisValues() {
  Transpose(0);
  return work_;
}

const std::vector<AuditCurve::Real>& AuditCurve::DerivativeWeights() {
  // The ratios of the levels 2..p are those of the functions of degree p - 1.
  Transpose(1);
  for (int j = 1; j <= p_; ++j) {
    const int i = span_ - p_ + j;
    work_[j] *= p_ / (static_cast<Real>(fit_.knots[i + p_]) - fit_.knots[i]);
  }
  return work_;
}

void AuditCurve::DerivativeRow(int k, std::vector<Real>* row, std::vector<Real>* sizes) {
  CHECK(k >= 0 && k <= p_);
  Transpose(k);
  *row = work_;
  *sizes = work_;
  for (int r = k; r >= 1; --r) {
    std::vector<Real> lower(p_ + 1, 0);
    std::vector<Real> lower_sizes(p_ + 1, 0);
    for (int j = r; j <= p_; ++j) {
      const int i = span_ - p_ + j;
      const Real factor =
          (p_ - r + 1) / (static_cast<Real>(fit_.knots[i + p_ - r + 1]) - fit_.knots[i]);
      lower[j] += factor * (*row)[j];
      lower[j - 1] -= factor * (*row)[j];
      lower_sizes[j] += factor * (*sizes)[j];
      lower_sizes[j - 1] += factor * (*sizes)[j];
    }
    *row = lower;
    *sizes = lower_sizes;
  }
}

AuditCurve::Real AuditCurve::Wrapped(Real t) const {
  const Real begin = domain_begin();
  const Real end = domain_end();
  if (!fit_.periodic) return std::clamp(t, begin, end);
  const Real turns = std::floor((t - begin) / (end - begin));
  return std::clamp(t - turns * (end - begin), begin, end);
}

}  // namespace batten
