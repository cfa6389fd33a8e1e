#include "solvers/preconditioned_pia.h"

#include <algorithm>
#include <map>

#include "solvers/basic_solution.h"

namespace batten {
namespace {

using SparseRowMajor = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Columns j - q .. j + q, modulo n, each once.
std::vector<int> BandColumns(int j, int q, int n) {
  std::vector<int> columns;
  if (2 * q + 1 >= n) {
    for (int k = 0; k < n; ++k) columns.push_back(k);
  } else {
    for (int k = j - q; k <= j + q; ++k) columns.push_back((k + n) % n);
  }
  return columns;
}

/// The row m with entries in `columns` for which |e_j' - m A| is least, and that distance as a sum
/// of absolute values.
Eigen::VectorXd InverseRow(const SparseRowMajor& a, int j, const std::vector<int>& columns,
                           double* distance) {
  std::map<int, int> equation_of;  // columns of A that the rows touch
  equation_of.emplace(j, 0);
  for (const int row : columns) {
    for (SparseRowMajor::InnerIterator entry(a, row); entry; ++entry) {
      equation_of.emplace(static_cast<int>(entry.col()), static_cast<int>(equation_of.size()));
    }
  }
  Eigen::MatrixXd transposed = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(equation_of.size()),
                                                     static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) {
    for (SparseRowMajor::InnerIterator entry(a, columns[k]); entry; ++entry) {
      transposed(equation_of[static_cast<int>(entry.col())], static_cast<Eigen::Index>(k)) =
          entry.value();
    }
  }
  const Eigen::VectorXd unit = Eigen::VectorXd::Unit(transposed.rows(), 0);
  // Where A is singular so can this be: columns that depend on others to kDependent get nothing,
  // instead of what rounding makes of them.
  constexpr double kDependent = 1e-10;
  Eigen::VectorXd row = BasicSolution(transposed, unit, kDependent);
  *distance = (unit - transposed * row).lpNorm<1>();
  return row;
}

/// matrix times v, faster than Eigen's for few columns; kDimension < 0: any number of them.
template <int kDimension>
Points Product(const SparseRowMajor& matrix, const Points& v) {
  if constexpr (kDimension < 0) {
    return matrix * v;
  } else {
    Points product(v.rows(), v.cols());
    for (Eigen::Index row = 0; row < v.rows(); ++row) {
      double sum[kDimension] = {};
      for (SparseRowMajor::InnerIterator entry(matrix, row); entry; ++entry) {
        const double* const source = v.data() + entry.col() * kDimension;
        for (int c = 0; c < kDimension; ++c) sum[c] += entry.value() * source[c];
      }
      std::copy_n(sum, kDimension, product.data() + row * kDimension);
    }
    return product;
  }
}

}  // namespace

SolverInfo PreconditionedPiaSolver::ClassInfo() {
  SolverInfo info;
  info.name = "preconditioned_pia";
  info.summary = "geometric iteration with a banded approximate inverse of A";
  info.source =
      "Liu, Han & Li, Mathematics 8:1503, 2020; Grote & Huckle, SIAM J. Sci. Comput. 18, 1997";
  info.needs = {"compiled rows", FurtherTerms::kNeeds, "as many control points as points"};
  info.limit = kPairedLimit;
  info.native_rule = NativeRule::kStep;
  info.options = {OptionInfo::Integer("half_width", 3, 0, 50,
                                      "entries of the inverse on each side of its diagonal")};
  return info;
}

PreconditionedPiaSolver::PreconditionedPiaSolver(const OptionValues& options)
    : half_width_(options.Integer("half_width")) {}

std::optional<Outcome> PreconditionedPiaSolver::Prepare() {
  const SparseRowMajor a = Matrix();
  const auto n = static_cast<int>(a.rows());
  std::vector<Eigen::Triplet<double>> entries;
  double norm = 0.0;
  for (int j = 0; j < n; ++j) {
    const std::vector<int> columns = BandColumns(j, half_width_, n);
    double distance = 0.0;
    const Eigen::VectorXd row = InverseRow(a, j, columns, &distance);
    norm = std::max(norm, distance);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      entries.emplace_back(j, columns[k], row[static_cast<Eigen::Index>(k)]);
    }
  }
  inverse_.resize(n, n);
  inverse_.setFromTriplets(entries.begin(), entries.end());
  context()->Note("largest row sum of |I - M^-1 A|", NumberText(norm));
  return std::nullopt;
}

void PreconditionedPiaSolver::TurnIntoMoves(Points* residuals) const {
  switch (residuals->cols()) {
    case 1:
      *residuals = Product<1>(inverse_, *residuals);
      break;
    case 2:
      *residuals = Product<2>(inverse_, *residuals);
      break;
    case 3:
      *residuals = Product<3>(inverse_, *residuals);
      break;
    default:
      *residuals = Product<-1>(inverse_, *residuals);
  }
}

}  // namespace batten
