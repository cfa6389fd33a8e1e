#ifndef BATTEN_SOLVERS_PASSING_LENGTH_H_
#define BATTEN_SOLVERS_PASSING_LENGTH_H_

#include "splines/bezier_stop.h"

namespace batten {

/// How long a piece of a curve may be before it fails a stop test, told from derivatives alone.
///
/// On a short stretch of length h the control points follow a parabola: with D1 = C' / n and
/// D2 = C'' / (n (n - 1)), its inner control points are i (n - i) / 2 h^2 |D1 x D2| / |D1| from the
/// chord, and every stop measure is a known multiple of powers of h, |D1 x D2| and |D1|. A stretch
/// passes while its measure is at most the limit.
class PassingLength {
 public:
  PassingLength(const StopTest& stop, int degree, int dimension);

  /// From the squares of |D1| and |D1 x D2|, in the units of the interval that they belong to;
  /// infinite where the curve is straight.
  double FromSquares(double squared_speed, double squared_cross) const;
  /// At `h` of a piece's interval from its begin, by its first four control points.
  double Near(const double* points, double h) const;

 private:
  struct Squares {
    double speed = 0.0;
    double cross = 0.0;
  };
  template <int d>
  Squares SquaresNear(const double* points, double h) const;

  int degree_;
  int dimension_;
  StopMeasure measure_;
  double factor_ = 0.0;  // length^4, or ^6 or ^2, is factor speed^a / cross^2
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_PASSING_LENGTH_H_
