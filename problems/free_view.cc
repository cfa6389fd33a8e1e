#include "problems/free_view.h"

namespace batten {
namespace {

/// Which parameters the constraints hold; false if they do anything else.
bool OnlyParametersAreHeld(const Problem& problem, const FreeSites& sites,
                           std::vector<char>* held) {
  held->clear();
  if (problem.has_bounds()) return false;
  if (problem.elimination().trivial()) return true;
  const auto& z = problem.elimination().z();
  if (sites.projected) return false;
  held->assign(static_cast<std::size_t>(sites.weights.size()), 0);
  for (int row = 0; row < z.rows(); ++row) {
    const auto entries = z.outerIndexPtr()[row + 1] - z.outerIndexPtr()[row];
    const bool stays = entries == 1 && z.valuePtr()[z.outerIndexPtr()[row]] == 1.0;
    if (stays) continue;
    const int i = row - sites.parameter_offset;
    if (entries != 0 || i < 0) return false;
    (*held)[static_cast<std::size_t>(i)] = 1;
  }
  return true;
}

}  // namespace

Eigen::VectorXd FreeView::WithParameters(const Eigen::VectorXd& x) const {
  if (!projected()) return x;
  Eigen::VectorXd all(x.size() + num_points());
  all << x, Eigen::VectorXd::Constant(num_points(), sites_->basis->domain_begin());
  return all;
}

Eigen::VectorXd FreeView::WithoutParameters(const Eigen::VectorXd& all) const {
  return projected() ? all.head(sites_->parameter_offset) : all;
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
    } else {
      return nullptr;
    }
  }
  if (view->sites_ == nullptr) return nullptr;
  if (!OnlyParametersAreHeld(problem, *view->sites_, &view->held_)) return nullptr;
  if (!rows.empty()) {
    auto band = std::make_unique<NormalBand>(rows.front()->shape());
    for (const RowSource* source : rows) source->Stream(band.get());
    view->other_terms_ = std::move(band);
  }
  return view;
}

}  // namespace batten
