#include "experiments/fairing_rules.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "cost_functions/options.h"
#include "splines/brent_minimum.h"
#include "splines/illinois_root.h"

namespace batten {
namespace {

class Chooser {
 public:
  Chooser(const SmoothingFamily& family, FairingRule rule, const FairingRuleSetting& setting)
      : family_(family),
        rule_(rule),
        unit_(setting.unit),
        num_residuals_(static_cast<double>(family.num_data()) * setting.dimension),
        systems_(setting.systems),
        noise_(setting.noise) {}

  bool Choose(FairingChoice* choice, std::string* error) {
    if (!Scan(error)) return false;
    if (!std::isfinite(Least().score)) {
      *error = Named() + " finds no weight at which the residuals have any freedom left";
      return false;
    }
    double weight = 0.0;
    bool found = true;
    if (rule_ == FairingRule::kLCurve) {
      found = ChooseByLCurve(&weight, error);
    } else if (rule_ == FairingRule::kDiscrepancy) {
      found = ChooseByDiscrepancy(&weight, error);
    } else {
      weight = FindLeast().weight;
    }
    if (!found) return false;
    choice->rule = rule_;
    choice->weight = weight;
    SortSamples();
    choice->samples = samples_;
    Describe(choice);
    return true;
  }

 private:
  std::string Named() const { return std::string("fairing=") + ToString(rule_); }

  void SortSamples() {
    std::sort(samples_.begin(), samples_.end(),
              [](const auto& a, const auto& b) { return a.weight < b.weight; });
  }

  void Describe(FairingChoice* choice) const {
    bool is_lightest = true, is_heaviest = true;
    for (const FairingSample& sample : choice->samples) {
      if (sample.weight == choice->weight) choice->chosen = sample;
      const bool is_judged = std::isfinite(sample.score);
      if (is_judged && sample.weight < choice->weight) is_lightest = false;
      if (is_judged && sample.weight > choice->weight) is_heaviest = false;
    }
    choice->end = is_lightest ? -1 : is_heaviest ? 1 : 0;
    choice->noise = std::sqrt(choice->chosen.residual / (num_residuals_ * Freedom(choice->chosen)));
  }

  static constexpr double kLCurveStep = 0.5;  // decades

  /// At 10^log_weight; infinite score where there is no answer or no freedom is left.
  double Evaluate(double log_weight) {
    SmoothingFamily::Member member;
    FairingSample sample;
    sample.weight = std::pow(10.0, log_weight);
    sample.score = std::numeric_limits<double>::infinity();
    if (family_.At(sample.weight, &member)) {
      sample.residual = member.residual * unit_;
      sample.bend = member.bend * unit_;
      sample.trace = member.trace / systems_;
      sample.score = Score(sample);
    }
    samples_.push_back(sample);
    return sample.score;
  }

  /// Share of the data's degrees of freedom that the residuals keep.
  double Freedom(const FairingSample& sample) const {
    return 1.0 - sample.trace * systems_ / family_.num_data();
  }

  double Score(const FairingSample& sample) const {
    if (rule_ == FairingRule::kLCurve) return 0.0;  // known once neighbours are
    const double freedom = Freedom(sample);
    const double of_noise = sample.residual / (num_residuals_ * noise_ * noise_);
    if (rule_ == FairingRule::kRisk) return of_noise + 2.0 * (1.0 - freedom);
    // Where fewer degrees of freedom are left than roundings of the trace are worth, it is 0 / 0.
    constexpr double kLeastFreedom = 1e-6;
    if (!(freedom > kLeastFreedom)) return std::numeric_limits<double>::infinity();
    if (rule_ == FairingRule::kDiscrepancy) return of_noise / freedom;
    return sample.residual / num_residuals_ / (freedom * freedom);
  }

  /// From where the terms balance, by factors, down until the trace stops growing and up until it
  /// stops falling: the whole way from the data's end to the fair end.
  bool Scan(std::string* error) {
    const double middle = std::log10(family_.BalancedWeight());
    if (!std::isfinite(middle)) {
      *error =
          "the fairing term is zero for every curve of this kind; there is no weight to choose";
      return false;
    }
    const double step = rule_ == FairingRule::kLCurve ? kLCurveStep : 2.0;
    constexpr double kSettled = 1e-3;  // of the trace, per decade
    constexpr int kMostSteps = 60;
    for (const double direction : {-1.0, 1.0}) {
      for (int i = direction < 0.0 ? 0 : 1; i < kMostSteps; ++i) {
        const double before = samples_.empty() ? 0.0 : Neighbour(direction).trace;
        const double score = Evaluate(middle + direction * i * step);
        if (i == 0) continue;
        const double change = std::abs(samples_.back().trace - before);
        if (change < kSettled * step * before) break;
        // The way back from four times the least would be a second minimum of a wild curve.
        constexpr double kFarAbove = 4.0;
        const bool is_far = LooksForTheLeast() && score > kFarAbove * Least().score;
        if (is_far && i > 1) break;
      }
    }
    SortSamples();
    return true;
  }

