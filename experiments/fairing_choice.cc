#include "experiments/fairing_choice.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "experiments/audited_terms.h"
#include "experiments/fairing_rules.h"
#include "problems/curve_view.h"
#include "problems/fit_guard.h"
#include "splines/smoothing_family.h"

namespace batten {
namespace {

constexpr const char* kFairing = "fairing";

struct RuleWord {
  FairingRule rule;
  const char* word;
};
constexpr RuleWord kRuleWords[] = {{FairingRule::kGcv, "gcv"},
                                   {FairingRule::kRisk, "risk"},
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
  if (spec->parameter_kind != ParameterKind::kFixed) {
    *error = name + " cannot judge " + ToString(spec->parameter_kind) +
             " parameters, which are no linear fit; give a weight";
    return false;
  }
  if (HasGuard(spec->guard)) {
    *error = name + " chooses the weight of the only fairing term, and the guard " +
             spec->guard->ToString() + " is another; leave the guard out or give a weight";
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

/// What of the problem is no linear least-squares fit, as the end of a sentence; empty: nothing.
std::string WhyNotLinear(const Problem& problem) {
  if (const ConstraintFamily* const constraints = problem.nonlinear_constraints()) {
    return "cannot judge the constraint " + constraints->name(0) +
           ", which is not linear; give a weight";
  }
  for (const Problem::TermInstance& term : problem.terms()) {
    if (term.family->rows() != nullptr) continue;
    return "cannot judge the term " + term.name +
           ", which is not affine in the control points; give a weight";
  }
  return "";
}

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

const char* ScoreName(FairingRule rule) {
  constexpr const char* kNames[] = {"V", "estimated risk over noise^2",
                                    "RSS over what the noise leaves", "curvature of the L"};
  return kNames[static_cast<int>(rule)];
}

bool NeedsNoise(FairingRule rule) {
  return rule == FairingRule::kRisk || rule == FairingRule::kDiscrepancy;
}

std::string FairingChoiceWarning(const FairingChoice& choice) {
  constexpr double kEqual = 1e-6;
  if (choice.rule == FairingRule::kDiscrepancy && choice.chosen.score > 1.0 + kEqual) {
    return "fairing=discrepancy: the residuals show more than the noise at every weight, by no "
           "more than chance can; the weight is the one at which they show least";
  }
  if (choice.end == 0) return "";
  const std::string end = choice.end < 0 ? "lightest" : "heaviest";
  return "fairing=" + std::string(ToString(choice.rule)) + " is best at the " + end +
         " weight that it judges: the data ask for " +
         (choice.end < 0 ? "no fairing that it could tell from none"
                         : "the fairest curve there is");
}

bool ChooseFairingWeight(const DataSet& data, FairingRule rule, double noise, FitSpec* spec,
                         FairingChoice* choice, std::string* error) {
  const auto begin = std::chrono::steady_clock::now();
  std::size_t fairing = 0;
  if (!FindFairingTerm(rule, spec, &fairing, error)) return false;
  SetWeight(1.0, &spec->terms[fairing]);
  const std::unique_ptr<Problem> problem = MakeFitProblem(data, *spec, error);
  if (problem == nullptr) return false;
  const double least_noise = std::numeric_limits<double>::epsilon() * problem->curve_fit()->size();
  if (NeedsNoise(rule) && noise < least_noise) {
    *error =
        std::string("fairing=") + ToString(rule) + " is told of noise " + NumberText(noise) +
        ", which the rounding of data of this size hides; allowed: " + NumberText(least_noise) +
        " or more";
    return false;
  }
  const std::string why_not = WhyNotLinear(*problem);
  if (!why_not.empty()) {
    *error = std::string("fairing=") + ToString(rule) + " " + why_not;
    return false;
  }
  if (problem->elimination().num_free(problem->num_variables()) == 0) {
    *error = std::string("fairing=") + ToString(rule) +
             " has no curves to choose from: the constraints leave nothing free";
    return false;
  }
  // Terms at the ends and the like pull, but are no data that anything could be told from.
  std::vector<const RowSource*> distances, others;
  double weight = 0.0;  // of a squared distance in the residuals
  for (std::size_t i = 0; i < problem->terms().size(); ++i) {
    if (i == fairing) continue;
    const Problem::TermInstance& term = problem->terms()[i];
    const bool is_distance = IsDistanceTerm(term, *problem->curve_fit());
    (is_distance ? distances : others).push_back(term.family->rows());
    if (is_distance) weight += term.family->weight();
  }
  const auto data_view = CurveView::Make(*problem, distances, nullptr);
  const auto fairing_view =
      CurveView::Make(*problem, {problem->terms()[fairing].family->rows()}, nullptr);
  const auto others_view = CurveView::Make(*problem, others, nullptr);
  if (data_view == nullptr || fairing_view == nullptr) {
    *error = std::string("fairing=") + ToString(rule) +
             " judges the residuals of the term interpolation, which is not among the terms";
    return false;
  }
  const SmoothingFamily family(data_view->row_source(), fairing_view->row_source(),
                               others_view == nullptr ? nullptr : &others_view->row_source());
  // Constraints on single coordinates make one system of all of them.
  const int dimension = data_view->dimension();
  const int systems = problem->curve_fit()->dimension() / dimension;
  const double root = std::sqrt(weight);
  const FairingRuleSetting setting = {problem->units().energy, dimension, systems, root * noise};
  if (!ChooseByRule(family, rule, setting, choice, error)) return false;
  choice->noise /= root;
  SetWeight(choice->weight, &spec->terms[fairing]);
  choice->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return true;
}

}  // namespace batten
