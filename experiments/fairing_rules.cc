#include "experiments/fairing_rules.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "cost_functions/options.h"
#include "splines/brent_minimum.h"

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
    double weight = 0.0;
    const bool found = rule_ == FairingRule::kGcv           ? ChooseByGcv(&weight, error)
                       : rule_ == FairingRule::kDiscrepancy ? ChooseByDiscrepancy(&weight, error)
                                                            : ChooseByLCurve(&weight, error);
    if (!found) return false;
    choice->rule = rule_;
    choice->weight = weight;
    choice->samples = samples_;
    std::sort(choice->samples.begin(), choice->samples.end(),
              [](const auto& a, const auto& b) { return a.weight < b.weight; });
    Describe(choice);
    return true;
  }

 private:
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
    if (rule_ == FairingRule::kDiscrepancy) {
      return sample.residual / (num_residuals_ * noise_ * noise_);
    }
    if (rule_ == FairingRule::kLCurve) return 0.0;  // known once neighbours are
    // Where fewer degrees of freedom are left than roundings of the trace are worth, V is 0 / 0.
    constexpr double kLeastFreedom = 1e-6;
    const double freedom = Freedom(sample);
    if (!(freedom > kLeastFreedom)) return std::numeric_limits<double>::infinity();
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
        // The way back from four times the least V would be a second minimum of a wild curve.
        constexpr double kFarAbove = 4.0;
        const bool is_far = rule_ == FairingRule::kGcv && score > kFarAbove * Least().score;
        if (is_far && i > 1) break;
      }
    }
    std::sort(samples_.begin(), samples_.end(),
              [](const auto& a, const auto& b) { return a.weight < b.weight; });
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

  bool ChooseByGcv(double* weight, std::string* error) {
    const std::vector<FairingSample> scan = samples_;
    const auto least = static_cast<std::size_t>(
        std::min_element(scan.begin(), scan.end(),
                         [](const auto& a, const auto& b) { return a.score < b.score; }) -
        scan.begin());
    if (!std::isfinite(scan[least].score)) {
      *error = "fairing=gcv finds no weight at which the residuals have any freedom left";
      return false;
    }
    const auto log_of = [&](std::size_t i) { return std::log10(scan[i].weight); };
    *weight = scan[least].weight;
    if (least == 0 || least + 1 == scan.size()) return true;  // the data's end or the fair end
    // V is flat at its minimum: 1e-4 of a decade is worth 1e-8 of it.
    constexpr double kTolerance = 1e-4;
    constexpr int kMostCalls = 20;
    const auto found =
        BrentMinimum([this](double place) { return Evaluate(place); }, log_of(least - 1),
                     log_of(least), scan[least].score, log_of(least + 1), kTolerance, kMostCalls);
    *weight = std::pow(10.0, found.first);
    return true;
  }

  /// RSS grows with the weight: the place by bisection and secants (Illinois) in logarithms.
  bool ChooseByDiscrepancy(double* weight, std::string* error) {
    const auto log_score = [](double score) { return std::log10(std::max(score, 1e-300)); };
    std::size_t right = 0;
    while (right < samples_.size() && log_score(samples_[right].score) < 0.0) ++right;
    if (right == 0 || right == samples_.size()) {
      const FairingSample& end = right == 0 ? samples_.front() : samples_.back();
      *error = std::string("fairing=discrepancy: the squared residuals of the ") +
               (right == 0 ? "curve without fairing are " : "fairest curve are ") +
               NumberText(end.score) + " times what the noise makes; give " +
               (right == 0 ? "a larger" : "a smaller") + " noise";
      return false;
    }
    double a = std::log10(samples_[right - 1].weight), b = std::log10(samples_[right].weight);
    double fa = log_score(samples_[right - 1].score), fb = log_score(samples_[right].score);
    constexpr double kTolerance = 1e-8;
    constexpr int kMostCalls = 40;
    double place = b;
    for (int call = 0; call < kMostCalls; ++call) {
      place = (a * fb - b * fa) / (fb - fa);
      const double value = log_score(Evaluate(place));
      if (std::abs(value) < kTolerance) break;
      if (value * fb < 0.0) {
        a = b;
        fa = fb;
      } else {
        fa *= 0.5;  // the end that stays counts half, so that it does move
      }
      b = place;
      fb = value;
    }
    *weight = std::pow(10.0, place);
    return true;
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
          "bend; use gcv or discrepancy, or give a weight";
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