  const FairingSample& Neighbour(double direction) const {
    return *std::min_element(samples_.begin(), samples_.end(), [&](const auto& a, const auto& b) {
      return direction < 0.0 ? a.weight < b.weight : a.weight > b.weight;
    });
  }
  const FairingSample& Least() const {
    return *std::min_element(samples_.begin(), samples_.end(),
                             [](const auto& a, const auto& b) { return a.score < b.score; });
  }

  bool LooksForTheLeast() const {
    return rule_ == FairingRule::kGcv || rule_ == FairingRule::kRisk;
  }

  /// The sample of the least score, after a closer look where the scan's samples enclose it and not
  /// at the data's end or the fair end.
  const FairingSample& FindLeast() {
    const std::vector<FairingSample> scan = samples_;
    const auto least = static_cast<std::size_t>(
        std::min_element(scan.begin(), scan.end(),
                         [](const auto& a, const auto& b) { return a.score < b.score; }) -
        scan.begin());
    const auto log_of = [&](std::size_t i) { return std::log10(scan[i].weight); };
    if (least > 0 && least + 1 < scan.size()) {
      // Scores are flat at their minimum: 1e-4 of a decade is worth 1e-8 of it.
      constexpr double kTolerance = 1e-4;
      constexpr int kMostCalls = 20;
      BrentMinimum([this](double place) { return Evaluate(place); }, log_of(least - 1),
                   log_of(least), scan[least].score, log_of(least + 1), kTolerance, kMostCalls);
    }
    return Least();
  }

  /// Number of samples, which are in order, up to the heaviest one whose residuals are explained by
  /// the noise.
  std::size_t NumUpToExplained() const {
    std::size_t count = samples_.size();
    while (count > 0 && !(samples_[count - 1].score <= 1.0)) --count;
    return count;
  }

  /// With little fairing the score is that of a mere estimate of the noise, about 1, and crosses 1
  /// by chance, or never; from its least value on it grows with what fairing takes away of the
  /// shape. So the heaviest crossing is the one that says something.
  bool ChooseByDiscrepancy(double* weight, std::string* error) {
    std::size_t right = NumUpToExplained();
    if (right == samples_.size()) {
      *error = Named() + ": the squared residuals of the fairest curve are " +
               NumberText(samples_.back().score) + " times what the noise makes; give a smaller " +
               "noise";
      return false;
    }
    if (right == 0) {
      *weight = FindLeast().weight;  // the scan's steps are wide: it may still be below 1
      SortSamples();
      right = NumUpToExplained();
      if (right == 0) return IsByChance(Least(), error);
    }
    *weight = Crossing(samples_[right - 1], samples_[right]);
    return true;
  }

  /// Whether residuals can be so large by chance: squares of k normal errors vary by sqrt(2 / k).
  bool IsByChance(const FairingSample& least, std::string* error) const {
    constexpr double kDeviations = 3.0;
    const double variation = std::sqrt(2.0 / (num_residuals_ * Freedom(least)));
    if (least.score <= 1.0 + kDeviations * variation) return true;
    *error = Named() +
             ": the squared residuals are at each weight, without fairing too, at least " +
             NumberText(least.score) + " times what the noise makes; give a larger noise";
    return false;
  }

  /// The weight between two samples at which the score is 1.
  double Crossing(const FairingSample& left, const FairingSample& right) {
    const auto log_score = [](double score) {
      return std::log10(std::clamp(score, 1e-300, 1e300));
    };
    constexpr double kTolerance = 1e-8;
    constexpr int kMostCalls = 40;
    IllinoisRoot([&](double place) { return log_score(Evaluate(place)); }, std::log10(left.weight),
                 log_score(left.score), std::log10(right.weight), log_score(right.score),
                 kTolerance, kMostCalls);
    return samples_.back().weight;
  }

