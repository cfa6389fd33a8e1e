#include "solvers/foot_model.h"

#include <algorithm>
#include <cmath>
#include <thread>

#include "splines/basis_functions.h"

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

/// The passes over points, for one pair of sizes; P and D are -1 where they are known at run time
/// only.
template <int P, int D>
struct FootModel::Kernel {
  static constexpr bool kStatic = P >= 0;
  static constexpr int kOrder = kStatic ? P + 1 : kMaxOrder;
  static constexpr int kDimension = kStatic ? D : kMaxDimension;

  FootModel& model;
  int order() const { return kStatic ? P + 1 : model.order_; }
  int dimension() const { return kStatic ? D : model.dimension_; }

  struct AtPoint {
    double basis[kOrder];
    double slope[kOrder];  // of the basis
    double r[kDimension];
    double first[kDimension];
    double second[kDimension];
  };

  void Evaluate(int span, double t, const double* q, AtPoint* at) const {
    const int k = order(), d = dimension();
    const double u = t - model.middles_[span];
    const double* c = &model.coefficients_[static_cast<std::size_t>(span) * k * k];
    for (int j = 0; j < k; ++j) {
      at->basis[j] = c[(k - 1) * k + j];
      at->slope[j] = 0.0;
    }
    for (int power = k - 2; power >= 0; --power) {
      for (int j = 0; j < k; ++j) {
        at->slope[j] = at->slope[j] * u + at->basis[j];
        at->basis[j] = at->basis[j] * u + c[power * k + j];
      }
    }
    const double* curve = &model.curve_[static_cast<std::size_t>(span) * k * d];
    for (int e = 0; e < d; ++e) {
      double value = curve[(k - 1) * d + e], first = 0.0, second = 0.0;
      for (int power = k - 2; power >= 0; --power) {
        second = second * u + first;
        first = first * u + value;
        value = value * u + curve[power * d + e];
      }
      at->r[e] = value - q[e];
      at->first[e] = first;
      at->second[e] = 2.0 * second;
    }
  }

  /// The factor a of g g' over w, and what the parameter's step needs.
  double Eliminate(const AtPoint& at, double weight, int i, PointState* state) const {
    const int d = dimension();
    double speed = 0.0, bend = 0.0;
    state->along = 0.0;
    for (int e = 0; e < d; ++e) {
      speed += at.first[e] * at.first[e];
      bend += at.r[e] * at.second[e];
      state->along += at.first[e] * at.r[e];
    }
    state->denominator = state->scale = 0.0;
    // Pressed against an end of the domain it stays there.
    const double t = model.places_[i];
    const bool is_pressed =
        !model.basis_.periodic() && ((t <= model.basis_.domain_begin() && state->along > 0.0) ||
                                     (t >= model.basis_.domain_end() && state->along < 0.0));
    const bool stays = model.kind_ == FootModelKind::kPoint || model.moves_[i] == 0 || is_pressed ||
                       !(speed > 0.0);
    if (stays) return 0.0;
    double denominator = (1.0 + model.damping_) * speed;
    if (model.kind_ == FootModelKind::kCurvature) {
      denominator = std::max(speed, speed + bend);
    } else if (model.kind_ == FootModelKind::kNewton) {
      // Where f'' is not positive, t is at no minimum: Gauss and Newton's denominator leads to one.
      constexpr double kLeast = 1e-3;
      if (speed + bend > kLeast * speed) denominator += bend;
    }
    state->denominator = denominator;
    state->scale = weight * model.damping_ * speed;
    return 1.0 / denominator;
  }

  void SumSpan(int span) const {
    const int k = order(), d = dimension(), size = k * d;
    double* sums = model.SpanSums(span);
    std::fill(sums, sums + model.SpanStride(), 0.0);
    double* gradient = sums + size * size;
    double* diagonal = gradient + size;
    const bool is_newton = model.kind_ == FootModelKind::kNewton;
    double energy = 0.0;
    AtPoint at;
    for (int place = model.span_begins_[span]; place < model.span_begins_[span + 1]; ++place) {
      const int i = model.order_of_points_[place];
      const double w = model.sites_.weights[i];
      Evaluate(span, model.places_[i], &model.sites_.points(i, 0), &at);
      PointState& state = model.states_[i];
      const double a = Eliminate(at, w, i, &state);
      for (int e = 0; e < d; ++e) energy += w * at.r[e] * at.r[e];
      for (int j = 0; j < k; ++j) diagonal[j] += w * at.basis[j] * at.basis[j];
      if (is_newton) {
        AddNewton(at, w, a, state.along, sums, gradient);
      } else {
        AddTangent(at, w, a, state.along, sums, gradient);
      }
    }
    model.span_energies_[span] = energy;
  }

