#include "problems/curve_view.h"

#include "problems/fit_problem.h"

namespace batten {

std::unique_ptr<CurveView> CurveView::Make(const Problem& problem, EvaluationMonitor* monitor) {
  if (problem.terms().empty()) return nullptr;
  std::vector<const RowSource*> sources;
  RowShape shape;
  for (const Problem::TermInstance& term : problem.terms()) {
    const RowSource* source = term.family->rows();
    if (source == nullptr) return nullptr;
    const RowShape part = source->shape();
    const int num_rows = shape.num_rows + part.num_rows;
    const int width = std::max(shape.width, part.width);
    shape = part;
    shape.num_rows = num_rows;
    shape.width = width;
    sources.push_back(source);
  }
  if (shape.num_columns * shape.dimension != problem.num_variables()) return nullptr;
  if (problem.elimination().trivial()) {
    std::unique_ptr<CurveView> view(new CurveView(shape, monitor));
    view->sources_ = std::move(sources);
    return view;
  }
  Eigen::SparseMatrix<double, Eigen::RowMajor> z;
  Points offset;
  if (!problem.elimination().ForPoints(0, shape.num_columns, shape.dimension, &z, &offset)) {
    return nullptr;
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

const NormalBand& CurveView::normal_band() const {
  if (band_ == nullptr) {
    band_ = std::make_unique<NormalBand>(NormalBand::FromRows(row_source()));
  }
  return *band_;
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
