#include "problems/free_view.h"

#include <algorithm>

#include "cost_functions/block_reach.h"

namespace batten {

bool FreeView::ReadConstraints(const Problem& problem) {
  if (problem.has_bounds()) return false;
  if (problem.elimination().trivial()) return true;
  const SparseRows& z = problem.elimination().z();
  const std::vector<int>& free = problem.elimination().free();
  const int begin = sites_->control_point_offset;
  const int end = begin + num_control_points() * dimension();
  // Columns of coordinates follow each other, as the variables do.
  const auto first_column = std::lower_bound(free.begin(), free.end(), begin) - free.begin();
  const auto num_columns =
      std::lower_bound(free.begin(), free.end(), end) - free.begin() - first_column;
  std::vector<Eigen::Triplet<double>> entries;
  held_.assign(sites_->projected ? 0 : static_cast<std::size_t>(num_points()), 0);
  for (int row = 0; row < z.rows(); ++row) {
    const bool is_coordinate = row >= begin && row < end;
    int count = 0;
    bool stays = false;
    for (SparseRows::InnerIterator entry(z, row); entry; ++entry, ++count) {
      const auto column = entry.col() - first_column;
      if (is_coordinate && (column < 0 || column >= num_columns)) return false;
      if (is_coordinate) {
        entries.emplace_back(row - begin, static_cast<int>(column), entry.value());
      }
      stays = free[static_cast<std::size_t>(entry.col())] == row;
    }
    if (is_coordinate || stays) continue;
    if (count != 0) return false;
    held_[static_cast<std::size_t>(row - sites_->parameter_offset)] = 1;
  }
  if (num_columns == end - begin) return true;
  map_.resize(end - begin, num_columns);
  map_.setFromTriplets(entries.begin(), entries.end());
  return true;
}

Eigen::VectorXd FreeView::WithParameters(const Eigen::VectorXd& x) const {
  if (!projected()) return x;
  Eigen::VectorXd all(x.size() + num_points());
  all << x, Eigen::VectorXd::Constant(num_points(), sites_->basis->domain_begin());
  return all;
}

Eigen::VectorXd FreeView::WithoutParameters(const Eigen::VectorXd& all) const {
  return projected() ? all.head(sites_->parameter_offset) : all;
}

bool FreeView::IsOnControlPoints(const BlockFamily& term, const Eigen::VectorXd& any) const {
  std::vector<int> offsets, sizes;
  for (int block = 0; block < term.size(); ++block) {
    term.Bind(any, block, &offsets, &sizes);
    for (std::size_t k = 0; k < offsets.size(); ++k) {
      const int place = offsets[k] - sites_->control_point_offset;
      if (place < 0 || place % dimension() != 0 || sizes[k] != dimension()) return false;
      if (place / dimension() >= num_control_points()) return false;
    }
  }
  return LargestReach(*sites_->basis, dimension(), term, any) <= sites_->basis->degree();
}

std::unique_ptr<FreeView> FreeView::Make(const Problem& problem) {
  if (problem.nonlinear_constraints() != nullptr) return nullptr;
  std::unique_ptr<FreeView> view(new FreeView);
  std::vector<const RowSource*> rows;
  for (const Problem::TermInstance& term : problem.terms()) {
    if (term.family->free_sites() != nullptr && view->sites_ == nullptr) {
      view->sites_ = term.family->free_sites();
    } else if (term.family->rows() != nullptr) {
      rows.push_back(term.family->rows());
    } else if (term.family->free_sites() == nullptr) {
      view->curved_terms_.push_back(term.family.get());
    } else {
      return nullptr;
    }
  }
  if (view->sites_ == nullptr) return nullptr;
  for (const BlockFamily* term : view->curved_terms_) {
    if (!view->IsOnControlPoints(*term, problem.start())) return nullptr;
  }
  if (!view->ReadConstraints(problem)) return nullptr;
  if (!rows.empty()) {
    auto band = std::make_unique<NormalBand>(rows.front()->shape());
    for (const RowSource* source : rows) source->Stream(band.get());
    view->other_terms_ = std::move(band);
  }
  return view;
}

}  // namespace batten
