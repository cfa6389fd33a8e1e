#ifndef BATTEN_EXPERIMENTS_CURVE_PANELS_H_
#define BATTEN_EXPERIMENTS_CURVE_PANELS_H_

#include <vector>

#include "splines/bspline_curve.h"

namespace batten {

/// A curve cut into panels, parts of one span each that are nearly straight, for integrals along
/// it. Beside the knots, where C' may jump, each panel has the values of its own span at both ends.
class CurvePanels {
 public:
  struct Panel {
    int span = 0;
    double begin = 0.0;
    double end = 0.0;
    double length = 0.0;  ///< Of the curve's arc.
    double before = 0.0;  ///< Length of the curve up to `begin`.
  };

  explicit CurvePanels(const BsplineCurve& curve);  ///< Keeps a reference to `curve`.

  const std::vector<Panel>& panels() const { return panels_; }
  double length() const { return panels_.back().before + panels_.back().length; }
  /// Length of the curve from its begin to t, a parameter in the domain.
  double LengthUpTo(double t) const;
  /// C^(k)(t), k = 0 or 1, d coordinates, by the polynomials of `span`.
  void Evaluate(int span, double t, int k, double* result) const;
  /// C'(t) as a unit vector. Where C' is no more than rounding, at a cusp, the one just beside t
  /// towards the middle of the panel; false if that is no more either.
  bool Tangent(const Panel& panel, double t, double* result) const;
  /// Length of the curve from begin to end within a panel, by one Gauss rule: to 1e-9 of it, unless
  /// the panel is too short to be halved.
  double Length(int span, double begin, double end) const;

 private:
  /// P_j of the span, j = 0..p.
  const double* ControlPoint(int span, int j) const;
  bool UnitDerivative(int span, double t, double* result) const;
  double Speed(int span, double t) const;
  /// |C'| on the span that may be no more than rounding.
  double SpeedNoise(int span) const;
  void AddSpan(int span, int num_panels);
  void Split(const Panel& whole);
  bool IsStraight(const Panel& panel) const;

  const BsplineCurve& curve_;
  int dimension_;
  double rounding_;        // of differences of control points
  double shortest_ = 0.0;  // panels are not halved below it
  std::vector<Panel> panels_;
};

/// Angle between two unit vectors, 0 to pi.
double AngleBetween(const double* u, const double* v, int dimension);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_CURVE_PANELS_H_
