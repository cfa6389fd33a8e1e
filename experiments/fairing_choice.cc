#include "experiments/fairing_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "problems/curve_view.h"
#include "splines/brent_minimum.h"
#include "splines/smoothing_family.h"

namespace batten {
namespace {

constexpr const char* kFairing = "fairing";

struct RuleWord {
  FairingRule rule;
  const char* word;
};
constexpr RuleWord kRuleWords[] = {{FairingRule::kGcv, "gcv"},
                                   {FairingRule::kDiscrepancy, "discrepancy"},
                                   {FairingRule::kLCurve, "lcurve"}};

void SetWeight(double weight, NameSpec* term) {
  auto& options = term->options;
  options.erase(std::remove_if(options.begin(), options.end(),
                               [](const auto& option) { return option.first == "weight"; }),
                options.end());
  options.emplace_back("weight", NumberText(weight));
}

bool HasLoss(const NameSpec& term) {
  return std::any_of(term.options.begin(), term.options.end(), [](const auto& option) {
    return option.first == "loss" && option.second != "none";
  });
}

/// The index of the fairing term, added where there is none.
bool FindFairingTerm(FairingRule rule, FitSpec* spec, std::size_t* index, std::string* error) {
  const std::string name = std::string("fairing=") + ToString(rule);
  if (spec->parameter_kind == ParameterKind::kFree) {
    *error = name + " cannot judge free parameters, which are no linear fit; give a weight";
    return false;
  }
  if (spec->terms.empty()) spec->terms.push_back({"interpolation", {}, nullptr});
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < spec->terms.size(); ++i) {
    if (HasLoss(spec->terms[i])) {
      *error = name + " cannot judge a loss, which makes the fit no linear one; give a weight";
      return false;
    }
    if (spec->terms[i].name == kFairing) found.push_back(i);
  }
  if (found.size() > 1) {
    *error = name + " chooses one weight; found " + std::to_string(found.size()) + " fairing terms";
    return false;
  }
  if (found.empty()) {
    found.push_back(spec->terms.size());
    spec->terms.push_back({kFairing, {}, nullptr});
  }
  *index = found.front();
  return true;
}

class Chooser {
 public:
  /// `unit`: of energies in the user's units; `noise` in these too. `dimension`: coordinates that
  /// a row of the family stands for; `systems`: that are unknowns of one system, 1 where each has
  /// the same one.
  Chooser(const SmoothingFamily& family, FairingRule rule, double unit, int dimension, int systems,
          double noise)
      : family_(family),
        rule_(rule),
        unit_(unit),
        num_residuals_(static_cast<double>(family.num_data()) * dimension),
        systems_(systems),
        noise_(noise) {}

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
    return true;
  }

 private:
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

