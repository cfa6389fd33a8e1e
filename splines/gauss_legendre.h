#ifndef BATTEN_SPLINES_GAUSS_LEGENDRE_H_
#define BATTEN_SPLINES_GAUSS_LEGENDRE_H_

#include <vector>

namespace batten {

/// integral over [-1, 1] of f = sum_g weights[g] f(nodes[g]), exact for polynomials of degree
/// 2 n - 1; nodes ascend and are mirrored around 0.
struct GaussRule {
  std::vector<double> nodes;
  std::vector<double> weights;
};

/// The rule of Gauss and Legendre with num_points = n >= 1 nodes, right to the last digits: the
/// zeros of Legendre's polynomial P_n, by Newton's iteration in long double.
GaussRule GaussLegendreRule(int num_points);

}  // namespace batten

#endif  // BATTEN_SPLINES_GAUSS_LEGENDRE_H_
