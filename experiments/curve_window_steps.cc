// The steps of a CurveWindow: columns of control points and knots, the normal band, its solution.
#include <algorithm>
#include <cmath>

#include "experiments/curve_window.h"
#include "splines/banded_cholesky.h"
#include "splines/basis_functions.h"

namespace batten {

bool CurveWindow::ColumnOf(int i, int first, int count, int place, int* column) const {
  const int stride = curve_->dimension() + 1;
  if (holds_all_) {
    *column = (place - first_) * stride;
    return true;
  }
  int offset = i - first;
  if (curve_->closed()) {
    const int n = curve_->num_control_points();
    offset = ((offset % n) + n) % n;
  }
  *column = (first + offset - i + place - first_) * stride;
  return offset >= 0 && offset < count;
}

void CurveWindow::AddControlPointColumns(int span, const double* basis) {
  const int p = curve_->degree();
  const int d = curve_->dimension();
  for (int j = 0; j <= p; ++j) {
    const int i = span - p + j;
    int column = 0;
    if (!ColumnOf(i, first_, count_, i, &column)) continue;
    for (int c = 0; c < d; ++c) {
      double* const entry = entries_[num_columns_];
      std::fill_n(entry, d, 0.0);
      entry[c] = basis[j];
      columns_[num_columns_++] = column + c;
    }
  }
}

void CurveWindow::AddKnotColumns(int span, double t, const double* span_knots) {
  // With knot k doubled (functions M_i on these knots), dC/du_k = sum of M_i(t) (P_(i-1) - P_i) /
  // (u_(i+p) - u_i) over i = k-p..k: the derivative of a divided difference repeats its knot.
  const int p = curve_->degree();
  const int d = curve_->dimension();
  for (int k = span - p + 1; k <= span + p; ++k) {
    int column = 0;
    if (!ColumnOf(k, first_knot_, num_knots_, k - (p + 1) / 2, &column)) continue;
    // The 2p knots around t where U(k) stands twice; its span's first function is M_start.
    double knots[2 * kMaxDegree];
    const int place = k - (span - p + 1);
    int start = span - p;
    if (k <= span) {  // knots below t move down by one place, the first one out
      for (int r = 0; r < place; ++r) knots[r] = span_knots[r + 1];
      for (int r = place; r < 2 * p; ++r) knots[r] = span_knots[r];
      start = span + 1 - p;
    } else {
      for (int r = 0; r <= place; ++r) knots[r] = span_knots[r];
      for (int r = place + 1; r < 2 * p; ++r) knots[r] = span_knots[r - 1];
    }
    double basis[kMaxOrder];
    EvaluateBasis(p, knots, p - 1, t, basis);
    double* const derivative = entries_[num_columns_];
    std::fill_n(derivative, d, 0.0);
    columns_[num_columns_++] = column + d;
    for (int i = std::max(k - p, start); i <= std::min(k, start + p); ++i) {
      const double width = curve_->Knot(i + p) - curve_->Knot(i);
      if (!(width > 0.0)) continue;
      const double* const before = curve_->ControlPoint(i - 1);
      const double* const after = curve_->ControlPoint(i);
      const double factor = basis[i - start] / width;
      for (int c = 0; c < d; ++c) derivative[c] += factor * (before[c] - after[c]);
    }
  }
}

void CurveWindow::AddPoint(double t, const double* q, double squared_bound, int power, bool slides,
                           bool moves_knots) {
  const int p = curve_->degree();
  const int d = curve_->dimension();
  const int span = curve_->SpanOf(t);
  double knots[2 * kMaxDegree];
  double basis[2 * kMaxOrder];
  curve_->CopySpanKnots(span, knots);
  EvaluateBasisDerivatives(p, knots, p - 1, t, 1, basis);
  num_columns_ = 0;
  AddControlPointColumns(span, basis);
  if (moves_knots) AddKnotColumns(span, t, knots);

  double residual[kMaxDimension];
  double tangent[kMaxDimension] = {};
  double squared = 0.0;
  double squared_speed = 0.0;
  for (int c = 0; c < d; ++c) {
    residual[c] = -q[c];
    for (int j = 0; j <= p; ++j) {
      residual[c] += basis[j] * curve_->ControlPoint(span - p + j)[c];
      tangent[c] += basis[p + 1 + j] * curve_->ControlPoint(span - p + j)[c];
    }
    squared += residual[c] * residual[c];
    squared_speed += tangent[c] * tangent[c];
  }
  const double weight = Raised(squared / squared_bound, power - 2) / squared_bound;
  // A foot slides along the curve, but not past its end.
  const bool at_end =
      !curve_->closed() && (t <= curve_->domain_begin() || t >= curve_->domain_end());
  const double along = !slides || at_end || !(squared_speed > 0.0) ? 0.0 : weight / squared_speed;
  const double across = (power - 2) * weight / (squared + kFloor * squared_bound);
  double metric[kMaxDimension * kMaxDimension];
  double slope[kMaxDimension];
  for (int a = 0; a < d; ++a) {
    slope[a] = weight * residual[a];
    for (int b = 0; b < d; ++b) {
      metric[a * d + b] = (a == b ? weight : 0.0) - along * tangent[a] * tangent[b] +
                          across * residual[a] * residual[b];
    }
  }
  AddRow(metric, slope);
}

void CurveWindow::AddRow(const double* metric, const double* slope) {
  const int d = curve_->dimension();
  const int width = hessian_->width();
  const int size = hessian_->size();
  double* const band = hessian_->band().data();
  for (int a = 0; a < num_columns_; ++a) {
    const int column = ((columns_[a] % size) + size) % size;
    double product[kMaxDimension];
    for (int c = 0; c < d; ++c) {
      product[c] = 0.0;
      for (int e = 0; e < d; ++e) product[c] += metric[c * d + e] * entries_[a][e];
      gradient_[column] += slope[c] * entries_[a][c];
    }
    double* const row = band + static_cast<std::ptrdiff_t>(column) * width;
    for (int b = 0; b < num_columns_; ++b) {
      const int offset = columns_[b] - columns_[a];
      if (offset < 0) continue;
      double sum = 0.0;
      for (int c = 0; c < d; ++c) sum += product[c] * entries_[b][c];
      row[offset] += sum;
    }
  }
}

void CurveWindow::Assemble(int power, bool at_parameters) {
  const int p = curve_->degree();
  const int half = (p + 1) / 2;
  RowShape shape;
  const int stride = curve_->dimension() + 1;
  shape.num_columns = count_ * stride;
  // From control point k - p or knot k - p + 1 to control point k or knot k + p.
  shape.width = (std::max(p - half, 0) - std::min(-p, 1 - p - half) + 1) * stride;
  if (!holds_all_) shape.width = std::min(shape.width, shape.num_columns);
  shape.dimension = 1;
  shape.cyclic = holds_all_;
  hessian_.emplace(shape);
  gradient_.setZero(shape.num_columns);
  for (const int i : points_) {
    AddPoint(curve_->parameter(i), curve_->point(i), squared_bound_, power, !at_parameters,
             !at_parameters);
  }
  for (const Sample& sample : Samples()) {
    AddPoint(sample.t, sample.target, sample.squared_bound, power, false, !at_parameters);
  }
}

bool CurveWindow::SolveDamped(double damping, const std::vector<int>& held,
                              Eigen::VectorXd* step) const {
  NormalBand matrix = *hessian_;
  const int stride = curve_->dimension() + 1;
  const int width = matrix.width();
  const auto entry = [&](int i) -> double& {
    return matrix.band()[static_cast<std::size_t>(i) * static_cast<std::size_t>(width)];
  };
  double largest[2] = {0.0, 0.0};  // of control points, of knots
  for (int i = 0; i < matrix.size(); ++i) {
    double& scale = largest[i % stride == stride - 1 ? 1 : 0];
    scale = std::max(scale, entry(i));
  }
  // Directions that no data point holds stay where they are.
  constexpr double kLeast = 1e-4;
  for (int i = 0; i < matrix.size(); ++i) {
    const double scale = largest[i % stride == stride - 1 ? 1 : 0];
    entry(i) += damping * (entry(i) + kLeast * scale) + 1e-12 * scale;
    if (!(entry(i) > 0.0)) entry(i) = 1.0;
  }
  for (const int i : held) entry(i) += 1e12 * largest[1];
  BandedCholesky factor;
  if (!factor.Factor(matrix)) return false;
  *step = -gradient_;
  factor.Solve(step->data(), 1);
  return step->allFinite();
}

void CurveWindow::Apply(const Eigen::VectorXd& step) {
  const int d = curve_->dimension();
  for (int j = 0; j < count_; ++j) {
    double* const point = curve_->MutableControlPoint(first_ + j);
    for (int c = 0; c < d; ++c) point[c] += step[j * (d + 1) + c];
  }
  std::vector<double> moves;
  for (int k = 0; k < num_knots_; ++k) {
    const auto [down, up] = KnotRoom(k);
    moves.push_back(std::clamp(step[KnotUnknown(k)], -down, up));
  }
  for (int k = 0; k < num_knots_; ++k) {
    curve_->MoveKnot(first_knot_ + k, moves[static_cast<std::size_t>(k)]);
  }
}

int CurveWindow::KnotUnknown(int k) const {
  int place = first_knot_ + k - (curve_->degree() + 1) / 2 - first_;
  if (holds_all_) place = ((place % count_) + count_) % count_;
  return place * (curve_->dimension() + 1) + curve_->dimension();
}

std::pair<double, double> CurveWindow::KnotRoom(int k) const {
  // Both sides of a gap together leave a quarter of it, and more than the least gap.
  const double least = 1e-3 * curve_->period() / std::max(curve_->num_control_points(), 8);
  const auto room = [&](int left) {
    const double gap = curve_->Knot(left + 1) - curve_->Knot(left);
    return 0.5 * std::max(0.0, std::min(0.75 * gap, gap - least));
  };
  return {room(first_knot_ + k - 1), room(first_knot_ + k)};
}

bool CurveWindow::FindStep(double damping, Eigen::VectorXd* step) const {
  std::vector<int> held;
  constexpr int kMostRounds = 3;
  for (int round = 0; round < kMostRounds; ++round) {
    if (!SolveDamped(damping, held, step)) return false;
    const std::size_t before = held.size();
    for (int k = 0; k < num_knots_; ++k) {
      const int i = KnotUnknown(k);
      const auto [down, up] = KnotRoom(k);
      const double wanted = (*step)[i];
      // A step that is cut by more than a half would no longer fit to the others.
      if (wanted > 2.0 * up || -wanted > 2.0 * down) held.push_back(i);
    }
    if (held.size() == before) break;
  }
  return true;
}

}  // namespace batten
