#include "tools/fit_request.h"

#include <gflags/gflags.h>

#include <filesystem>
#include <system_error>

#include "problems/curve_constraints.h"
#include "problems/fit_guard.h"
#include "tools/fairing_flags.h"
#include "tools/fitted_points.h"
#include "tools/flags.h"
#include "tools/knot_file.h"
#include "tools/max_distance_flags.h"
#include "tools/run_flags.h"

namespace {
const batten::FitSpec kDefaults;
}  // namespace

DEFINE_string(problem, "",
              "Fit a problem of the catalogue (batten list problems) or of a problem file instead "
              "of FILE; flags below override what it says.");
DEFINE_bool(closed, kDefaults.closed,
            "The curve is closed: the last point is followed by the first.");
DEFINE_int32(degree, kDefaults.degree, "Degree of the spline.");
DEFINE_int32(control_points, kDefaults.control_points,
             "Number of control points; an open curve needs degree + 1 or more. Required unless "
             "--knots are numbers, --problem says it, or --max_distance searches for it.");
DEFINE_string(parameters, batten::ToString(*kDefaults.parameters),
              "Parameters of the points; given: the column t of FILE.");
DEFINE_string(knots, batten::ToString(kDefaults.knots),
              "uniform, averaged (from the parameters), or the knots themselves: numbers separated "
              "by commas, or a file of numbers. Open: n + p + 1 of them, closed: n + 2p + 1.");
DEFINE_string(ends, "end_interpolating",
              "Open curves: p + 1 equal knots at either end, or knots that go on past the domain.");
DEFINE_string(
    domain, "",
    "With --parameters=given: where the curve begins and ends, as two numbers. Not given: "
    "the range of the parameters; closed: 0,1.");
DEFINE_string(
    terms, "",
    "Terms of the energy with their options, separated by commas (batten list terms). Not "
    "given: interpolation; with free parameters free_parameter, projected foot_point.");
DEFINE_string(start, kDefaults.start,
              "Where the control points start: on the polyline through the data, all at its "
              "centroid, on a circle or ellipse around it, or those of another fit (a file "
              "written by --out). Free parameters start at the feet on a circle, ellipse or fit.");
DEFINE_string(parameter_kind, batten::ToString(kDefaults.parameter_kind),
              "fixed: the parameters stay what they are; free: they are unknowns beside the "
              "control points; projected: they are always the foot points.");
DEFINE_bool(keep_order, kDefaults.keep_order,
            "Free parameters: they stay in the order of the data points.");
DEFINE_string(guard, "none",
              "Against loops where no point is nearest to the curve: length or bending, a light "
              "fairing term that every solver honours; /weight=W per data point. Not given, fits "
              "of free or projected parameters with loss_scale=mad have length, of a weight that "
              "goes with the noise.");
DEFINE_bool(hold_ends, kDefaults.hold_ends,
            "Free parameters of an open curve: the first and the last one stay at the ends.");
DEFINE_string(constraints, "",
              "Hard constraints with their options, separated by commas: point/t=0.5/x=1/y=2, "
              "derivative/t=0/order=1/x=3, tangent/t=0/x=1/y=0, curvature/t=0.5/kappa=2, "
              "point/free=1/x=1/y=2 (at a parameter that is found), ends, natural, clamped, "
              "not-a-knot, periodic (docs/constraints.md).");

