#include "solvers/normal_spectrum.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/lanczos.h"

namespace batten {
namespace {

using Multiply = std::function<Status(const Eigen::VectorXd&, Eigen::VectorXd*)>;

Status Estimate(const Multiply& multiply, Eigen::Index size, std::uint64_t seed, double gershgorin,
                NormalSpectrum* result) {
  constexpr double kRelativeError = 1e-3;
  constexpr int kMaxProducts = 300;
  *result = NormalSpectrum();
  if (gershgorin == 0.0) return Status::kOk;
  // From the matrix times a random vector, so that its null space is left out.
  Eigen::VectorXd start;
  Status status = multiply(RandomStart(size, seed), &start);
  if (status != Status::kOk) return status;
  Spectrum spectrum;
  status = EstimateSpectrum(multiply, start, kRelativeError, kMaxProducts, &spectrum);
  // A Ritz value may still be below l1 by more than its error bound, which is the distance to some
  // eigenvalue; the row sums never are.
  const bool settled =
      spectrum.largest > 0.0 && spectrum.largest_error <= kRelativeError * spectrum.largest;
  result->largest =
      settled ? std::min(gershgorin, spectrum.largest + spectrum.largest_error) : gershgorin;
  // Never 0, also where the recursion could not be read: a momentum of 1 would not converge.
  constexpr double kNull = 64.0 * std::numeric_limits<double>::epsilon();
  result->smallest = std::clamp(spectrum.smallest, kNull * result->largest, result->largest);
  return status;
}

double LargestRowSum(const NormalBand& band) {
  const std::vector<double> sums = band.AbsoluteRowSums();
  return sums.empty() ? 0.0 : *std::max_element(sums.begin(), sums.end());
}

}  // namespace

Status EstimateNormalSpectrum(CurveView* view, std::uint64_t seed, NormalSpectrum* spectrum) {
  const Multiply multiply = [view](const Eigen::VectorXd& v, Eigen::VectorXd* product) {
    return view->NormalProduct(v, product);
  };
  return Estimate(multiply, static_cast<Eigen::Index>(view->num_points()) * view->dimension(), seed,
                  LargestRowSum(view->normal_band()), spectrum);
}

NormalSpectrum ReportSpectrum(const NormalBand& band, std::uint64_t seed) {
  const Multiply multiply = [&band](const Eigen::VectorXd& v, Eigen::VectorXd* product) {
    product->resize(v.size());
    band.Multiply(v.data(), product->data());
    return Status::kOk;
  };
  NormalSpectrum spectrum;
  Estimate(multiply, static_cast<Eigen::Index>(band.size()) * band.dimension(), seed,
           LargestRowSum(band), &spectrum);
  return spectrum;
}

NormalBand ScaledToUnitDiagonal(const NormalBand& band) {
  std::vector<double> roots = band.Diagonal();
  for (double& root : roots) root = root > 0.0 ? 1.0 / std::sqrt(root) : 0.0;
  NormalBand scaled = band;
  const auto n = static_cast<std::size_t>(band.size());
  const auto width = static_cast<std::size_t>(band.width());
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t k = 0; k < width; ++k) {
      scaled.band()[j * width + k] *= roots[j] * roots[(j + k) % n];
    }
  }
  return scaled;
}

}  // namespace batten
