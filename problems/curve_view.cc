#include "problems/curve_view.h"

#include <utility>

#include "problems/fit_problem.h"
#include "splines/interleaved_rows.h"

namespace batten {

std::unique_ptr<CurveView> CurveView::Make(const Problem& problem, EvaluationMonitor* monitor) {
  std::vector<const RowSource*> sources;
  for (const Problem::TermInstance& term : problem.terms()) {
    sources.push_back(term.family->rows());
  }
  return Make(problem, std::move(sources), monitor);
}

std::unique_ptr<CurveView> CurveView::Make(const Problem& problem,
                                           std::vector<const RowSource*> sources,
                                           EvaluationMonitor* monitor) {
  if (sources.empty() || problem.nonlinear_constraints() != nullptr) return nullptr;
  RowShape shape;
  for (const RowSource* source : sources) {
    if (source == nullptr) return nullptr;
    const RowShape part = source->shape();
    const int num_rows = shape.num_rows + part.num_rows;
    const int width = std::max(shape.width, part.width);
    shape = part;
    shape.num_rows = num_rows;
    shape.width = width;
  }
  if (shape.num_columns * shape.dimension != problem.num_variables()) return nullptr;
  if (problem.elimination().trivial()) {
    std::unique_ptr<CurveView> view(new CurveView(shape, monitor));
    view->sources_ = std::move(sources);
    return view;
  }
  Eigen::SparseMatrix<double, Eigen::RowMajor> z;
  Points offset;
  const bool are_alike =
      problem.elimination().ForPoints(0, shape.num_columns, shape.dimension, &z, &offset);
  std::vector<InterleavedRows> by_coordinate;
  if (!are_alike) {
    // The coordinates are unknowns of one system, in a band that is as many times wider.
    by_coordinate.reserve(sources.size());
    for (const RowSource*& source : sources) {
      by_coordinate.emplace_back(source);
      source = &by_coordinate.back();
    }
    problem.elimination().ForPoints(0, problem.num_variables(), 1, &z, &offset);
  }
  auto rows = std::make_unique<BandedRows>(BandedRows(sources).Substitute(z, offset));
  std::unique_ptr<CurveView> view(new CurveView(rows->shape(), monitor));
  view->rows_ = std::move(rows);
  return view;
}

const RowSource& CurveView::row_source() const {
  if (rows_ != nullptr) return *rows_;
  return sources_.size() == 1 ? *sources_.front() : rows();
}

const BandedRows& CurveView::rows() const {
  if (rows_ == nullptr) rows_ = std::make_unique<BandedRows>(sources_);
  return *rows_;
}

const NormalBand& CurveView::normal_band(int threads) const {
  if (band_ == nullptr) {
    if (rows_ != nullptr || sources_.size() == 1) {
      band_ = std::make_unique<NormalBand>(NormalBand::FromRows(row_source(), threads));
    } else {
      // Term by term: their rows need not be brought into one order for that.
      auto band = std::make_unique<NormalBand>(shape_);
      for (const RowSource* source : sources_) band->AddRows(*source, threads);
      band_ = std::move(band);
    }
  }
  return *band_;
}

NormalBand CurveView::TakeNormalBand(int threads) const {
  normal_band(threads);
  const std::unique_ptr<NormalBand> taken = std::move(band_);
  return std::move(*taken);
}

Status CurveView::Residuals(const Eigen::VectorXd& x, Points* residuals) {
  if (!Allow(&x)) return Status::kStop;
  residuals->resize(num_rows(), dimension());
  rows().Residuals(x.data(), residuals->data());
  return residuals->allFinite() ? Status::kOk : Status::kNonFinite;
}

Status CurveView::TransposedProduct(const Points& r, Eigen::VectorXd* product) {
  if (!Allow(nullptr)) return Status::kStop;
  product->setZero(static_cast<Eigen::Index>(num_points()) * dimension());
  rows().AddTransposedProduct(r.data(), product->data());
  return Status::kOk;
}

Status CurveView::NormalProduct(const Eigen::VectorXd& v, Eigen::VectorXd* product) {
  if (!Allow(nullptr)) return Status::kStop;
  product->resize(v.size());
  normal_band().Multiply(v.data(), product->data());
  return Status::kOk;
}

Status CurveView::NormalResidual(const Eigen::VectorXd& x, Eigen::VectorXd* residual) {
  if (!Allow(&x)) return Status::kStop;
  residual->resize(x.size());
  normal_band().NormalResidual(x.data(), residual->data());
  return residual->allFinite() ? Status::kOk : Status::kNonFinite;
}

}  // namespace batten