namespace batten {
namespace {

constexpr char kAllowedDomain[] = "two numbers A,B with A < B";

/// Knots are checked here, where it is known whether the flag or a file holds them.
bool ApplyKnotNumbers(FitRequest* request, std::string* error) {
  FitSpec* spec = &request->spec;
  std::string source = "--knots";
  if (!ParseNumbers(FLAGS_knots, &spec->given_knots)) {
    source = FLAGS_knots;
    request->input_files.push_back(source);
    if (!ReadKnotFile(source, &spec->given_knots, error)) return false;
  }
  std::string why;
  const auto basis = BsplineBasis::Make(spec->degree, spec->closed, spec->given_knots, &why);
  if (!basis.has_value()) {
    *error = source + ": " + why;
    return false;
  }
  const int n = basis->num_control_points();
  if (WasGiven("control_points") && spec->control_points != n) {
    *error = RefusedFlag("control_points", std::to_string(spec->control_points),
                         std::to_string(n) + ", as the given knots make");
    return false;
  }
  spec->control_points = n;
  return true;
}

bool ApplyKnots(FitRequest* request, std::string* error) {
  FitSpec* spec = &request->spec;
  if (WasGiven("knots")) {
    spec->given_knots.clear();
    if (!FromString(FLAGS_knots, &spec->knots) && !ApplyKnotNumbers(request, error)) return false;
  }
  if (!WasGiven("ends")) return true;
  if (spec->closed || !spec->given_knots.empty()) {
    *error = RefusedFlag("ends", FLAGS_ends,
                         std::string("nothing, where ") +
                             (spec->closed ? "the curve is closed" : "the knots are given"));
    return false;
  }
  spec->ends = FLAGS_ends == "floating" ? EndKnots::kFloating : EndKnots::kEndInterpolating;
  return true;
}

bool ApplyDomain(FitSpec* spec, std::string* error) {
  if (!WasGiven("domain")) {
    // A catalogue problem's domain belongs to its own parameters.
    if (spec->parameters.has_value()) spec->domain.reset();
    return true;
  }
  std::vector<double> ends;
  if (!ParseNumbers(FLAGS_domain, &ends) || ends.size() != 2 || !(ends[0] < ends[1])) {
    *error = RefusedFlag("domain", FLAGS_domain, kAllowedDomain);
    return false;
  }
  if (spec->parameters.has_value() || !spec->given_knots.empty()) {
    *error = RefusedFlag("domain", FLAGS_domain,
                         "nothing, unless the parameters, but not the "
                         "knots, are given");
    return false;
  }
  spec->domain = {ends[0], ends[1]};
  return true;
}

bool ApplyTerms(FitSpec* spec, std::string* error) {
  if (!WasGiven("terms")) return true;
  bool is_good = ParseNameSpecList(FLAGS_terms, &spec->terms, error);
  for (const NameSpec& name : spec->terms) {
    const Term* term = nullptr;
    OptionValues options;
    is_good = is_good && TermRegistry::Global().Resolve(name, &term, &options, error);
  }
  if (!is_good) *error = "--terms: " + *error;
  return is_good;
}

bool ApplyGuardFlag(FitSpec* spec, std::string* error) {
  if (!WasGiven("guard")) return true;
  NameSpec guard;
  std::vector<NameSpec> terms;
  if (!ParseNameSpec(FLAGS_guard, &guard, error) || !ApplyGuard(guard, 1, &terms, error)) {
    *error = "--guard: " + *error;
    return false;
  }
  spec->guard = std::move(guard);
  return true;
}

bool ApplyConstraints(FitSpec* spec, std::string* error) {
  if (!WasGiven("constraints")) return true;
  bool is_good = ParseNameSpecList(FLAGS_constraints, &spec->constraints, error);
  for (const NameSpec& name : spec->constraints) {
    is_good = is_good && CheckConstraint(name, error);
  }
  if (!is_good) *error = "--constraints: " + *error;
  return is_good;
}

bool ApplyStart(FitRequest* request, std::string* error) {
  FitSpec* spec = &request->spec;
  spec->start_points.resize(0, 0);
  for (const char* word : {"data", "centroid", "circle", "ellipse"}) {
    if (FLAGS_start == word) {
      spec->start = word;
      return true;
    }
  }
  request->input_files.push_back(FLAGS_start);
  if (ReadFittedControlPoints(FLAGS_start, spec->degree, spec->closed, &spec->start_points,
                              error)) {
    return true;
  }
  std::error_code ignored;
  *error =
      std::filesystem::exists(FLAGS_start, ignored)
          ? "--start: " + *error
          : RefusedFlag("start", FLAGS_start,
                        "data, centroid, circle, ellipse or a file of batten fit --out; there is "
                        "no such file");
  return false;
}

bool FindInput(const std::vector<std::string>& positional, FitRequest* request,
               std::string* error) {
  const bool has_problem = WasGiven("problem");
  if (positional.size() + (has_problem ? 1 : 0) != 1) {
    *error = "fit: found " + std::to_string(positional.size()) + " files" +
             (has_problem ? " and --problem" : "") + "; allowed: one FILE or --problem";
    return false;
  }
  if (!has_problem) {
    const std::string& path = positional.front();
    request->entry.data_path = path;
    request->label = path == "-" ? "stdin" : path;
    request->source = request->label;
    request->input_files = {path};
    return true;
  }
  CatalogueEntry entry;
  if (!FindProblem(FLAGS_problem, &entry, error)) {
    *error = "--problem: " + *error;
    return false;
  }
  *request = {entry.spec, entry, entry.name, entry.path, {entry.data_path, entry.path}};
  return true;
}

}  // namespace

std::vector<FlagInfo> FitRequestFlags() {
  constexpr double kLowestDegree = 1.0;
  std::vector<FlagInfo> flags = {
      TextFlag("problem", "NAME", "a name of batten list problems, a problem file"),
      SwitchFlag("closed"),
      NumberFlag("degree", "P", kLowestDegree, kMaxDegree),
      NumberFlag("control_points", "N", 1.0, kMaxControlPoints),
      WordFlag("parameters", {"uniform", "chord_length", "centripetal", "given"}),
      TextFlag("knots", "KNOTS", kAllowedKnots),
      WordFlag("ends", {"end_interpolating", "floating"}),
      TextFlag("domain", "A,B", kAllowedDomain),
      TextFlag("terms", "TERMS", "terms of batten list terms, separated by commas"),
      TextFlag("start", "START", "data, centroid, circle, ellipse, or a file of batten fit"),
      WordFlag("parameter_kind", {"fixed", "free", "projected"}),
      SwitchFlag("hold_ends"),
      SwitchFlag("keep_order"),
      TextFlag("guard", "GUARD", "none, length or bending, with /weight=W"),
      TextFlag("constraints", "LIST", "constraints of docs/constraints.md, with commas between")};
  flags.push_back(MaxDistanceFlag());
  for (FlagInfo& flag : FairingFlags()) flags.push_back(std::move(flag));
  return flags;
}

bool MakeFitRequest(const std::vector<std::string>& positional, FitRequest* request,
                    std::string* error) {
  if (!FindInput(positional, request, error)) return false;
  FitSpec* spec = &request->spec;
  if (WasGiven("closed")) spec->closed = FLAGS_closed;
  if (WasGiven("degree")) spec->degree = FLAGS_degree;
  if (WasGiven("control_points")) spec->control_points = FLAGS_control_points;
  if (WasGiven("start") && !ApplyStart(request, error)) return false;
  if (WasGiven("parameter_kind")) FromString(FLAGS_parameter_kind, &spec->parameter_kind);
  if (WasGiven("hold_ends")) spec->hold_ends = FLAGS_hold_ends;
  if (WasGiven("keep_order")) spec->keep_order = FLAGS_keep_order;
  if (WasGiven("parameters")) {
    Parameterization rule = Parameterization::kUniform;
    spec->parameters.reset();
    if (FromString(FLAGS_parameters, &rule)) spec->parameters = rule;
  }
  if (!ApplyKnots(request, error) || !ApplyDomain(spec, error) || !ApplyTerms(spec, error) ||
      !ApplyGuardFlag(spec, error) || !ApplyConstraints(spec, error)) {
    return false;
  }
  // A search for a distance refuses them all.
  if (!AsksForMaxDistance() && !CheckFairingFlags(*spec, error)) return false;
  if (spec->given_knots.empty() && !AsksForMaxDistance()) {
    const int fewest = spec->closed ? 1 : spec->degree + 1;
    if (spec->control_points < fewest) {
      const std::string found =
          spec->control_points == 0 ? "nothing" : std::to_string(spec->control_points);
      *error = "--control_points: found " + found + "; allowed: " + std::to_string(fewest) +
               " to " + std::to_string(kMaxControlPoints) +
               (spec->closed ? "" : " (degree + 1 or more for an open curve)");
      return false;
    }
  }
  return true;
}

std::unique_ptr<Problem> LoadFit(const FitRequest& request, std::optional<FairingChoice>* choice,
                                 std::string* error) {
  std::optional<DataSet> data = LoadData(request.entry, error);
  if (!data.has_value()) return nullptr;
  FitSpec spec = request.spec;
  if (!ApplyFairingFlags(request.source, *data, &spec, choice, error)) return nullptr;
  std::unique_ptr<Problem> problem = MakeFitProblem(std::move(*data), std::move(spec), error);
  if (problem == nullptr) *error = request.source + ": " + *error;
  return problem;
}

}  // namespace batten
