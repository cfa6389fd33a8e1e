#ifndef BATTEN_TESTS_SOLVERS_CIRCULANT_FIT_H_
#define BATTEN_TESTS_SOLVERS_CIRCULANT_FIT_H_

#include <cmath>
#include <memory>

#include "tests/solvers/test_fits.h"

namespace batten {

/// Points of a loop on a closed uniform cubic at uniform parameters, `per_span` of them in each
/// span and the first at a knot. With one per span, A is circulant with rows 1/6, 2/3, 1/6, and its
/// eigenvalues are (2 + cos(2 pi k / n)) / 3.
inline std::unique_ptr<Problem> MakeCirculantFit(int num_control_points, int per_span,
                                                 int dimension = 2) {
  DataSet data = MakeNoisyLoop(num_control_points * per_span, dimension, 77);
  data.weights.reset();
  FitSpec spec = MakeSpec(3, true, num_control_points);
  spec.parameters = Parameterization::kUniform;
  return MakeFit(std::move(data), spec);
}

inline double CirculantEigenvalue(int k, int num_control_points) {
  return (2.0 + std::cos(2.0 * M_PI * k / num_control_points)) / 3.0;
}

}  // namespace batten

#endif  // BATTEN_TESTS_SOLVERS_CIRCULANT_FIT_H_
