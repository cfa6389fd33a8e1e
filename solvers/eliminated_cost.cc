#include "solvers/eliminated_cost.h"

#include <algorithm>
#include <map>
#include <utility>

namespace batten {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Entry = Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator;

int Column(const Entry& entry) { return static_cast<int>(entry.col()); }

/// r(offset + Z y) of one block r(x), with dr/dy = dr/dx Z.
class EliminatedCost final : public ceres::CostFunction {
 public:
  /// z has a row for each of the block's x and a column for each y of its groups.
  EliminatedCost(std::unique_ptr<ceres::CostFunction> cost, RowMajor z, Eigen::VectorXd offset,
                 const std::vector<int>& sizes)
      : cost_(std::move(cost)), z_(std::move(z)), offset_(std::move(offset)) {
    set_num_residuals(cost_->num_residuals());
    mutable_parameter_block_sizes()->assign(sizes.begin(), sizes.end());
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    Eigen::VectorXd x = offset_;
    Eigen::Index column = 0;
    for (std::size_t i = 0; i < parameter_block_sizes().size(); ++i) {
      const int size = parameter_block_sizes()[i];
      x += z_.middleCols(column, size) * Eigen::Map<const Eigen::VectorXd>(parameters[i], size);
      column += size;
    }
    return jacobians == nullptr ? Evaluate(x, residuals, nullptr)
                                : EvaluateWithJacobians(x, residuals, jacobians);
  }

 private:
  bool Evaluate(const Eigen::VectorXd& x, double* residuals, double** inner_jacobians) const {
    std::vector<const double*> inner;
    const double* next = x.data();
    for (const int size : cost_->parameter_block_sizes()) {
      inner.push_back(next);
      next += size;
    }
    return cost_->Evaluate(inner.data(), residuals, inner_jacobians);
  }

  bool EvaluateWithJacobians(const Eigen::VectorXd& x, double* residuals,
                             double** jacobians) const {
    std::vector<RowMajor> inner;
    std::vector<double*> inner_pointers;
    for (const int size : cost_->parameter_block_sizes()) {
      inner.emplace_back(num_residuals(), size);
      inner_pointers.push_back(inner.back().data());
    }
    if (!Evaluate(x, residuals, inner_pointers.data())) return false;
    Eigen::Index column = 0;
    for (std::size_t i = 0; i < parameter_block_sizes().size(); ++i) {
      const int size = parameter_block_sizes()[i];
      if (jacobians[i] != nullptr) {
        Eigen::Map<RowMajor> jacobian(jacobians[i], num_residuals(), size);
        jacobian.setZero();
        Eigen::Index row = 0;
        for (const RowMajor& part : inner) {
          jacobian.noalias() += part * z_.block(row, column, part.cols(), size);
          row += part.cols();
        }
      }
      column += size;
    }
    return true;
  }

  std::unique_ptr<ceres::CostFunction> cost_;
  RowMajor z_;
  Eigen::VectorXd offset_;
};

}  // namespace

FreeGroups::FreeGroups(const LinearElimination& elimination, const VariableGroups& all)
    : elimination_(elimination),
      all_(all),
      groups_(elimination.num_free(all.num_variables())),
      free_index_(static_cast<std::size_t>(all.num_variables()), -1) {
  if (elimination.trivial()) {
    groups_ = all;
    return;
  }
  offset_ = elimination.Expand(Eigen::VectorXd::Zero(groups_.num_variables()));
  const std::vector<int>& free = elimination.free();
  for (std::size_t begin = 0, end = 0; begin < free.size(); begin = end) {
    const int group = all.begin_of(free[begin]);
    for (end = begin + 1; end < free.size() && group >= 0 && free[end] == free[end - 1] + 1 &&
                          all.begin_of(free[end]) == group;) {
      ++end;
    }
    groups_.Add(static_cast<int>(begin), static_cast<int>(end - begin));
    for (std::size_t k = begin; k < end; ++k) {
      free_index_[static_cast<std::size_t>(free[k])] = static_cast<int>(k);
    }
  }
}

bool FreeGroups::IsWhole(int begin) const {
  const int first = free_index_[static_cast<std::size_t>(begin)];
  return first >= 0 && groups_.size_at(first) == all_.size_at(begin);
}

std::unique_ptr<ceres::CostFunction> FreeGroups::Rewrite(std::unique_ptr<ceres::CostFunction> cost,
                                                         std::vector<int>* begins) const {
  if (elimination_.trivial()) return cost;
  if (std::all_of(begins->begin(), begins->end(), [this](int b) { return IsWhole(b); })) {
    for (int& begin : *begins) begin = free_index_[static_cast<std::size_t>(begin)];
    return cost;
  }
  std::vector<int> variables;
  for (const int begin : *begins) {
    for (int k = 0; k < all_.size_at(begin); ++k) variables.push_back(begin + k);
  }
  std::map<int, int> first_column;  // of each group of y that is touched, in its order
  for (const int v : variables) {
    for (Entry e(elimination_.z(), v); e; ++e) first_column[groups_.begin_of(Column(e))] = 0;
  }
  // A block of nothing but determined variables is constant, but still part of E.
  if (first_column.empty()) first_column[0] = 0;
  begins->clear();
  std::vector<int> sizes;
  int num_columns = 0;
  for (auto& [begin, column] : first_column) {
    begins->push_back(begin);
    sizes.push_back(groups_.size_at(begin));
    column = num_columns;
    num_columns += sizes.back();
  }
  RowMajor z = RowMajor::Zero(static_cast<Eigen::Index>(variables.size()), num_columns);
  Eigen::VectorXd offset(z.rows());
  for (Eigen::Index i = 0; i < z.rows(); ++i) {
    const int v = variables[static_cast<std::size_t>(i)];
    offset[i] = offset_[v];
    for (Entry e(elimination_.z(), v); e; ++e) {
      const int begin = groups_.begin_of(Column(e));
      z(i, first_column[begin] + Column(e) - begin) = e.value();
    }
  }
  return std::make_unique<EliminatedCost>(std::move(cost), std::move(z), std::move(offset), sizes);
}

}  // namespace batten
