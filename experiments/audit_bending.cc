#include <array>
#include <cmath>

#include "experiments/audit_sums.h"

namespace batten {
namespace {

using Real = AuditSums::Real;
constexpr int kMostAxes = AuditSums::kMostCoordinates;
using Vector = std::array<Real, kMostAxes>;

Real Length(const Vector& v) {
  Real sum = 0;
  for (const Real value : v) sum += value * value;
  return std::sqrt(sum);
}

/// Gauss and Legendre's rule on (-1, 1): roots of P_n by Newton's method from Chebyshev's, P_n and
/// P_n' by the three-term recursion (Abramowitz & Stegun, 22.7.10 and 25.4.29).
void LegendreRule(int n, std::vector<Real>* nodes, std::vector<Real>* weights) {
  constexpr int kSteps = 12;  // quadratic, from two digits on
  const Real pi = std::acos(static_cast<Real>(-1));
  for (int i = 0; i < n; ++i) {
    Real x = std::cos(pi * (static_cast<Real>(i) + 0.75L) / (static_cast<Real>(n) + 0.5L));
    Real slope = 1;
    for (int step = 0; step < kSteps; ++step) {
      Real before = 1, value = x;
      for (int k = 2; k <= n; ++k) {
        const Real next = ((2 * k - 1) * x * value - (k - 1) * before) / k;
        before = value;
        value = next;
      }
      slope = n * (before - x * value) / (1 - x * x);
      x -= value / slope;
    }
    nodes->push_back(x);
    weights->push_back(2 / ((1 - x * x) * slope * slope));
  }
}

/// A derivative of the curve, and what the run may know it less well by.
struct Known {
  Vector value = {};
  Real length = 0;
  Real error = 0;
  std::vector<Real> row;
  std::vector<Real> sizes;
};

Known Derivative(const AuditedFit& fit, int k, Real relative, const std::vector<Real>& data_sizes,
                 AuditCurve* curve) {
  Known known;
  curve->DerivativeRow(k, &known.row, &known.sizes);
  Vector error = {};
  for (int c = 0; c < fit.dimension; ++c) {
    for (int j = 0; j <= fit.degree; ++j) {
      const Real point =
          fit.control_points[static_cast<std::size_t>(curve->ControlPoint(j) * fit.dimension + c)];
      known.value[c] += known.row[j] * point;
      error[c] += AuditSums::kUnitRoundoff * (1 + relative) * known.sizes[j] *
                  (std::abs(point) + data_sizes[static_cast<std::size_t>(c)]);
    }
  }
  known.length = Length(known.value);
  known.error = Length(error);
  return known;
}

/// R = |a|^p S, antisymmetric; the energy is the sum of R_ij^2 over i < j. With a, b, c = C', C'',
/// C''' and x ^ y = x y' - y x' the sum is
///   bending    S = a ^ b,                              p = -5/2,
///   variation  S = |a|^2 (a ^ c) - 3 (a . b) (a ^ b),  p = -11/2.
class Bivector {
 public:
  Bivector(int d, bool variation, const Known& a, const Known& b, const Known& c)
      : d_(d), variation_(variation), a_(a.value), b_(b.value), c_(c.value), speed_(a.length) {
    for (int i = 0; i < d_; ++i) along_ += a_[i] * b_[i];
    power_ = std::pow(speed_, variation_ ? -5.5L : -2.5L);
    for (int i = 0; i < d_; ++i) {
      for (int j = 0; j < d_; ++j) {
        const Real bend = a_[i] * b_[j] - a_[j] * b_[i];
        const Real change = a_[i] * c_[j] - a_[j] * c_[i];
        const Real s = variation_ ? speed_ * speed_ * change - 3 * along_ * bend : bend;
        r_[i][j] = power_ * s;
        if (i >= j) continue;
        squared_ += r_[i][j] * r_[i][j];
        with_bend_ += r_[i][j] * bend;
        with_change_ += r_[i][j] * change;
      }
    }
  }

  Real squared() const { return squared_; }

  /// Half the gradient of the energy by a, b and c. The sum of R_ij (u ^ v)_ij over i < j is
  /// u . R v.
  std::array<Vector, 3> HalfGradient() const {
    const Vector ra = Times(a_), rb = Times(b_), rc = Times(c_);
    std::array<Vector, 3> half = {};
    for (int i = 0; i < d_; ++i) {
      const Real radial = squared_ * a_[i] / (speed_ * speed_);
      if (!variation_) {
        half[0][i] = -2.5L * radial + power_ * rb[i];
        half[1][i] = -power_ * ra[i];
        continue;
      }
      const Real s = speed_ * speed_;
      half[0][i] = -5.5L * radial + power_ * (2 * a_[i] * with_change_ + s * rc[i] -
                                              3 * b_[i] * with_bend_ - 3 * along_ * rb[i]);
      half[1][i] = power_ * (-3 * a_[i] * with_bend_ + 3 * along_ * ra[i]);
      half[2][i] = -power_ * s * ra[i];
    }
    return half;
  }

