#include "problems/fit_guard.h"

#include <cmath>

#include "cost_functions/options.h"

namespace batten {
namespace {

constexpr const char* kNone = "none";

struct Guard {
  const char* name;
  int derivative;
  double weight;  // per data point
  const char* help;
};

// Found on the outlines of animals with 12 and 20 control points: a tenth of these leaves loops,
// ten times as much is seen in the distances.
constexpr Guard kGuards[] = {
    {"length", 1, 1e-5, "per data point, of the integral of |C'|^2"},
    {"bending", 2, 1e-8, "per data point, of the integral of |C''|^2"},
};

NameSpec FairingTerm(int derivative, double weight) {
  return {"fairing",
          {{"derivative", std::to_string(derivative)}, {"weight", NumberText(weight)}},
          nullptr};
}

}  // namespace

bool ApplyGuard(const NameSpec& guard, int num_points, std::vector<NameSpec>* terms,
                std::string* error) {
  std::vector<std::string> names = {kNone};
  if (guard.wrapped != nullptr) {
    *error = "guard " + guard.name + " wraps nothing; found :" + guard.wrapped->ToString();
    return false;
  }
  OptionValues options;
  if (guard.name == kNone) return ResolveOptions({}, guard, &options, error);
  for (const Guard& known : kGuards) {
    names.emplace_back(known.name);
    if (guard.name != known.name) continue;
    if (!ResolveOptions({OptionInfo::Real("weight", known.weight, 0.0, 1e12, known.help)}, guard,
                        &options, error)) {
      return false;
    }
    terms->push_back(FairingTerm(known.derivative, options.Real("weight") * num_points));
    return true;
  }
  *error = UnknownNameMessage("guard", guard.name, names);
  return false;
}

bool HasGuard(const std::optional<NameSpec>& guard) {
  return guard.has_value() && guard->name != kNone;
}

NameSpec LengthGuard(double weight) { return FairingTerm(1, weight); }

}  // namespace batten
