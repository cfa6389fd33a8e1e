#ifndef BATTEN_SPLINES_BSPLINE_BASIS_H_
#define BATTEN_SPLINES_BSPLINE_BASIS_H_

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "splines/points.h"

namespace batten {

/// A B-spline space: degree, knots, open or periodic. Notation of Piegl & Tiller, The NURBS Book:
/// degree p, order p + 1, n control points P_j, j = 0..n-1, knots u_k.
///
/// Open: n + p + 1 knots, domain [u_p, u_n]; the end knots may be repeated p + 1 times
/// (end-interpolating) or not. Periodic: n distinct control points and n + 2p + 1 knots that repeat
/// with the period u_(n+p) - u_p, domain [u_p, u_(n+p)); basis function j of the n + p functions on
/// these knots belongs to control point j mod n. n may be as small as 1: the basis then wraps onto
/// itself, and one control point stands several times in a span.
class BsplineBasis {
 public:
  /// Nothing, with one sentence in `error` (may be null), unless degree is 1..kMaxDegree, knots are
  /// finite and nondecreasing with multiplicity at most p + 1 (inside the domain and everywhere on
  /// periodic splines: p), the domain is not empty, differences of knots and their reciprocals do
  /// not overflow, and, if periodic, knots repeat with the period to 8 roundings of the largest.
  static std::optional<BsplineBasis> Make(int degree, bool periodic, std::vector<double> knots,
                                          std::string* error);

  int degree() const { return degree_; }  // p
  int order() const { return degree_ + 1; }
  bool periodic() const { return periodic_; }
  int num_control_points() const { return num_control_points_; }  // n
  const std::vector<double>& knots() const { return knots_; }
  double domain_begin() const { return knots_[degree_]; }
  double domain_end() const { return knots_[last_span() + 1]; }
  double domain_length() const { return domain_end() - domain_begin(); }

  /// Spans are named by the index k of their first knot, u_k <= t < u_(k+1), k = p..last_span().
  /// Empty ones (repeated knots) are never returned by FindSpan.
  int first_span() const { return degree_; }
  int last_span() const { return degree_ + num_domain_spans() - 1; }
  int num_domain_spans() const {
    return periodic_ ? num_control_points_ : num_control_points_ - degree_;
  }

  /// The span of t. Open: t is clamped to the domain, and domain_end() belongs to the last
  /// non-empty span. Periodic: t must have passed Wrap(). For NaN some span, so that curves become
  /// NaN there and nothing is read out of place.
  int FindSpan(double t) const;
  /// As FindSpan, found from a neighbouring span in time of the distance, at most that of FindSpan.
  /// Any `hint` is allowed.
  int FindSpanFrom(int hint, double t) const;
  /// Periodic: t moved by whole periods into [domain_begin, domain_end). Open: t clamped.
  /// NaN stays NaN; on periodic splines infinite t become NaN.
  double Wrap(double t) const;

  /// Control point of basis function `function` = span - degree + j.
  int ControlPointIndex(int function) const {
    return periodic_ && function >= num_control_points_ ? function % num_control_points_ : function;
  }
  /// Mean of the p knots inside the support of control point j's basis function, which peaks near
  /// it (Greville abscissa); periodic: wrapped into the domain.
  double Greville(int j) const;

 private:
  BsplineBasis(int degree, bool periodic, std::vector<double> knots, int num_control_points)
      : degree_(degree),
        periodic_(periodic),
        num_control_points_(num_control_points),
        knots_(std::move(knots)) {}

  int degree_;
  bool periodic_;
  int num_control_points_;
  std::vector<double> knots_;
};

}  // namespace batten

#endif  // BATTEN_SPLINES_BSPLINE_BASIS_H_