 private:
  Vector Times(const Vector& v) const {
    Vector product = {};
    for (int i = 0; i < d_; ++i) {
      for (int j = 0; j < d_; ++j) product[i] += r_[i][j] * v[j];
    }
    return product;
  }

  int d_;
  bool variation_;
  const Vector& a_;
  const Vector& b_;
  const Vector& c_;
  Real speed_;
  Real along_ = 0;
  Real power_ = 0;
  Real r_[kMostAxes][kMostAxes] = {};
  Real squared_ = 0;
  Real with_bend_ = 0;    // sum of R_ij (a ^ b)_ij, i < j
  Real with_change_ = 0;  // of R_ij (a ^ c)_ij
};

/// Bounds of |dR| and of |d^2 R|, by the product rule from |x ^ y| <= |x| |y|.
struct Bounds {
  Real first[3] = {};
  Real second[3][3] = {};
};

Bounds BoundsOf(bool variation, Real a, Real b, Real c) {
  Bounds bounds;
  if (!variation) {
    const Real p = std::pow(a, -1.5L);
    bounds.first[0] = 3.5L * b * p / a;
    bounds.first[1] = p;
    bounds.second[0][0] = 16.25L * b * p / (a * a);
    bounds.second[0][1] = bounds.second[1][0] = 3.5L * p / a;
    return bounds;
  }
  const Real p = std::pow(a, -2.5L);
  bounds.first[0] = (4.5L * c + 22.5L * b * b / a) * p / a;
  bounds.first[1] = 6 * b * p / a;
  bounds.first[2] = p;
  bounds.second[0][0] = (26.25L * c + 195.75L * b * b / a) * p / (a * a);
  bounds.second[0][1] = bounds.second[1][0] = 45 * b * p / (a * a);
  bounds.second[0][2] = bounds.second[2][0] = 4.5L * p / a;
  bounds.second[1][1] = 6 * p / a;
  return bounds;
}

/// factor * |R|^2 where the curve now is.
void AddPlace(const AuditedFit& fit, bool variation, Real factor, Real relative,
              const std::vector<Real>& data_sizes, AuditCurve* curve, AuditSums* sums) {
  const int orders = variation ? 3 : 2;
  std::array<Known, 3> known;
  for (int k = 0; k < orders; ++k) {
    known[k] = Derivative(fit, k + 1, relative, data_sizes, curve);
  }
  const Bivector bend(fit.dimension, variation, known[0], known[1], known[2]);
  const std::array<Vector, 3> half = bend.HalfGradient();
  const Bounds bounds = BoundsOf(variation, known[0].length, known[1].length, known[2].length);
  const Real size = std::sqrt(bend.squared());
  Real rounding = 0;
  for (int k = 0; k < orders; ++k) rounding += bounds.first[k] * known[k].error;
  Real of_half[3] = {};
  for (int k = 0; k < orders; ++k) {
    of_half[k] = bounds.first[k] * rounding;
    for (int l = 0; l < orders; ++l) of_half[k] += size * bounds.second[k][l] * known[l].error;
  }
  sums->energy += factor * bend.squared();
  sums->weighted_squares += factor * bend.squared();
  sums->squared_rounding += factor * rounding * rounding;
  ++sums->num_places;
  for (int j = 0; j <= fit.degree; ++j) {
    const int point = curve->ControlPoint(j);
    ++sums->num_summands[point];
    for (int c = 0; c < fit.dimension; ++c) {
      const auto entry = static_cast<std::size_t>(point * fit.dimension + c);
      for (int k = 0; k < orders; ++k) {
        sums->gradient[entry] += 2 * factor * known[k].row[j] * half[k][c];
        sums->rounding[entry] +=
            2 * factor *
            (std::abs(known[k].row[j]) * of_half[k] +
             AuditSums::kUnitRoundoff * (1 + relative) * known[k].sizes[j] * std::abs(half[k][c]));
      }
    }
  }
}

}  // namespace

void AddBending(const AuditedFit& fit, const AuditedBending& bending,
                const std::vector<Real>& data_sizes, AuditCurve* curve, AuditSums* sums) {
  std::vector<Real> nodes;
  std::vector<Real> weights;
  LegendreRule(bending.points, &nodes, &weights);
  const auto add_span = [&](Real begin, Real length, Real factor) {
    for (std::size_t g = 0; g < nodes.size(); ++g) {
      curve->MoveTo(begin + (1 + nodes[g]) * length / 2);
      AddPlace(fit, bending.variation, factor * weights[g] * length / 2,
               NodeRounding(begin, length), data_sizes, curve, sums);
    }
  };
  VisitSpans(fit, *curve, bending.factor, bending.span_factors, add_span);
}

}  // namespace batten
