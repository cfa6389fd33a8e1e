#include <algorithm>

#include "solvers/foot_model.h"
#include "splines/basis_functions.h"

// How the model sees the curve and the points, span by span.

namespace batten {

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

void FootModel::CurveOfSpan(int span, const double* control_points, double* curve) const {
  const int k = order_, d = dimension_;
  const double* c = &coefficients_[static_cast<std::size_t>(span) * k * k];
  std::fill(curve, curve + k * d, 0.0);
  for (int j = 0; j < k; ++j) {
    const int index = basis_.ControlPointIndex(basis_.first_span() + span - basis_.degree() + j);
    for (int power = 0; power < k; ++power) {
      for (int e = 0; e < d; ++e) {
        curve[power * d + e] += c[power * k + j] * control_points[index * d + e];
      }
    }
  }
}

void FootModel::PrepareCurve(const double* control_points) {
  for (int s = 0; s < basis_.num_domain_spans(); ++s) {
    CurveOfSpan(s, control_points, &curve_[static_cast<std::size_t>(s) * local_]);
  }
  constexpr double kLeast = 1e-3;  // of the mean of |C'|^2 in the middles of the spans
  double sum = 0.0;
  int count = 0;
  for (int s = 0; s < basis_.num_domain_spans(); ++s) {
    const auto k = static_cast<std::size_t>(basis_.first_span() + s);
    if (!(basis_.knots()[k] < basis_.knots()[k + 1])) continue;
    ++count;
    const double* derivative = &curve_[static_cast<std::size_t>(s) * local_ + dimension_];
    for (int e = 0; e < dimension_; ++e) sum += derivative[e] * derivative[e];
  }
  least_speed_ = kLeast * sum / count;
}

/// Counting sort of runs of neighbours in one span; of points in one span the order stays.
void FootModel::SortBySpan(const double* parameters) {
  FindRuns(parameters);
  std::fill(span_begins_.begin(), span_begins_.end(), 0);
  std::fill(span_runs_.begin(), span_runs_.end(), 0);
  for (const Run& run : found_runs_) {
    span_begins_[static_cast<std::size_t>(run.span) + 1] += run.end - run.begin;
    ++span_runs_[static_cast<std::size_t>(run.span) + 1];
  }
  for (std::size_t s = 1; s < span_begins_.size(); ++s) {
    span_begins_[s] += span_begins_[s - 1];
    span_runs_[s] += span_runs_[s - 1];
  }
  runs_.resize(found_runs_.size());
  for (const Run& run : found_runs_) runs_[span_runs_[run.span]++] = run;
  for (std::size_t s = span_runs_.size() - 1; s > 0; --s) span_runs_[s] = span_runs_[s - 1];
  span_runs_[0] = 0;
  ShareSpans();
}

/// Parameters into the domain, and where neighbours are in different spans.
void FootModel::FindRuns(const double* parameters) {
  found_runs_.clear();
  parameters_ = parameters;
  int span = basis_.first_span();
  double low = 1.0, high = 0.0;  // no t is in
  for (int i = 0; i < view_.num_points(); ++i) {
    const double t = parameters[i];
    if (t >= low && t < high) continue;
    const double inside = basis_.Wrap(t);
    if (inside != t) {
      if (parameters_ != wrapped_.data()) std::copy_n(parameters, wrapped_.size(), &wrapped_[0]);
      parameters_ = wrapped_.data();
      wrapped_[i] = inside;
    }
    const int found = basis_.FindSpanFrom(span, inside);
    if (!found_runs_.empty()) {
      if (found == span) continue;
      found_runs_.back().end = i;
    }
    found_runs_.push_back({found - basis_.first_span(), i, view_.num_points()});
    span = found;
    low = basis_.knots()[span];
    high = basis_.knots()[span + 1];
  }
}

/// What a loss makes of the weights of a span's points. Returns their energy.
double FootModel::WeighSpan(int span) {
  const int k = order_, d = dimension_;
  const double* curve = &curve_[static_cast<std::size_t>(span) * local_];
  double energy = 0.0;
  const auto weigh = [&](int i) {
    const double u = parameters_[i] - middles_[span];
    double squared = 0.0;
    for (int e = 0; e < d; ++e) {
      double value = 0.0;
      for (int power = k - 1; power >= 0; --power) value = value * u + curve[power * d + e];
      squared += (value - sites_.points(i, e)) * (value - sites_.points(i, e));
    }
    const double part = sites_.weights[i] / sites_.term_weight;
    double rho[3];
    sites_.loss->Evaluate(part * squared, rho);
    energy += sites_.term_weight * rho[0];
    robust_weights_[i] = sites_.weights[i] * rho[1];
    // A point without weight has no curvature either.
    loss_bends_[i] = rho[1] > 0.0 ? 2.0 * part * rho[2] / rho[1] : 0.0;
  };
  for (int r = span_runs_[span]; r < span_runs_[span + 1]; ++r) {
    for (int i = runs_[r].begin; i < runs_[r].end; ++i) weigh(i);
  }
  return energy;
}

/// Whole spans to each thread, with about as many points.
void FootModel::ShareSpans() {
  const int spans = basis_.num_domain_spans();
  const int threads = workers_.num_threads();
  for (int k = 0; k <= threads; ++k) {
    const auto target = static_cast<int>(static_cast<double>(view_.num_points()) * k / threads);
    const auto found = std::lower_bound(span_begins_.begin(), span_begins_.end() - 1, target);
    shares_[k] = k == threads ? spans : static_cast<int>(found - span_begins_.begin());
  }
  shares_[0] = 0;
}

}  // namespace batten
