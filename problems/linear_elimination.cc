#include "problems/linear_elimination.h"

#include <glog/logging.h>

#include <algorithm>

#include "problems/constraint_rows.h"

namespace batten {

bool LinearElimination::Make(int num_variables, const std::vector<LinearConstraint>& constraints,
                             LinearElimination* elimination, std::string* error) {
  LinearElimination made;
  if (constraints.empty()) {
    *elimination = made;
    return true;
  }
  ConstraintRows rows(num_variables, constraints);
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    if (!rows.Add(static_cast<int>(i), error)) return false;
  }
  rows.Finish();
  std::vector<int> column(static_cast<std::size_t>(num_variables), -1);
  std::vector<Eigen::Triplet<double>> entries;
  for (int v = 0; v < num_variables; ++v) {
    if (rows.row_of(v) >= 0) continue;
    column[static_cast<std::size_t>(v)] = static_cast<int>(made.free_.size());
    entries.emplace_back(v, static_cast<int>(made.free_.size()), 1.0);
    made.free_.push_back(v);
  }
  made.offset_.setZero(num_variables);
  for (const ConstraintRows::Row& row : rows.rows()) {
    made.offset_[row.pivot] = row.value;
    for (const auto& [variable, coefficient] : row.tail) {
      entries.emplace_back(row.pivot, column[static_cast<std::size_t>(variable)], -coefficient);
    }
  }
  made.z_.resize(num_variables, static_cast<Eigen::Index>(made.free_.size()));
  made.z_.setFromTriplets(entries.begin(), entries.end());
  *elimination = std::move(made);
  return true;
}

Eigen::VectorXd LinearElimination::Expand(const Eigen::VectorXd& y) const {
  if (trivial()) return y;
  Eigen::VectorXd x(z_.rows());
  for (std::size_t k = 0; k < free_.size(); ++k) x[free_[k]] = y[static_cast<Eigen::Index>(k)];
  Determine(&x);
  return x;
}

void LinearElimination::Determine(Eigen::VectorXd* x) const {
  std::size_t next = 0;  // of the free variables
  for (int row = 0; row < z_.rows(); ++row) {
    if (next < free_.size() && free_[next] == row) {
      ++next;
      continue;
    }
    double value = offset_[row];
    for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator entry(z_, row); entry;
         ++entry) {
      value += entry.value() * (*x)[free_[static_cast<std::size_t>(entry.col())]];
    }
    (*x)[row] = value;
  }
}

Eigen::VectorXd LinearElimination::ExpandDirection(const Eigen::VectorXd& v) const {
  if (trivial()) return v;
  return z_ * v;
}

Eigen::VectorXd LinearElimination::Restrict(const Eigen::VectorXd& gradient) const {
  if (trivial()) return gradient;
  return z_.transpose() * gradient;
}

Eigen::VectorXd LinearElimination::FreeVariables(const Eigen::VectorXd& x) const {
  if (trivial()) return x;
  Eigen::VectorXd y(static_cast<Eigen::Index>(free_.size()));
  for (std::size_t k = 0; k < free_.size(); ++k) y[static_cast<Eigen::Index>(k)] = x[free_[k]];
  return y;
}

bool LinearElimination::LeavesAll(int begin, int end) const {
  if (trivial()) return true;
  const auto first = std::lower_bound(free_.begin(), free_.end(), begin);
  return std::lower_bound(first, free_.end(), end) - first == end - begin;
}

namespace {

/// Whether row `row` of z is row `first` with every variable moved by `shift`.
bool RowsAreAlike(const Eigen::SparseMatrix<double, Eigen::RowMajor>& z,
                  const std::vector<int>& free, int first, int row) {
  using Row = Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator;
  Row a(z, first);
  Row b(z, row);
  for (; a && b; ++a, ++b) {
    const int variable = free[static_cast<std::size_t>(a.col())];
    const int moved = free[static_cast<std::size_t>(b.col())];
    if (moved - variable != row - first || a.value() != b.value()) return false;
  }
  return !a && !b;
}

}  // namespace

bool LinearElimination::ForPoints(int begin, int num_points, int dimension,
                                  Eigen::SparseMatrix<double, Eigen::RowMajor>* z,
                                  Points* offset) const {
  if (trivial()) {
    z->resize(num_points, num_points);
    z->setIdentity();
    offset->setZero(num_points, dimension);
    return true;
  }
  const int end = begin + num_points * dimension;
  CHECK(begin >= 0 && end <= z_.rows());
  std::vector<int> point_column(z_.cols(), -1);  // of the free variables with coordinate 0
  int num_free_points = 0;
  int num_inside = 0;
  for (std::size_t k = 0; k < free_.size(); ++k) {
    if (free_[k] < begin || free_[k] >= end) continue;
    ++num_inside;
    if ((free_[k] - begin) % dimension == 0) point_column[k] = num_free_points++;
  }
  // All variables outside must stay as they are.
  const int num_outside = static_cast<int>(z_.rows()) - (end - begin);
  if (static_cast<int>(free_.size()) - num_inside != num_outside) return false;

  std::vector<Eigen::Triplet<double>> entries;
  for (int j = 0; j < num_points; ++j) {
    const int first = begin + j * dimension;
    for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator entry(z_, first); entry;
         ++entry) {
      const int column = point_column[static_cast<std::size_t>(entry.col())];
      if (column < 0) return false;
      entries.emplace_back(j, column, entry.value());
    }
    for (int c = 1; c < dimension; ++c) {
      if (!RowsAreAlike(z_, free_, first, first + c)) return false;
    }
  }
  z->resize(num_points, num_free_points);
  z->setFromTriplets(entries.begin(), entries.end());
  *offset = Eigen::Map<const Points>(offset_.data() + begin, num_points, dimension);
  return true;
}

}  // namespace batten
