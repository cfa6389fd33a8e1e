#include "solvers/foot_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/foot_model_kernel.h"

namespace batten {
namespace {

RowShape BlockBandShape(const FreeView& view) {
  const BsplineBasis& basis = *view.sites().basis;
  RowShape shape;
  shape.num_rows = 0;
  shape.num_columns = basis.num_control_points() * view.dimension();
  shape.width = basis.order() * view.dimension();
  shape.dimension = 1;
  shape.cyclic = basis.periodic();
  return shape;
}

// Below so many points a thread costs more than it saves.
constexpr int kPointsWorthAThread = 20'000;

}  // namespace

FootModel::FootModel(const FreeView& view, int threads)
    : view_(view),
      sites_(view.sites()),
      basis_(*view.sites().basis),
      workers_(std::max(1, std::min(threads, view.num_points() / kPointsWorthAThread))),
      order_(basis_.order()),
      dimension_(view.dimension()),
      local_(order_ * dimension_),
      band_(BlockBandShape(view)),
      damped_(BlockBandShape(view)),
      diagonal_(static_cast<std::size_t>(basis_.num_control_points()) * dimension_),
      added_(diagonal_.size()),
      curved_terms_(view),
      half_gradient_(band_.size()),
      map_(view.control_point_map()) {
  if (map_ != nullptr) {
    free_band_ = SubstitutedBand(BlockBandShape(view), dimension_, map_);
    free_half_gradient_.resize(map_->cols());
    free_step_.resize(map_->cols());
  }
  const auto m = static_cast<std::size_t>(view.num_points());
  const auto spans = static_cast<std::size_t>(basis_.num_domain_spans());
  const auto k = static_cast<std::size_t>(order_);
  const auto local = static_cast<std::size_t>(local_);
  middles_.resize(spans);
  coefficients_.resize(spans * k * k);
  curve_.resize(spans * local);
  found_runs_.reserve(m);
  runs_.reserve(m);
  wrapped_.resize(m);
  moves_.assign(m, 1.0);
  for (int i = 0; i < view.num_points(); ++i) {
    if (view.is_held(i)) moves_[i] = 0.0;
  }
  has_held_ = std::find(moves_.begin(), moves_.end(), 0.0) != moves_.end();
  span_begins_.resize(spans + 1);
  span_runs_.resize(spans + 1);
  span_sums_.resize(spans * SpanStride());
  span_energies_.resize(spans);
  span_decreases_.resize(spans);
  shares_.resize(static_cast<std::size_t>(workers_.num_threads()) + 1);
  if (has_loss()) {
    robust_weights_.resize(m);
    loss_bends_.resize(m);
  }
  weights_ = has_loss() ? robust_weights_.data() : sites_.weights.data();
  PrepareSpans();
  for (Eigen::Index i = 0; i < sites_.weights.size(); ++i) {
    scale_ += sites_.weights[i] * sites_.points.row(i).squaredNorm();
  }
}

template <typename Body>
void FootModel::ForEachShare(Body body) {
  workers_.Run([&body, this](int k) {
    for (int s = shares_[k]; s < shares_[k + 1]; ++s) body(s);
  });
}

template <typename Body>
void FootModel::WithKernel(Body body) {
  if (order_ == 4 && dimension_ == 2) return body(Kernel<3, 2>{{*this}});
  if (order_ == 4 && dimension_ == 3) return body(Kernel<3, 3>{{*this}});
  if (order_ == 3 && dimension_ == 2) return body(Kernel<2, 2>{{*this}});
  body(Kernel<-1, -1>{{*this}});
}

bool FootModel::Sum(const Eigen::VectorXd& x, FootModelKind kind, double damping) {
  kind_ = kind;
  damping_ = damping;
  const double* control_points = x.data() + sites_.control_point_offset;
  PrepareCurve(control_points);
  SortBySpan(x.data() + sites_.parameter_offset);
  WithKernel([&](const auto& kernel) {
    ForEachShare([&](int span) {
      const double robust_energy = has_loss() ? WeighSpan(span) : 0.0;
      kernel.SumSpan(span);
      if (has_loss()) span_energies_[span] = robust_energy;
    });
  });
  AssembleBand();
  energy_ = 0.0;
  for (const double part : span_energies_) energy_ += part;
  AddOtherTerms(control_points);
  const bool exact = kind == FootModelKind::kNewton;
  if (!curved_terms_.AddTo(x, exact, &energy_, &half_gradient_, &band_, &diagonal_)) return false;
  if (map_ != nullptr) free_half_gradient_.noalias() = map_->transpose() * half_gradient_;
  return std::isfinite(energy_) && half_gradient_.allFinite();
}

void FootModel::AddOtherTerms(const double* control_points) {
  const NormalBand* other = view_.other_terms();
  if (other == nullptr) return;
  const int n = basis_.num_control_points(), d = dimension_;
  Points& residual = other_residual_;
  residual.resize(n, d);
  other->NormalResidual(control_points, residual.data());
  const Eigen::Map<const Points> at(control_points, n, d);
  // |A P - B|^2 = |B|^2 - P'(A'B) - P'(A'B - A'A P)
  energy_ += other->squared_norm_of_data() - at.cwiseProduct(other->right_hand_side()).sum() -
             at.cwiseProduct(residual).sum();
  half_gradient_ -= Eigen::Map<const Eigen::VectorXd>(residual.data(), residual.size());
  for (int j = 0; j < n; ++j) {
    for (int l = 0; l < other->width(); ++l) {
      const double entry = other->band()[static_cast<std::size_t>(j) * other->width() + l];
      for (int e = 0; e < d; ++e) {
        band_.band()[static_cast<std::size_t>(j * d + e) * band_.width() + l * d] += entry;
        if (l == 0) diagonal_[static_cast<std::size_t>(j * d + e)] += entry;
      }
    }
  }
}

void FootModel::AssembleBand() {
  const int k = order_, d = dimension_, size = local_;
  std::fill(band_.band().begin(), band_.band().end(), 0.0);
  std::fill(diagonal_.begin(), diagonal_.end(), 0.0);
  half_gradient_.setZero();
  for (int s = 0; s < basis_.num_domain_spans(); ++s) {
    const double* sums = SpanSums(s);
    const int first = basis_.first_span() + s - basis_.degree();
    for (int j = 0; j < k; ++j) {
      const int index = basis_.ControlPointIndex(first + j);
      for (int e = 0; e < d; ++e) {
        const int row = j * d + e;
        double* band = &band_.band()[static_cast<std::size_t>(index * d + e) * band_.width()];
        for (int column = row; column < size; ++column) {
          band[column - row] += sums[row * size + column];
        }
        half_gradient_[index * d + e] += sums[size * size + row];
        diagonal_[static_cast<std::size_t>(index * d + e)] += sums[size * size + size + j];
      }
    }
  }
}

bool FootModel::Factor(double damping) {
  damped_ = band_;
  double mean = 0.0;
  for (const double entry : diagonal_) mean += std::abs(entry);
  mean /= static_cast<double>(diagonal_.size());
  // Control points without data have no diagonal of their own.
  constexpr double kLeast = 1e-3;
  for (std::size_t k = 0; k < diagonal_.size(); ++k) {
    added_[k] = damping * std::max(diagonal_[k], kLeast * mean);
    damped_.band()[k * static_cast<std::size_t>(damped_.width())] += added_[k];
  }
  if (map_ == nullptr) return cholesky_.Factor(damped_);
  free_band_.Sum(damped_);
  return free_step_.size() == 0 || cholesky_.Factor(free_band_.band());
}

bool FootModel::FactorSingular(double damping) {
  // What the model does not see stays where it is.
  constexpr double kLeast = 64.0 * std::numeric_limits<double>::epsilon();
  constexpr int kMostTries = 9;
  damping = std::max(damping, kLeast);
  for (int tried = 0; tried < kMostTries; ++tried, damping *= 100.0) {
    if (Factor(damping)) return true;
  }
  return false;
}

void FootModel::Solve(Eigen::VectorXd* step) {
  if (map_ == nullptr) {
    *step = -half_gradient_;
    cholesky_.Solve(step->data(), 1);
    return;
  }
  free_step_ = -free_half_gradient_;
  if (free_step_.size() > 0) cholesky_.Solve(free_step_.data(), 1);
  Expand(free_step_, step);
}

void FootModel::LeastDirection(Eigen::VectorXd* step) {
  // The factored matrix is barely positive definite: a few solves are enough.
  constexpr int kSolves = 4;
  const Eigen::VectorXd& gradient = free_half_gradient();
  Eigen::VectorXd y(gradient.size());
  // Of no symmetry that a curve may have.
  for (Eigen::Index k = 0; k < y.size(); ++k) y[k] = std::sin(1.7 * static_cast<double>(k) + 0.3);
  for (int solve = 0; solve < kSolves; ++solve) {
    if (y.size() > 0) cholesky_.Solve(y.data(), 1);
    y.normalize();
  }
  if (gradient.dot(y) > 0.0) y = -y;
  Expand(y, step);
}

void FootModel::Expand(const Eigen::VectorXd& y, Eigen::VectorXd* step) const {
  if (map_ == nullptr) {
    *step = y;
  } else {
    step->noalias() = *map_ * y;
  }
}

std::vector<double> FootModel::RowSums() {
  if (map_ == nullptr) return band_.AbsoluteRowSums();
  free_band_.Sum(band_);
  return free_band_.band().AbsoluteRowSums();
}

void FootModel::ImproveFeet(int steps, Eigen::VectorXd* x) {
  PrepareCurve(x->data() + sites_.control_point_offset);
  double* parameters = x->data() + sites_.parameter_offset;
  SortBySpan(parameters);
  WithKernel([&](const auto& kernel) {
    ForEachShare([&](int span) { kernel.ImproveSpan(span, steps, parameters); });
  });
  LeaveEnds(parameters);
}

void FootModel::LeaveEnds(double* parameters) const {
  if (basis_.periodic()) return;
  for (int i = 0; i < view_.num_points(); ++i) {
    if (!view_.is_held(i)) parameters[i] = PastTheEnd(basis_, parameters[i]);
  }
}

double FootModel::Move(const Eigen::VectorXd& x, const Eigen::VectorXd& step,
                       Eigen::VectorXd* next) {
  if (moves_all()) {
    // The parameters, mostly the larger part, are written span by span.
    next->resize(x.size());
    const Eigen::Index first = sites_.parameter_offset, behind = first + view_.num_points();
    next->head(first) = x.head(first);
    next->tail(x.size() - behind) = x.tail(x.size() - behind);
  } else {
    *next = x;
  }
  next->segment(sites_.control_point_offset, step.size()) += step;
  double* parameters = next->data() + sites_.parameter_offset;
  // The x that was summed may be elsewhere by now.
  if (parameters_ != wrapped_.data()) parameters_ = x.data() + sites_.parameter_offset;
  WithKernel([&](const auto& kernel) {
    ForEachShare([&](int span) { kernel.MoveSpan(span, step.data(), parameters); });
  });
  LeaveEnds(parameters);
  // With D the damping, (H + D) s = -g of control points and parameters together, so that E falls
  // by -2 g's - s'H s = -g's + s'D s; g's is that of the reduced model less w along^2 / denominator
  // of every parameter.
  double decrease = -half_gradient_.dot(step);
  for (const double part : span_decreases_) decrease += part;
  for (std::size_t k = 0; k < added_.size(); ++k) {
    const double moved = step[static_cast<Eigen::Index>(k)];
    decrease += added_[k] * moved * moved;
  }
  return decrease;
}

}  // namespace batten
