#include "solvers/further_terms.h"

#include <algorithm>

#include "problems/fit_problem.h"
#include "solvers/solver.h"

namespace batten {
namespace {

constexpr char kInterpolation[] = "interpolation";

bool IsInterpolation(const Problem::TermInstance& term) { return IsNamed(term, kInterpolation); }

}  // namespace

bool IsNamed(const Problem::TermInstance& term, const std::string& name) {
  return term.name.substr(0, term.name.find('/')) == name;
}

NormalBand BandOfTerms(const Problem& problem, const RowShape& shape,
                       const std::function<bool(const Problem::TermInstance&)>& is_wanted) {
  NormalBand band(shape);
  for (const Problem::TermInstance& term : problem.terms()) {
    if (is_wanted(term)) band.AddRows(*term.family->rows(), 1);
  }
  return band;
}

std::string FurtherTerms::WhyNot(const Objective& objective, const std::string& solver_name) {
  const Problem& problem = objective.problem();
  // Linear ones neither: what says so for solvers that hold those would be wrong here.
  if (problem.nonlinear_constraints() != nullptr) {
    return solver_name + " takes no constraints; use augmented_lagrangian:lbfgs";
  }
  std::string why = WhyNoUnboundedCurveView(objective, solver_name);
  if (!why.empty()) return why;
  const CurveFit* fit = problem.curve_fit();
  const auto& terms = problem.terms();
  const auto count = std::count_if(terms.begin(), terms.end(), IsInterpolation);
  if (fit == nullptr || count != 1) {
    return solver_name +
           " moves control points by residuals of one interpolation term, and there " +
           (fit == nullptr || count == 0 ? "is none" : "are " + std::to_string(count)) +
           "; use lspia";
  }
  const auto term = std::find_if(terms.begin(), terms.end(), IsInterpolation);
  if (term->family->weight() != 1.0) {
    return solver_name +
           " takes interpolation with weight 1 alone; use weights of the other terms, or lspia";
  }
  if (fit->data().weights.has_value()) {
    return solver_name + " takes no weights per point; use lspia";
  }
  if (!problem.elimination().trivial()) return solver_name + " takes no constraints; use lspia";
  return "";
}

const BandedRows& FurtherTerms::InterpolationRows(Objective* objective,
                                                  std::optional<BandedRows>* own) {
  const auto& terms = objective->problem().terms();
  if (terms.size() == 1) return objective->curve_view()->rows();
  const auto term = std::find_if(terms.begin(), terms.end(), IsInterpolation);
  return own->emplace(std::vector<const RowSource*>{term->family->rows()});
}

FurtherTerms::FurtherTerms(Objective* objective) {
  const Problem& problem = objective->problem();
  if (problem.terms().size() == 1) return;
  band_ = BandOfTerms(problem, objective->curve_view()->shape(),
                      [](const auto& term) { return !IsInterpolation(term); });
  if (band_->LargestRowSum() == 0.0) band_.reset();
}

void FurtherTerms::Pull(const double* control_points, Points* pull) const {
  pull->resize(band_->size(), band_->dimension());
  band_->NormalResidual(control_points, pull->data());
}

Eigen::SparseMatrix<double, Eigen::RowMajor> FurtherTerms::ToSparse() const {
  const int n = band_->size(), width = band_->width();
  std::vector<Eigen::Triplet<double>> entries;
  for (int j = 0; j < n; ++j) {
    for (int k = 0; k < width && (band_->cyclic() || j + k < n); ++k) {
      const double entry = band_->band()[static_cast<std::size_t>(j) * width + k];
      const int column = (j + k) % n;
      entries.emplace_back(j, column, entry);
      if (k > 0) entries.emplace_back(column, j, entry);
    }
  }
  Eigen::SparseMatrix<double, Eigen::RowMajor> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace batten
