#include "solvers/cut_search.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

namespace batten {
namespace {

constexpr int kDegree = 12;
constexpr int kSize = kDegree + 1;
constexpr double kFirst = 1.0 / 64.0;
constexpr double kLast = 63.0 / 64.0;
constexpr double kShortestPanel = 0x1p-14;
constexpr double kAgreement = 1e-9;
using Coefficients = std::array<double, kSize>;

/// Chebyshev's points of [0, 1] with both ends.
double Node(int k) { return 0.5 - 0.5 * std::cos(M_PI * k / kDegree); }

double Bernstein(int i, double s) {
  double value = 1.0;
  for (int j = 0; j < i; ++j) value *= s * (kDegree - j) / (j + 1.0);
  for (int j = 0; j < kDegree - i; ++j) value *= 1.0 - s;
  return value;
}

/// From values at the nodes to Bernstein coefficients.
const Eigen::Matrix<double, kSize, kSize>& Interpolation() {
  static const auto& matrix = *[] {
    Eigen::Matrix<double, kSize, kSize> basis;
    for (int k = 0; k < kSize; ++k) {
      for (int i = 0; i < kSize; ++i) basis(k, i) = Bernstein(i, Node(k));
    }
    return new Eigen::Matrix<double, kSize, kSize>(basis.inverse());
  }();
  return matrix;
}

double Evaluate(int degree, const double* coefficients, double s) {
  double result = 0.0;
  EvaluateBezier(degree, 1, coefficients, s, &result);
  return result;
}

class MinimumSearch {
 public:
  explicit MinimumSearch(CutValue* value) : value_(*value) {}

  std::vector<CutPlace> Run() {
    SearchPanel(kFirst, kLast);
    KeepLocalMinima();
    return places_;
  }

 private:
  void SearchPanel(double begin, double end) {
    Coefficients coefficients;
    if (Interpolate(begin, end, &coefficients)) {
      std::array<double, kDegree> slopes;
      for (int i = 0; i < kDegree; ++i) slopes[i] = coefficients[i + 1] - coefficients[i];
      IsolateZeros(slopes.data(), begin, end);
    } else if (end - begin <= kShortestPanel) {
      KeepKink(begin, end);
    } else {
      const double middle = 0.5 * (begin + end);
      SearchPanel(begin, middle);
      SearchPanel(middle, end);
    }
  }

  bool Interpolate(double begin, double end, Coefficients* coefficients) {
    Eigen::Matrix<double, kSize, 1> values;
    for (int k = 0; k < kSize; ++k) values[k] = value_(begin + (end - begin) * Node(k));
    largest_ = std::max(largest_, values.maxCoeff());
    Eigen::Map<Eigen::Matrix<double, kSize, 1>>(coefficients->data()) = Interpolation() * values;
    // Between the nodes, where an interpolant that is wrong is so most.
    for (const int k : {0, 3, 6, 9, 11}) {
      const double s = 0.5 * (Node(k) + Node(k + 1));
      const double wanted = value_(begin + (end - begin) * s);
      if (!(std::abs(Evaluate(kDegree, coefficients->data(), s) - wanted) <=
            kAgreement * largest_)) {
        return false;
      }
    }
    return true;
  }

  void IsolateZeros(const double* slopes, double begin, double end) {
    int num_changes = 0;
    for (int i = 0; i + 1 < kDegree; ++i) num_changes += (slopes[i] < 0.0) != (slopes[i + 1] < 0.0);
    if (num_changes == 0) {
      // A minimum may stand between two panels.
      Keep(slopes[0] < 0.0 ? end : begin);
      return;
    }
    constexpr double kResolution = 0x1p-40;
    if (num_changes == 1 || end - begin < kResolution) {
      Keep(ZeroOf(slopes, begin, end));
      return;
    }
    std::array<double, kDegree> first, second;
    CutBezier(kDegree - 1, 1, 0.5, slopes, first.data(), second.data());
    const double middle = 0.5 * (begin + end);
    IsolateZeros(first.data(), begin, middle);
    IsolateZeros(second.data(), middle, end);
  }

  static double ZeroOf(const double* slopes, double begin, double end) {
    double low = 0.0, high = 1.0;
    const bool falls = slopes[0] < 0.0;
    constexpr int kHalvings = 45;
    for (int k = 0; k < kHalvings; ++k) {
      const double middle = 0.5 * (low + high);
      ((Evaluate(kDegree - 1, slopes, middle) < 0.0) == falls ? low : high) = middle;
    }
    return begin + 0.5 * (low + high) * (end - begin);
  }

  // The value has a kink here, or more of them; by the golden section, to the lowest point if there
  // is one minimum.
  void KeepKink(double begin, double end) {
    Keep(begin);
    const double last = end;
    const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
    constexpr int kSteps = 50;
    for (int k = 0; k < kSteps; ++k) {
      const double left = end - golden * (end - begin), right = begin + golden * (end - begin);
      if (value_(left) <= value_(right)) {
        end = right;
      } else {
        begin = left;
      }
    }
    Keep(0.5 * (begin + end));
    Keep(last);
  }

  void Keep(double u) {
    if (!places_.empty() && places_.back().u == u) return;
    places_.push_back({u, value_(u)});
  }

  // Places in order: those that a neighbour undercuts are no minima. Maxima were kept until here,
  // since between two minima there is one.
  void KeepLocalMinima() {
    std::vector<CutPlace> minima;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const bool below_left = i == 0 || places_[i].value < places_[i - 1].value;
      const bool below_right = i + 1 == places_.size() || places_[i].value <= places_[i + 1].value;
      if (below_left && below_right) minima.push_back(places_[i]);
    }
    places_ = std::move(minima);
  }

  CutValue& value_;
  double largest_ = 0.0;
  std::vector<CutPlace> places_;
};

}  // namespace

CutPlace GridMinimum(CutValue* value) {
  constexpr int kCount = 13;
  CutPlace best;
  for (int k = 0; k < kCount; ++k) {
    const double u = (4 + k) / 20.0;
    const double here = (*value)(u);
    if (k == 0 || here < best.value) best = {u, here};
  }
  return best;
}

std::vector<CutPlace> AllMinima(CutValue* value) { return MinimumSearch(value).Run(); }

CutPlace ExactMinimum(CutValue* value) {
  const std::vector<CutPlace> minima = AllMinima(value);
  return *std::min_element(minima.begin(), minima.end(),
                           [](const CutPlace& a, const CutPlace& b) { return a.value < b.value; });
}

}  // namespace batten