  void AddTangent(const AtPoint& at, double w, double a, double along, double* sums,
                  double* gradient) const {
    const int k = order(), d = dimension(), size = k * d;
    double m[kDimension][kDimension];
    double v[kDimension];
    for (int e = 0; e < d; ++e) {
      for (int f = 0; f < d; ++f) m[e][f] = -w * a * at.first[e] * at.first[f];
      m[e][e] += w;
      v[e] = w * (at.r[e] - a * along * at.first[e]);
    }
    for (int j = 0; j < k; ++j) {
      for (int e = 0; e < d; ++e) gradient[j * d + e] += at.basis[j] * v[e];
      for (int l = j; l < k; ++l) {
        const double product = at.basis[j] * at.basis[l];
        for (int e = 0; e < d; ++e) {
          for (int f = 0; f < d; ++f) sums[(j * d + e) * size + l * d + f] += product * m[e][f];
        }
      }
    }
  }

  void AddNewton(const AtPoint& at, double w, double a, double along, double* sums,
                 double* gradient) const {
    const int k = order(), d = dimension(), size = k * d;
    double g[kOrder * kDimension];
    for (int j = 0; j < k; ++j) {
      for (int e = 0; e < d; ++e) {
        g[j * d + e] = at.basis[j] * at.first[e] + at.slope[j] * at.r[e];
        gradient[j * d + e] += w * (at.basis[j] * at.r[e] - a * along * g[j * d + e]);
      }
    }
    for (int x = 0; x < size; ++x) {
      const double factor = -w * a * g[x];
      for (int y = x; y < size; ++y) sums[x * size + y] += factor * g[y];
    }
    for (int j = 0; j < k; ++j) {
      for (int l = j; l < k; ++l) {
        const double product = w * at.basis[j] * at.basis[l];
        for (int e = 0; e < d; ++e) sums[(j * d + e) * size + l * d + e] += product;
      }
    }
  }

  /// Parameters' steps of one span, and what they lower the model by.
  void MoveSpan(int span, const double* step, double* parameters) const {
    const int k = order(), d = dimension();
    const BsplineBasis& basis = model.basis_;
    double window[kOrder * kDimension];
    for (int j = 0; j < k; ++j) {
      const int index = basis.ControlPointIndex(basis.first_span() + span - basis.degree() + j);
      for (int e = 0; e < d; ++e) window[j * d + e] = step[index * d + e];
    }
    const bool is_newton = model.kind_ == FootModelKind::kNewton;
    double decrease = 0.0;
    AtPoint at;
    for (int place = model.span_begins_[span]; place < model.span_begins_[span + 1]; ++place) {
      const int i = model.order_of_points_[place];
      const PointState& state = model.states_[i];
      if (state.denominator == 0.0) continue;
      Evaluate(span, model.places_[i], &model.sites_.points(i, 0), &at);
      double product = 0.0;
      for (int j = 0; j < k; ++j) {
        for (int e = 0; e < d; ++e) {
          double g = at.basis[j] * at.first[e];
          if (is_newton) g += at.slope[j] * at.r[e];
          product += g * window[j * d + e];
        }
      }
      const double move = -(state.along + product) / state.denominator;
      parameters[i] = model.places_[i] + move;
      decrease += model.sites_.weights[i] * state.along * state.along / state.denominator +
                  state.scale * move * move;
    }
    model.span_decreases_[span] = decrease;
  }
};

