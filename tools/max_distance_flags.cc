#include "tools/max_distance_flags.h"

#include <gflags/gflags.h>

#include <algorithm>

#include "problems/fit_guard.h"

DEFINE_double(max_distance, 0.0,
              "Instead of --control_points and a solver: searches for few control points such that "
              "no data point is farther from the curve, in the data's unit of length "
              "(docs/max_distance.md).");

namespace batten {
namespace {

/// What goes with a search: the data, the kind of curve, where to start, what to write.
constexpr const char* kAllowedFlags[] = {"problem",     "closed", "degree", "parameters",
                                         "out",         "figure", "quiet",  "curvature_figure",
                                         "max_distance"};

}  // namespace

FlagInfo MaxDistanceFlag() {
  constexpr double kLargest = 1e150;
  return NumberAboveFlag("max_distance", "LENGTH", 0.0, kLargest);
}

bool AsksForMaxDistance() { return WasGiven("max_distance"); }
double MaxDistance() { return FLAGS_max_distance; }

bool CheckMaxDistanceFlags(const std::vector<FlagInfo>& flags, const FitSpec& spec,
                           std::string* error) {
  for (const FlagInfo& flag : flags) {
    const bool is_allowed = std::any_of(std::begin(kAllowedFlags), std::end(kAllowedFlags),
                                        [&](const char* name) { return flag.name == name; });
    if (is_allowed || !WasGiven(flag.name)) continue;
    *error = "--" + flag.name +
             ": nothing is allowed beside --max_distance, whose search has its " +
             "own control points, knots, parameters and method";
    return false;
  }
  if (WasGiven("parameters") && !spec.parameters.has_value()) {
    *error = RefusedFlag("parameters", "given",
                         "uniform, chord_length or centripetal, where --max_distance starts from");
    return false;
  }
  const bool is_plain = std::all_of(spec.terms.begin(), spec.terms.end(), [](const NameSpec& term) {
    return term.name == "interpolation" && term.options.empty();
  });
  if (!is_plain || !spec.constraints.empty() || HasGuard(spec.guard) ||
      spec.parameter_kind != ParameterKind::kFixed) {
    *error =
        "--max_distance: the named problem has terms, constraints or free parameters; allowed: "
        "distances alone";
    return false;
  }
  return true;
}

}  // namespace batten
