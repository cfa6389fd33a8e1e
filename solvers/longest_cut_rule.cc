#include "solvers/longest_cut_rule.h"

#include <algorithm>
#include <cmath>

namespace batten {
namespace {

// A piece that nearly passes as a whole is cut in the middle: what would be left behind a long
// first part is a piece of its own however short.
constexpr double kMostOfPiece = 0.95;
constexpr double kLeastOfPiece = 1e-9;

}  // namespace

CutRuleInfo LongestCutRule::ClassInfo() {
  CutRuleInfo info;
  info.name = "longest";
  info.summary = "behind the longest first part that still passes, by a safeguarded secant";
  info.source = "docs/cut_rules/longest.md; greedy cuts: Tomek, IEEE Trans. Computers C-23, 1974";
  constexpr double kLeast = 0.88, kAim = 0.985;
  constexpr int kTrials = 6, kMostTrials = 100;
  info.options = {
      OptionInfo::Real("least", kLeast, 0.0, 1.0,
                       "A first part of this share of the longest passing length is taken."),
      OptionInfo::Real("aim", kAim, 0.1, 1.0, "The share of the predicted length that is tried."),
      OptionInfo::Integer("trials", kTrials, 1, kMostTrials, "Most trial cuts for one piece.")};
  return info;
}

LongestCutRule::LongestCutRule(const OptionValues& options)
    : least_(options.Real("least")),
      aim_(options.Real("aim")),
      num_trials_(options.Integer("trials")) {}

std::string LongestCutRule::WhyUnsupported(const BezierCurve& /*curve*/,
                                           const SubdivisionOptions& options) const {
  if (options.mode == SubdivisionMode::kAdaptive) return "";
  return "longest takes one piece after the other; in uniform rounds use half, flatness or share";
}

void LongestCutRule::Start(const BezierCurve& /*curve*/, const SubdivisionOptions& /*options*/) {
  passing_.reset();
  previous_length_ = 0.0;
}

void LongestCutRule::Prepare(const CutTrial& trial) {
  passing_.emplace(trial.stop(), trial.degree(), trial.dimension());
  least_value_ = std::pow(least_, trial.stop().power());
}

// The curvature is taken in the middle of the piece to come, which is about as long as the one
// before it.
double LongestCutRule::FirstGuess(const CutTrial& trial) const {
  if (trial.degree() < 2) return 0.5;
  const double half = 0.5 * previous_length_ / (trial.end() - trial.begin());
  double u = aim_ * passing_->Near(trial.points(), std::min(half, 0.5));
  if (half == 0.0 && u < 1.0) u = aim_ * passing_->Near(trial.points(), 0.5 * u);
  if (!(u < kMostOfPiece)) return 0.5;
  return std::max(u, kLeastOfPiece);
}

bool LongestCutRule::IsLongEnough(const StopValue& value) const {
  return value.passes() && value.value >= least_value_ * value.limit;
}

double LongestCutRule::Choose(CutTrial* trial) {
  if (!passing_) Prepare(*trial);
  double u = FirstGuess(*trial);
  double passing = 0.0, failing = 1.0;
  for (int k = 1; k < num_trials_; ++k) {
    const StopValue value = trial->Try(u);
    if (IsLongEnough(value) || (value.passes() && u >= 0.5)) break;
    (value.passes() ? passing : failing) = u;
    const double length = value.RelativeLength();
    // The secant through the origin: the length in units of the passing one goes with u.
    const double next = length > 0.0 && std::isfinite(length) ? u * aim_ / length : 0.5 * u;
    const double margin = 0.1 * (failing - passing);
    u = std::clamp(next, passing + margin, failing - margin);
  }
  previous_length_ = u * (trial->end() - trial->begin());
  return u;
}

}  // namespace batten
