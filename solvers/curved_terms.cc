#include "solvers/curved_terms.h"

#include <algorithm>
#include <utility>

namespace batten {
namespace {

/// Of each block the term's weight times rho', with which its squared residuals touch E from above.
bool BlockWeights(const BlockFamily& term, const Eigen::VectorXd& x, std::vector<double>* weights) {
  weights->assign(static_cast<std::size_t>(term.size()), term.weight());
  if (term.loss() == nullptr) return true;
  Eigen::VectorXd residuals;
  if (term.Residuals(x, &residuals) != Status::kOk) return false;
  const int k = term.num_residuals();
  for (int block = 0; block < term.size(); ++block) {
    double rho[3];
    term.loss()->Evaluate(residuals.segment(block * k, k).squaredNorm(), rho);
    (*weights)[static_cast<std::size_t>(block)] *= std::max(rho[1], 0.0);
  }
  return true;
}

}  // namespace

CurvedTerms::CurvedTerms(const FreeView& view)
    : basis_(*view.sites().basis),
      terms_(view.curved_terms()),
      dimension_(view.dimension()),
      offset_(view.sites().control_point_offset) {
  if (terms_.empty()) return;
  const Eigen::VectorXd any =
      Eigen::VectorXd::Zero(offset_ + basis_.num_control_points() * dimension_);
  hessian_.emplace(basis_, dimension_, offset_, terms_, any);
}

void CurvedTerms::AddEntry(int a, int b, double value, NormalBand* band) const {
  const int n = basis_.num_control_points(), d = dimension_;
  if (a > b) std::swap(a, b);
  int apart = b / d - a / d;
  // The shorter way around is in the band, whichever row it begins in.
  if (band->cyclic() && apart > basis_.degree()) {
    std::swap(a, b);
    apart = n - apart;
  }
  band->band()[static_cast<std::size_t>(a) * band->width() + apart * d + b % d - a % d] += value;
}

bool CurvedTerms::AddGaussNewton(const BlockFamily& term, const Eigen::VectorXd& x,
                                 NormalBand* band, std::vector<double>* diagonal) const {
  std::vector<Eigen::Triplet<double>> entries;
  if (term.Jacobian(x, 0, &entries) != Status::kOk) return false;
  std::vector<double> weights;
  if (!BlockWeights(term, x, &weights)) return false;
  SparseRows jacobian(static_cast<Eigen::Index>(term.size()) * term.num_residuals(), x.size());
  jacobian.setFromTriplets(entries.begin(), entries.end());
  for (int row = 0; row < jacobian.rows(); ++row) {
    const double weight = weights[static_cast<std::size_t>(row / term.num_residuals())];
    for (SparseRows::InnerIterator a(jacobian, row); a; ++a) {
      const auto i = static_cast<int>(a.col()) - offset_;
      (*diagonal)[static_cast<std::size_t>(i)] += weight * a.value() * a.value();
      for (SparseRows::InnerIterator b(a); b && band != nullptr; ++b) {
        AddEntry(i, static_cast<int>(b.col()) - offset_, weight * a.value() * b.value(), band);
      }
    }
  }
  return true;
}

void CurvedTerms::AddHessian(NormalBand* band) const {
  const NormalBand& hessian = hessian_->band();
  const int size = hessian.size(), width = hessian.width();
  for (int a = 0; a < size; ++a) {
    for (int k = 0; k < width; ++k) {
      const double entry = hessian.band()[static_cast<std::size_t>(a) * width + k];
      // Zero where control points do not meet, for which `band` has no place.
      if (entry != 0.0) AddEntry(a, (a + k) % size, 0.5 * entry, band);
    }
  }
}

bool CurvedTerms::AddTo(const Eigen::VectorXd& x, bool exact, double* energy,
                        Eigen::VectorXd* half_gradient, NormalBand* band,
                        std::vector<double>* diagonal) {
  if (terms_.empty()) return true;
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(x.size());
  for (const BlockFamily* term : terms_) {
    if (term->Evaluate(x, 0, term->size(), energy, &gradient) != Status::kOk) return false;
  }
  *half_gradient += 0.5 * gradient.segment(offset_, half_gradient->size());
  for (const BlockFamily* term : terms_) {
    if (!AddGaussNewton(*term, x, exact ? nullptr : band, diagonal)) return false;
  }
  if (!exact) return true;
  if (hessian_->Sum(x, [] { return true; }) != Status::kOk) return false;
  AddHessian(band);
  return true;
}

}  // namespace batten
