#include "solvers/share_cut_rule.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace batten {
namespace {

constexpr int kMostSamples = kMaxBezierDegree;
constexpr int kManySamples = 9;
// After so many cuts a piece bends so evenly that three samples count its pieces as well.
constexpr int kDepthOfFewSamples = 5;
constexpr int kFewSamples = 3;

/// Where the area under the polyline of `values`, at equal distances on [0, 1], comes to `area`.
double Quantile(const double* values, int count, double area) {
  const double width = 1.0 / (count - 1);
  for (int i = 0; i + 1 < count; ++i) {
    const double here = 0.5 * width * (values[i] + values[i + 1]);
    if (area > here && i + 2 < count) {
      area -= here;
      continue;
    }
    // values[i] x + slope x^2 / 2 = area, by the form of the root that does not cancel.
    const double slope = (values[i + 1] - values[i]) / width;
    const double root = std::sqrt(std::max(0.0, values[i] * values[i] + 2.0 * slope * area));
    return i * width + 2.0 * area / (values[i] + root);
  }
  return 0.5;
}

}  // namespace

CutRuleInfo ShareCutRule::ClassInfo() {
  CutRuleInfo info;
  info.name = "share";
  info.summary = "where both parts will come to whole numbers of pieces, counted by curvature";
  info.source = "docs/cut_rules/share.md";
  constexpr double kAim = 0.96;
  info.options = {OptionInfo::Real(
      "aim", kAim, 0.1, 1.0, "The share of the predicted passing length that pieces shall have.")};
  return info;
}

ShareCutRule::ShareCutRule(const OptionValues& options) : aim_(options.Real("aim")) {}

void ShareCutRule::Start(const BezierCurve& /*curve*/, const SubdivisionOptions& options) {
  passing_.reset();
  is_uniform_ = options.mode == SubdivisionMode::kUniform;
}

// Legs stand for C' / n at i / (n - 1), their differences for C'' / (n (n - 1)) at i / (n - 2);
// between them both are taken as linear.
double ShareCutRule::DensityAt(const CutTrial& trial, double s) const {
  const int n = trial.degree(), d = trial.dimension();
  const double* p = trial.points();
  const double leg_place = s * (n - 1), bend_place = s * (n - 2);
  const int leg = std::min(static_cast<int>(leg_place), n - 2);
  const int bend_index = std::clamp(static_cast<int>(bend_place), 0, std::max(0, n - 3));
  const double leg_share = leg_place - leg;
  const double bend_share = n == 2 ? 0.0 : bend_place - bend_index;
  double speed[kMaxDimension], bend[kMaxDimension];
  double squared_speed = 0.0, squared_cross = 0.0;
  const auto second = [p, d](int index, int c) {
    const double* here = p + index * d + c;
    return here[2 * d] - 2.0 * here[d] + here[0];
  };
  for (int c = 0; c < d; ++c) {
    const double* here = p + leg * d + c;
    const double first = here[d] - here[0];
    speed[c] = first + leg_share * ((here[2 * d] - here[d]) - first);
    bend[c] = second(bend_index, c);
    if (bend_share > 0.0) bend[c] += bend_share * (second(bend_index + 1, c) - bend[c]);
    squared_speed += speed[c] * speed[c];
  }
  for (int i = 0; i < d; ++i) {
    for (int j = i + 1; j < d; ++j) {
      const double minor = speed[i] * bend[j] - speed[j] * bend[i];
      squared_cross += minor * minor;
    }
  }
  if (squared_cross == 0.0) return 0.0;
  return 1.0 / passing_->FromSquares(squared_speed, squared_cross);
}

double ShareCutRule::Choose(CutTrial* trial) {
  if (trial->degree() < 2) return 0.5;
  if (!passing_) passing_.emplace(trial->stop(), trial->degree(), trial->dimension());
  const int count = trial->depth() < kDepthOfFewSamples
                        ? std::max(kManySamples, trial->degree() - 1)
                        : kFewSamples;
  std::array<double, kMostSamples> densities;
  double pieces = 0.0;
  for (int k = 0; k < count; ++k) {
    densities[k] = DensityAt(*trial, k / (count - 1.0));
    pieces += (k == 0 || k == count - 1 ? 0.5 : 1.0) * densities[k] / (count - 1);
  }
  if (!(pieces > 0.0) || !std::isfinite(pieces)) return 0.5;
  const double whole = std::max(2.0, std::ceil(pieces / aim_));
  const double share = is_uniform_ ? 0.5 : std::floor(0.5 * whole) / whole;
  const double u = Quantile(densities.data(), count, pieces * share);
  // Samples can miss a sharp bend: a cut near an end would then leave all of it uncut.
  constexpr double kMargin = 0.1;
  return std::clamp(u, kMargin, 1.0 - kMargin);
}

}  // namespace batten