FootModel::FootModel(const FreeView& view, int threads)
    : view_(view),
      sites_(view.sites()),
      basis_(*view.sites().basis),
      threads_(std::max(1, std::min(threads, view.num_points() / kPointsWorthAThread))),
      order_(basis_.order()),
      dimension_(view.dimension()),
      local_(order_ * dimension_),
      band_(BlockBandShape(view)),
      damped_(BlockBandShape(view)),
      diagonal_(static_cast<std::size_t>(basis_.num_control_points())),
      added_(diagonal_.size()),
      half_gradient_(band_.size()) {
  const auto m = static_cast<std::size_t>(view.num_points());
  const auto spans = static_cast<std::size_t>(basis_.num_domain_spans());
  const auto k = static_cast<std::size_t>(order_);
  const auto local = static_cast<std::size_t>(local_);
  middles_.resize(spans);
  coefficients_.resize(spans * k * k);
  curve_.resize(spans * local);
  span_of_.resize(m);
  places_.resize(m);
  moves_.resize(m);
  order_of_points_.resize(m);
  states_.resize(m);
  span_begins_.resize(spans + 1);
  span_sums_.resize(spans * SpanStride());
  span_energies_.resize(spans);
  span_decreases_.resize(spans);
  shares_.resize(static_cast<std::size_t>(threads_) + 1);
  PrepareSpans();
  for (Eigen::Index i = 0; i < sites_.weights.size(); ++i) {
    scale_ += sites_.weights[i] * sites_.points.row(i).squaredNorm();
  }
}

/// Taylor's coefficients of the basis functions in the middle of each span.
void FootModel::PrepareSpans() {
  const int k = order_;
  double values[kMaxOrder * kMaxOrder];
  for (int s = 0; s < basis_.num_domain_spans(); ++s) {
    const int span = basis_.first_span() + s;
    const double low = basis_.knots()[span], high = basis_.knots()[span + 1];
    middles_[s] = low + 0.5 * (high - low);
    if (!(low < high)) continue;
    EvaluateBasisDerivatives(basis_.degree(), basis_.knots().data(), span, middles_[s], k - 1,
                             values);
    double factorial = 1.0;
    for (int power = 0; power < k; ++power) {
      if (power > 0) factorial *= power;
      for (int j = 0; j < k; ++j) {
        coefficients_[(static_cast<std::size_t>(s) * k + power) * k + j] =
            values[power * k + j] / factorial;
      }
    }
  }
}

void FootModel::PrepareCurve(const double* control_points) {
  const int k = order_, d = dimension_;
  for (int s = 0; s < basis_.num_domain_spans(); ++s) {
    double* curve = &curve_[static_cast<std::size_t>(s) * k * d];
    const double* c = &coefficients_[static_cast<std::size_t>(s) * k * k];
    std::fill(curve, curve + k * d, 0.0);
    for (int j = 0; j < k; ++j) {
      const int index = basis_.ControlPointIndex(basis_.first_span() + s - basis_.degree() + j);
      for (int power = 0; power < k; ++power) {
        for (int e = 0; e < d; ++e) {
          curve[power * d + e] += c[power * k + j] * control_points[index * d + e];
        }
      }
    }
  }
}

/// Counting sort; of points in one span the order stays.
void FootModel::SortBySpan(const double* parameters) {
  std::fill(span_begins_.begin(), span_begins_.end(), 0);
  const int m = view_.num_points();
  int span = basis_.first_span();
  for (int i = 0; i < m; ++i) {
    const double t = basis_.Wrap(parameters[i]);
    span = basis_.FindSpanFrom(span, t);
    places_[i] = t;
    moves_[i] = !view_.is_held(i) && (basis_.periodic() || t == parameters[i]) ? 1 : 0;
    span_of_[i] = span - basis_.first_span();
    ++span_begins_[static_cast<std::size_t>(span_of_[i]) + 1];
  }
  for (std::size_t s = 1; s < span_begins_.size(); ++s) span_begins_[s] += span_begins_[s - 1];
  for (int i = 0; i < m; ++i) {
    order_of_points_[static_cast<std::size_t>(span_begins_[span_of_[i]]++)] = i;
  }
  for (std::size_t s = span_begins_.size() - 1; s > 0; --s) span_begins_[s] = span_begins_[s - 1];
  span_begins_[0] = 0;
  ShareSpans();
}