  double Score(const FairingSample& sample) const {
    if (rule_ == FairingRule::kDiscrepancy) {
      return sample.residual / (num_residuals_ * noise_ * noise_);
    }
    if (rule_ == FairingRule::kLCurve) return 0.0;  // known once neighbours are
    // Where fewer degrees of freedom are left than roundings of the trace are worth, V is 0 / 0.
    constexpr double kLeastFreedom = 1e-6;
    const double freedom = 1.0 - sample.trace * systems_ / family_.num_data();
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
    const double step = rule_ == FairingRule::kLCurve ? 0.5 : 2.0;
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

  /// Curvature of (log RSS, log bend) by the circle through three neighbours.
  bool ChooseByLCurve(double* weight, std::string* error) {
    std::size_t sharpest = 0;
    for (std::size_t i = 1; i + 1 < samples_.size(); ++i) {
      Eigen::Vector2d p[3];
      for (std::size_t j = 0; j < 3; ++j) {
        const FairingSample& sample = samples_[i + j - 1];
        p[j] = {std::log10(sample.residual), std::log10(sample.bend)};
      }
      const Eigen::Vector2d before = p[1] - p[0], after = p[2] - p[1], chord = p[2] - p[0];
      const double cross = before.x() * after.y() - before.y() * after.x();
      // At the data's end both hardly move, and roundings bend the curve.
      const bool moves = before.norm() > 1e-3 && after.norm() > 1e-3;
      const double curvature = 2.0 * cross / (before.norm() * after.norm() * chord.norm());
      samples_[i].score = moves && std::isfinite(curvature) ? curvature : 0.0;
      if (samples_[i].score > samples_[sharpest].score) sharpest = i;
    }
    if (sharpest == 0) {
      *error = "fairing=lcurve finds no corner: residuals and bend do not trade; give a weight";
      return false;
    }
    *weight = samples_[sharpest].weight;
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

const char* ToString(FairingRule rule) {
  for (const RuleWord& row : kRuleWords) {
    if (row.rule == rule) return row.word;
  }
  return "unknown";
}

bool FromString(const std::string& text, FairingRule* rule) {
  for (const RuleWord& row : kRuleWords) {
    if (text == row.word) {
      *rule = row.rule;
      return true;
    }
  }
  return false;
}

bool ChooseFairingWeight(const DataSet& data, FairingRule rule, double noise, FitSpec* spec,
                         FairingChoice* choice, std::string* error) {
  std::size_t fairing = 0;
  if (!FindFairingTerm(rule, spec, &fairing, error)) return false;
  SetWeight(1.0, &spec->terms[fairing]);
  const std::unique_ptr<Problem> problem = MakeFitProblem(data, *spec, error);
  if (problem == nullptr) return false;
  std::vector<const RowSource*> others;
  for (std::size_t i = 0; i < problem->terms().size(); ++i) {
    if (i != fairing) others.push_back(problem->terms()[i].family->rows());
  }
  const auto data_view = CurveView::Make(*problem, others, nullptr);
  const auto fairing_view =
      CurveView::Make(*problem, {problem->terms()[fairing].family->rows()}, nullptr);
  if (data_view == nullptr || fairing_view == nullptr) {
    *error = std::string("fairing=") + ToString(rule) +
             " needs another term, terms that are affine, and constraints that are linear";
    return false;
  }
  const SmoothingFamily family(data_view->row_source(), fairing_view->row_source());
  // Constraints on single coordinates make one system of all of them.
  const int dimension = data_view->dimension();
  const int systems = problem->curve_fit()->dimension() / dimension;
  Chooser chooser(family, rule, problem->units().energy, dimension, systems, noise);
  if (!chooser.Choose(choice, error)) return false;
  SetWeight(choice->weight, &spec->terms[fairing]);
  return true;
}

std::vector<PlotPanel> FairingChoicePanels(const FairingChoice& choice) {
  const auto panel = [&](const std::string& title, const std::string& label, bool log_y,
                         const auto& value) {
    PlotPanel made;
    made.title = title;
    made.x_label = "weight";
    made.y_label = label;
    made.log_x = true;
    made.log_y = log_y;
    made.legend = false;
    PlotSeries tried, chosen;
    chosen.style = PlotSeries::Style::kCircles;
    chosen.color = 1;
    for (const FairingSample& sample : choice.samples) {
      tried.x.push_back(sample.weight);
      tried.y.push_back(value(sample));
      if (sample.weight != choice.weight) continue;
      chosen.x.push_back(sample.weight);
      chosen.y.push_back(value(sample));
    }
    made.series = {tried, chosen};
    return made;
  };
  const bool is_curvature = choice.rule == FairingRule::kLCurve;
  return {panel(std::string("choice by ") + ToString(choice.rule),
                choice.rule == FairingRule::kGcv ? "V"
                : is_curvature                   ? "curvature of the L"
                                                 : "RSS over that of the noise",
                !is_curvature, [](const FairingSample& s) { return s.score; }),
          panel("residual", "RSS", true, [](const FairingSample& s) { return s.residual; }),
          panel("effective control points", "trace", true,
                [](const FairingSample& s) { return s.trace; })};
}

}  // namespace batten
