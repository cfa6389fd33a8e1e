#include "solvers/lanczos.h"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "splines/dense_eigenvalues.h"

namespace batten {
namespace {

/// False, with nothing read, if the small eigenproblem does not converge, as can happen where its
/// entries differ by many powers of ten.
bool ReadRitzValues(const std::vector<double>& diagonal, const std::vector<double>& off_diagonal,
                    Spectrum* spectrum) {
  const auto k = static_cast<Eigen::Index>(diagonal.size());
  const SymmetricEigen small =
      DecomposeTridiagonal(Eigen::Map<const Eigen::VectorXd>(diagonal.data(), k),
                           Eigen::Map<const Eigen::VectorXd>(off_diagonal.data(), k - 1));
  if (!small.values.allFinite()) return false;
  const double beta = off_diagonal.back();
  const Eigen::VectorXd& values = small.values;
  // Rounding brings in what the start does not reach, and a Ritz value that falls to zero with it.
  constexpr double kRoundings = 64.0;
  const double null = kRoundings * std::numeric_limits<double>::epsilon() * values[k - 1];
  Eigen::Index first = 0;
  while (first < k - 1 && values[first] <= null) ++first;
  spectrum->smallest = values[first];
  spectrum->smallest_error = beta * std::abs(small.vectors(k - 1, first));
  spectrum->largest = values[k - 1];
  spectrum->largest_error = beta * std::abs(small.vectors(k - 1, k - 1));
  return true;
}

}  // namespace

Status EstimateSpectrum(
    const std::function<Status(const Eigen::VectorXd&, Eigen::VectorXd*)>& multiply,
    const Eigen::VectorXd& start, double relative_error, int max_products, Spectrum* spectrum) {
  *spectrum = Spectrum();
  std::vector<double> diagonal;
  std::vector<double> off_diagonal;
  const double norm = start.norm();
  if (!(norm > 0.0)) return Status::kOk;
  Eigen::VectorXd current = start / norm;
  Eigen::VectorXd previous = Eigen::VectorXd::Zero(start.size());
  Eigen::VectorXd product;
  int next_check = 8;
  for (int k = 1; k <= max_products; ++k) {
    const Status status = multiply(current, &product);
    if (status != Status::kOk) return status;
    spectrum->products = k;
    const double alpha = current.dot(product);
    product -= alpha * current;
    if (k > 1) product -= off_diagonal.back() * previous;
    const double beta = product.norm();
    diagonal.push_back(alpha);
    off_diagonal.push_back(beta);
    // An invariant subspace: the Ritz values are eigenvalues.
    const bool exhausted = beta <= std::numeric_limits<double>::epsilon() * std::abs(alpha);
    if (k == next_check || k == max_products || exhausted) {
      const bool close = ReadRitzValues(diagonal, off_diagonal, spectrum) &&
                         spectrum->smallest_error <= relative_error * spectrum->smallest &&
                         spectrum->largest_error <= relative_error * spectrum->largest;
      if (close || exhausted) break;
      // Each reading costs k^2: at growing distances.
      next_check = k + k / 2;
    }
    previous.swap(current);
    current = product / beta;
  }
  return Status::kOk;
}

Eigen::VectorXd RandomStart(Eigen::Index size, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  // Not std::uniform_real_distribution, whose values differ between C++ libraries.
  const auto uniform = [&random] { return static_cast<double>(random() >> 11) * 0x1.0p-52 - 1.0; };
  Eigen::VectorXd start(size);
  for (Eigen::Index i = 0; i < size; ++i) start[i] = uniform();
  return start;
}

}  // namespace batten