  /// Curvature of the L at the middle of three of its places, by the circle through them, positive
  /// where it turns left; NaN where they hardly move, as at the data's end, where roundings bend
  /// it.
  static double CircleCurvature(const FairingSample& left, const FairingSample& middle,
                                const FairingSample& right) {
    const auto place = [](const FairingSample& sample) {
      return Eigen::Vector2d(std::log10(sample.residual), std::log10(sample.bend));
    };
    const Eigen::Vector2d before = place(middle) - place(left);
    const Eigen::Vector2d after = place(right) - place(middle);
    constexpr double kMoves = 1e-3;
    if (!(before.norm() > kMoves && after.norm() > kMoves)) return NAN;
    const double cross = before.x() * after.y() - before.y() * after.x();
    return 2.0 * cross / (before.norm() * after.norm() * (before + after).norm());
  }

  /// Whether residuals say anything: with hardly a degree of freedom left they fall to what the
  /// space cannot meet, or to roundings, while the bend still grows, which is a corner, too.
  bool HasFreedom(const FairingSample& sample) const {
    constexpr double kLeastFreedom = 0.05;
    constexpr double kLeastResidual = 1e-13;  // of the size of the data, which is 1 inside
    return Freedom(sample) > kLeastFreedom &&
           sample.residual > num_residuals_ * unit_ * kLeastResidual * kLeastResidual;
  }

  /// Index of the sharpest corner of the samples, which are in order; 0: none.
  std::size_t SharpestCorner() {
    std::vector<double> curvature(samples_.size(), NAN);
    for (std::size_t i = 1; i + 1 < samples_.size(); ++i) {
      curvature[i] = CircleCurvature(samples_[i - 1], samples_[i], samples_[i + 1]);
    }
    std::size_t sharpest = 0;
    for (std::size_t i = 1; i + 1 < samples_.size(); ++i) {
      const bool is_judged = HasFreedom(samples_[i - 1]);
      samples_[i].score = is_judged ? curvature[i] : NAN;
      if (!is_judged || !(curvature[i] > 0.0)) continue;
      // The flank of a corner that is left out is none.
      if (curvature[i - 1] > curvature[i] || curvature[i + 1] > curvature[i]) continue;
      if (sharpest == 0 || curvature[i] > curvature[sharpest]) sharpest = i;
    }
    return sharpest;
  }

  bool ChooseByLCurve(double* weight, std::string* error) {
    const std::size_t corner = SharpestCorner();
    if (corner == 0) {
      *error =
          "fairing=lcurve finds no corner where residuals have freedom left and trade with the "
          "bend; use another rule or give a weight";
      return false;
    }
    // Twice as dense around it, then the top of the parabola through the three curvatures there.
    const double middle = std::log10(samples_[corner].weight);
    const double step = 0.5 * kLCurveStep;
    FairingSample near[5] = {samples_[corner - 1], {}, samples_[corner], {}, samples_[corner + 1]};
    for (const int side : {-1, 1}) {
      Evaluate(middle + side * step);
      near[2 + side] = samples_.back();
    }
    double curvature[3];
    for (int i = 0; i < 3; ++i) curvature[i] = CircleCurvature(near[i], near[i + 1], near[i + 2]);
    for (const int side : {-1, 1}) {
      samples_[samples_.size() - (side < 0 ? 2 : 1)].score = curvature[1 + side];
    }
    samples_[corner].score = curvature[1];
    const double slope = 0.5 * (curvature[2] - curvature[0]);
    const double bend = curvature[2] - 2.0 * curvature[1] + curvature[0];
    const double shift = bend < 0.0 ? std::clamp(-slope / bend, -1.0, 1.0) : 0.0;
    *weight = samples_[corner].weight;
    if (shift == 0.0 || !std::isfinite(Evaluate(middle + shift * step))) return true;
    samples_.back().score = curvature[1] + shift * (slope + 0.5 * shift * bend);
    *weight = samples_.back().weight;
    return true;
  }

  const SmoothingFamily& family_;
  FairingRule rule_;
  double unit_;
  double num_residuals_;  // m d
  int systems_;
  double noise_;
  std::vector<FairingSample> samples_;
};

}  // namespace

bool ChooseByRule(const SmoothingFamily& family, FairingRule rule,
                  const FairingRuleSetting& setting, FairingChoice* choice, std::string* error) {
  return Chooser(family, rule, setting).Choose(choice, error);
}

}  // namespace batten
