#ifndef BATTEN_SOLVERS_LANCZOS_H_
#define BATTEN_SOLVERS_LANCZOS_H_

#include <Eigen/Core>
#include <cstdint>
#include <functional>

#include "cost_functions/block_family.h"

namespace batten {

/// Ends of the spectrum of a symmetric operator, as the Lanczos recursion sees them; all zero where
/// it could not be read.
struct Spectrum {
  double smallest = 0.0;        // Ritz value; of the part of the space the start reaches, values
                                // below 64 roundings of the largest left out
  double smallest_error = 0.0;  // residual norm: an eigenvalue lies within it
  double largest = 0.0;
  double largest_error = 0.0;
  int products = 0;
};

/// Lanczos recursion without reorthogonalisation (Golub & Van Loan, sec. 10.1; its ghosts repeat
/// extreme values, they do not falsify them) from `start`, until both residuals are below
/// relative_error of their Ritz value, or max_products. `multiply` may stop the run.
Status EstimateSpectrum(
    const std::function<Status(const Eigen::VectorXd&, Eigen::VectorXd*)>& multiply,
    const Eigen::VectorXd& start, double relative_error, int max_products, Spectrum* spectrum);

/// A start without structure: entries uniform on [-1, 1] from a seed.
Eigen::VectorXd RandomStart(Eigen::Index size, std::uint64_t seed);

}  // namespace batten

#endif  // BATTEN_SOLVERS_LANCZOS_H_