/// Whole spans to each thread, with about as many points.
void FootModel::ShareSpans() {
  const int spans = basis_.num_domain_spans();
  for (int k = 0; k <= threads_; ++k) {
    const auto target = static_cast<int>(static_cast<double>(view_.num_points()) * k / threads_);
    const auto found = std::lower_bound(span_begins_.begin(), span_begins_.end() - 1, target);
    shares_[k] = k == threads_ ? spans : static_cast<int>(found - span_begins_.begin());
  }
  shares_[0] = 0;
}

template <typename Body>
void FootModel::ForEachShare(Body body) {
  std::vector<std::thread> others;
  for (int k = 1; k < threads_; ++k) {
    others.emplace_back([&body, this, k] {
      for (int s = shares_[k]; s < shares_[k + 1]; ++s) body(s);
    });
  }
  for (int s = shares_[0]; s < shares_[1]; ++s) body(s);
  for (std::thread& other : others) other.join();
}

template <typename Body>
void FootModel::WithKernel(Body body) {
  if (order_ == 4 && dimension_ == 2) return body(Kernel<3, 2>{*this});
  if (order_ == 4 && dimension_ == 3) return body(Kernel<3, 3>{*this});
  if (order_ == 3 && dimension_ == 2) return body(Kernel<2, 2>{*this});
  body(Kernel<-1, -1>{*this});
}

bool FootModel::Sum(const Eigen::VectorXd& x, FootModelKind kind, double damping) {
  kind_ = kind;
  damping_ = damping;
  const double* control_points = x.data() + sites_.control_point_offset;
  PrepareCurve(control_points);
  SortBySpan(x.data() + sites_.parameter_offset);
  WithKernel(
      [&](const auto& kernel) { ForEachShare([&kernel](int span) { kernel.SumSpan(span); }); });
  AssembleBand();
  energy_ = 0.0;
  for (const double part : span_energies_) energy_ += part;
  if (const NormalBand* other = view_.other_terms()) {
    const int n = basis_.num_control_points(), d = dimension_;
    Points residual(n, d);
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
        }
      }
      diagonal_[static_cast<std::size_t>(j)] +=
          other->band()[static_cast<std::size_t>(j) * other->width()];
    }
  }
  return std::isfinite(energy_) && half_gradient_.allFinite();
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
      }
      diagonal_[static_cast<std::size_t>(index)] += sums[size * size + size + j];
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
  for (int j = 0; j < basis_.num_control_points(); ++j) {
    const double added = damping * std::max(diagonal_[static_cast<std::size_t>(j)], kLeast * mean);
    added_[static_cast<std::size_t>(j)] = added;
    for (int e = 0; e < dimension_; ++e) {
      damped_.band()[static_cast<std::size_t>(j * dimension_ + e) * damped_.width()] += added;
    }
  }
  return cholesky_.Factor(damped_);
}

void FootModel::Solve(Eigen::VectorXd* step) const {
  *step = -half_gradient_;
  cholesky_.Solve(step->data(), 1);
}

double FootModel::Move(const Eigen::VectorXd& x, const Eigen::VectorXd& step,
                       Eigen::VectorXd* next) {
  *next = x;
  next->segment(sites_.control_point_offset, step.size()) += step;
  double* parameters = next->data() + sites_.parameter_offset;
  WithKernel([&](const auto& kernel) {
    ForEachShare([&](int span) { kernel.MoveSpan(span, step.data(), parameters); });
  });
  if (!basis_.periodic()) {
    for (int i = 0; i < view_.num_points(); ++i) parameters[i] = basis_.Wrap(parameters[i]);
  }
  // With D the damping, (H + D) s = -g of control points and parameters together, so that E falls
  // by -2 g's - s'H s = -g's + s'D s; g's is that of the reduced model less w along^2 / denominator
  // of every parameter.
  double decrease = -half_gradient_.dot(step);
  for (const double part : span_decreases_) decrease += part;
  for (std::size_t j = 0; j < added_.size(); ++j) {
    const auto place = static_cast<Eigen::Index>(j) * dimension_;
    decrease += added_[j] * step.segment(place, dimension_).squaredNorm();
  }
  return decrease;
}

}  // namespace batten
