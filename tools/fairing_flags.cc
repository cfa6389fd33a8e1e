#include "tools/fairing_flags.h"

#include <gflags/gflags.h>

#include <algorithm>

#include "problems/fit_guard.h"
#include "tools/knot_file.h"
#include "tools/run_flags.h"

DEFINE_string(
    fairing, "",
    "Chooses the weight of the fairing term (added where --terms has none): gcv, "
    "generalised cross-validation; risk, the least expected error by the known --noise; "
    "discrepancy, residuals as large as the known --noise leaves them; lcurve, the corner "
    "of the L-curve.");
DEFINE_double(
    noise, 0.0,
    "With --fairing=risk and discrepancy: standard deviation of each coordinate of the points, in "
    "the data's unit of length.");
DEFINE_string(fairing_units, "scale_free",
              "Of terms that do not say it themselves: scale_free, the integral over a parameter "
              "from 0 to 1; source, over the parameter as it is.");
DEFINE_string(span_weights, "",
              "Factors of fairing terms, one for each span that is not empty: numbers separated by "
              "commas, or a file of numbers.");
DEFINE_string(fairing_figure, "",
              "With --fairing: SVG of the choice, what was judged at each weight that was tried.");

namespace batten {
namespace {

/// A term that has units and does not say them.
bool TakesUnits(const NameSpec& term) {
  const bool has_units = term.name == "fairing" || term.name == "curve_fairing" ||
                         term.name == "end_tangent" || term.name == "end_curvature";
  return has_units && std::none_of(term.options.begin(), term.options.end(),
                                   [](const auto& option) { return option.first == "units"; });
}

bool AddsFairing(const FitSpec& spec) {
  return WasGiven("fairing") &&
         std::none_of(spec.terms.begin(), spec.terms.end(),
                      [](const NameSpec& term) { return term.name == "fairing"; });
}

void ApplyUnits(FitSpec* spec) {
  if (AddsFairing(*spec)) {
    // What the choice of the weight would add by itself, without units.
    if (spec->terms.empty()) spec->terms.push_back({"interpolation", {}, nullptr});
    spec->terms.push_back({"fairing", {}, nullptr});
  }
  for (NameSpec& term : spec->terms) {
    if (TakesUnits(term)) term.options.emplace_back("units", FLAGS_fairing_units);
  }
}

/// The guard of an estimated scale comes by itself (robust_start.h).
bool GetsAGuard(const FitSpec& spec) {
  const auto is_estimated = [](const NameSpec& term) {
    return std::any_of(term.options.begin(), term.options.end(), [](const auto& option) {
      return option.first == "loss_scale" && option.second == "mad";
    });
  };
  return spec.parameter_kind != ParameterKind::kFixed && !spec.guard.has_value() &&
         std::any_of(spec.terms.begin(), spec.terms.end(), is_estimated);
}

/// Flags of fairing terms where there are none.
bool CheckFairingTerms(const FitSpec& spec, std::string* error) {
  const bool adds_fairing = AddsFairing(spec);
  if (WasGiven("fairing_units") && !adds_fairing &&
      std::none_of(spec.terms.begin(), spec.terms.end(), TakesUnits)) {
    *error =
        RefusedFlag("fairing_units", FLAGS_fairing_units,
                    "nothing, without --fairing or a term fairing, curve_fairing, end_tangent or "
                    "end_curvature that does not say its units");
    return false;
  }
  const bool has_fairing = std::any_of(
      spec.terms.begin(), spec.terms.end(),
      [](const NameSpec& term) { return term.name == "fairing" || term.name == "curve_fairing"; });
  if (WasGiven("span_weights") && !adds_fairing && !has_fairing && !HasGuard(spec.guard) &&
      !GetsAGuard(spec)) {
    *error = RefusedFlag("span_weights", FLAGS_span_weights,
                         "nothing, without --fairing, a fairing term or a guard");
    return false;
  }
  return true;
}

bool ApplySpanWeights(FitSpec* spec, std::string* error) {
  if (!WasGiven("span_weights")) return true;
  if (ParseNumbers(FLAGS_span_weights, &spec->span_weights)) return true;
  return ReadSpanWeightFile(FLAGS_span_weights, &spec->span_weights, error);
}

}  // namespace

std::vector<FlagInfo> FairingFlags() {
  constexpr double kLargestNoise = 1e150;
  return {WordFlag("fairing", {"gcv", "risk", "discrepancy", "lcurve"}),
          NumberAboveFlag("noise", "LENGTH", 0.0, kLargestNoise),
          WordFlag("fairing_units", {"scale_free", "source"}),
          TextFlag("span_weights", "NUMBERS", kAllowedSpanWeights),
          TextFlag("fairing_figure", "FILE", "NAME.svg")};
}

bool CheckFairingFlags(const FitSpec& spec, std::string* error) {
  FairingRule rule = FairingRule::kGcv;
  const bool needs_noise = FromString(FLAGS_fairing, &rule) && NeedsNoise(rule);
  if (needs_noise != WasGiven("noise")) {
    *error = needs_noise
                 ? "--fairing: " + FLAGS_fairing + " needs --noise, the points' standard deviation"
                 : RefusedFlag("noise", NumberText(FLAGS_noise),
                               "nothing, without --fairing=risk or --fairing=discrepancy");
    return false;
  }
  if (WasGiven("fairing_figure") && !WasGiven("fairing")) {
    *error = RefusedFlag("fairing_figure", FLAGS_fairing_figure, "nothing, without --fairing");
    return false;
  }
  return CheckFairingTerms(spec, error);
}

bool ApplyFairingFlags(const std::string& source, const DataSet& data, FitSpec* spec,
                       std::optional<FairingChoice>* choice, std::string* error) {
  if (!ApplySpanWeights(spec, error)) return false;
  if (WasGiven("fairing_units")) ApplyUnits(spec);
  if (!WasGiven("fairing")) return true;
  FairingRule rule = FairingRule::kGcv;
  FromString(FLAGS_fairing, &rule);
  if (ChooseFairingWeight(data, rule, FLAGS_noise, spec, &choice->emplace(), error)) return true;
  // What no weight could mend is about the fit, not about the flag.
  const bool is_about_the_rule = error->rfind("fairing=", 0) == 0;
  *error = (is_about_the_rule ? "--" : source + ": ") + *error;
  return false;
}

}  // namespace batten
