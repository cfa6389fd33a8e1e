#ifndef BATTEN_SOLVERS_FOOT_MODEL_KERNEL_H_
#define BATTEN_SOLVERS_FOOT_MODEL_KERNEL_H_

// Included by foot_model.cc alone.

#include <algorithm>
#include <limits>

#include "solvers/foot_model.h"

namespace batten {

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

  /// Newton steps on f = |C(t) - Q|^2 of the span's points, inside the span.
  void ImproveSpan(int span, int steps, double* parameters) const {
    const int d = dimension();
    const double low = model.basis_.knots()[model.basis_.first_span() + span];
    const double high = model.basis_.knots()[model.basis_.first_span() + span + 1];
    AtPoint at;
    for (int place = model.span_begins_[span]; place < model.span_begins_[span + 1]; ++place) {
      const int i = model.order_of_points_[place];
      if (model.moves_[i] == 0) continue;
      double t = model.places_[i];
      double best = std::numeric_limits<double>::infinity();
      for (int step = 0; step <= steps; ++step) {
        Evaluate(span, t, &model.sites_.points(i, 0), &at);
        double f = 0.0, along = 0.0, speed = 0.0, bend = 0.0;
        for (int e = 0; e < d; ++e) {
          f += at.r[e] * at.r[e];
          along += at.r[e] * at.first[e];
          speed += at.first[e] * at.first[e];
          bend += at.r[e] * at.second[e];
        }
        if (!(f < best)) break;
        best = f;
        parameters[i] = t;
        constexpr double kLeast = 0.1;
        const double denominator = std::max(speed + bend, kLeast * speed);
        if (!(denominator > 0.0)) break;
        t = std::clamp(t - along / denominator, low, high);
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

}  // namespace batten

#endif  // BATTEN_SOLVERS_FOOT_MODEL_KERNEL_H_
