#ifndef BATTEN_SOLVERS_CUT_SEARCH_H_
#define BATTEN_SOLVERS_CUT_SEARCH_H_

#include <vector>

#include "splines/bezier_cut_value.h"

namespace batten {

/// A cut's place in (0, 1) of a piece, and what it is worth.
struct CutPlace {
  double u = 0.5;
  double value = 0.0;
};

/// The least of 13 values at u = 0.2, 0.25, ..., 0.8 (Ma, Lin, Shen 2016); of equal ones the first.
CutPlace GridMinimum(CutValue* value);

/// All local minima of the value on [1/64, 63/64], ends included, by their place.
///
/// The interval is halved until on each panel the Bernstein form of degree 12 that interpolates the
/// value agrees with it, to 1e-9 of its largest size. The coefficients of its derivative bracket
/// the stationary points: no more zeros than changes of sign (Farouki & Rajan 1987), panels with
/// several are halved by de Casteljau's algorithm. In one variable and on short panels this form is
/// as good as its values, where the numerator of the derivative, of degree 10 n, could not even be
/// written down. At a kink of the hull's area panels end at 2^-14; there the golden section
/// goes on.
std::vector<CutPlace> AllMinima(CutValue* value);

/// The least of AllMinima().
CutPlace ExactMinimum(CutValue* value);

}  // namespace batten

#endif  // BATTEN_SOLVERS_CUT_SEARCH_H_
