#include "tests/solvers/dense_fit.h"

#include <Eigen/SVD>
#include <cmath>

#include "tests/splines/example_splines.h"

namespace batten {
namespace {

constexpr double kRankTolerance = 1e-11;  // as BandedQr::kRankTolerance

}  // namespace

DenseFit::DenseFit(const Problem& problem) {
  const CurveFit& fit = *problem.curve_fit();
  const auto m = fit.parameters().size();
  const int n = fit.basis().num_control_points();
  const int d = fit.dimension();
  a.resize(m, n);
  q.resize(m, d);
  for (Eigen::Index i = 0; i < m; ++i) {
    const double weight = problem.terms()[0].family->weight() *
                          (fit.data().weights.has_value() ? (*fit.data().weights)[i] : 1.0);
    for (int j = 0; j < n; ++j) {
      a(i, j) = std::sqrt(weight) * Coefficient(fit.basis(), fit.parameters()[i], j);
    }
    for (int c = 0; c < d; ++c) {
      q(i, c) = std::sqrt(weight) * (fit.data().points(i, c) - fit.setting().center[c]) *
                fit.setting().scale;
    }
  }
  const Points start = Eigen::Map<const Points>(problem.start().data(), n, d);
  Eigen::JacobiSVD<Eigen::MatrixXd> svd(a, Eigen::ComputeThinU | Eigen::ComputeThinV);
  svd.setThreshold(kRankTolerance);
  rank = static_cast<int>(svd.rank());
  smallest = svd.singularValues()[rank - 1];
  largest = svd.singularValues()[0];
  solution = start + svd.solve(q - a * start);
}

double DenseFit::Coefficient(const BsplineBasis& basis, double t, int j) {
  const int n = basis.num_control_points();
  // The definition is empty at the last of p + 1 equal knots, where the curve ends in P_(n-1).
  if (!basis.periodic() && t == basis.knots().back()) return j == n - 1 ? 1.0 : 0.0;
  long double sum = 0.0L;
  for (int function = j; function < (basis.periodic() ? n + basis.degree() : n); function += n) {
    sum += BasisByDefinition(basis.knots(), function, basis.degree(), t);
  }
  return static_cast<double>(sum);
}

double DenseFit::Gap(const Eigen::VectorXd& x) const {
  return (a * (PointsOf(x) - solution)).squaredNorm();
}

Points DenseFit::NearestMinimiser(const Points& start, const Eigen::VectorXd& weights) const {
  const Eigen::VectorXd root = weights.cwiseSqrt().cwiseInverse();
  Eigen::JacobiSVD<Eigen::MatrixXd> svd(a * root.asDiagonal(),
                                        Eigen::ComputeThinU | Eigen::ComputeThinV);
  svd.setThreshold(kRankTolerance);
  return start + root.asDiagonal() * svd.solve(q - a * start);
}

}  // namespace batten
