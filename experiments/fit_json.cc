#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cost_functions/options.h"
#include "experiments/build_info.h"
#include "experiments/curvature_figure.h"
#include "experiments/fit_report.h"
#include "problems/curve_constraints.h"
#include "solvers/plugin_loader.h"

namespace batten {
namespace {

using Json = nlohmann::ordered_json;

/// Text that reads back to the same double; no finite number: null.
std::string JsonNumber(double value) {
  if (!std::isfinite(value)) return "null";
  // "-0" would be read as an integer, which has no negative zero.
  return value == 0.0 && std::signbit(value) ? "-0.0" : NumberText(value);
}

void WriteNumbers(const double* values, Eigen::Index count, std::ostream* stream) {
  *stream << '[';
  for (Eigen::Index i = 0; i < count; ++i) {
    if (i > 0) *stream << ", ";
    *stream << JsonNumber(values[i]);
  }
  *stream << ']';
}

void WriteRows(const Points& points, const char* separator, std::ostream* stream) {
  *stream << '[';
  for (Eigen::Index j = 0; j < points.rows(); ++j) {
    *stream << (j > 0 ? "," : "") << separator;
    WriteNumbers(points.data() + j * points.cols(), points.cols(), stream);
  }
  *stream << ']';
}

std::string Dump(const Json& value) {
  // Names and messages may hold anything a user typed: bad UTF-8 is replaced, not thrown at.
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Energy of each term at the end, in the user's units.
Json TermEnergies(const Problem& problem, const RunResult& run) {
  Json terms = Json::array();
  for (const Problem::TermInstance& term : problem.terms()) {
    double energy = 0.0;
    const BlockFamily& family = *term.family;
    const bool known = run.x.size() == problem.num_variables() &&
                       family.Evaluate(run.x, 0, family.size(), &energy, nullptr) == Status::kOk;
    if (!known) energy = std::numeric_limits<double>::quiet_NaN();
    terms.push_back({{"name", term.name}, {"energy", energy * problem.units().energy}});
  }
  return terms;
}

/// Where constraints at parameters that are found hold, in the order of their numbers.
Json ConstraintParameters(const Problem& problem, const RunResult& run) {
  Json places = Json::array();
  for (const VariableRange& range : problem.ranges()) {
    if (range.name != kConstraintParameters || run.x.size() != problem.num_variables()) continue;
    for (const double t : run.x.segment(range.begin, range.size)) {
      places.push_back(problem.curve_fit()->basis().Wrap(t));
    }
  }
  return places;
}

Json ShapeJson(const FitReport& report) {
  if (!report.shape.has_value()) return nullptr;
  const CurveShape& shape = *report.shape;
  return {{"length", shape.length},
          {"turning", shape.turning},
          {"rotation", shape.rotation},
          {"max_distance_to_data", shape.max_distance_to_data},
          {"num_free_loops", shape.num_free_loops},
          {"longest_free_arc", shape.longest_free_arc}};
}

/// The parameters of places, or their curvatures.
Json PlacesJson(const std::vector<CurvaturePlace>& places, double CurvaturePlace::*field) {
  Json numbers = Json::array();
  for (const CurvaturePlace& place : places) numbers.push_back(place.*field);
  return numbers;
}

Json FairnessJson(const FitReport& report) {
  if (!report.fairness.has_value()) return nullptr;
  const CurveFairness& fairness = *report.fairness;
  const bool plane = fairness.num_inflections >= 0;
  return {{"bending_energy", fairness.bending_energy},
          {"curvature_variation", fairness.curvature_variation},
          {"max_curvature", fairness.max_curvature},
          {"max_curvature_at", fairness.max_curvature_at},
          {"num_curvature_extrema", fairness.num_curvature_extrema},
          {"num_inflections", plane ? Json(fairness.num_inflections) : Json(nullptr)},
          {"curvature_extrema", PlacesJson(fairness.curvature_extrema, &CurvaturePlace::t)},
          {"extreme_curvatures", PlacesJson(fairness.curvature_extrema, &CurvaturePlace::kappa)},
          {"inflections", plane ? Json(fairness.inflections) : Json(nullptr)}};
}

/// What draws the curvature and its comb, as columns: samples as the figure's, but fewer.
Json CurvatureJson(const Problem& problem, const RunResult& run, const FitReport& report) {
  if (!report.fairness.has_value()) return nullptr;
  constexpr int kMostSamplesWritten = 1000;
  const BsplineCurve curve = problem.curve_fit()->Curve(run.x);
  const std::vector<CurvatureSample> samples = SampleCurvatureUpTo(curve, kMostSamplesWritten);
  const double tooth_length = ToothLength({samples});
  Json json = {{"t", Json::array()},     {"arc_length", Json::array()},
               {"kappa", Json::array()}, {"points", Json::array()},
               {"tips", Json::array()},  {"tooth_length", tooth_length}};
  for (const CurvatureSample& sample : samples) {
    const bool is_known = std::isfinite(sample.kappa);
    const std::array<double, kMaxDimension> tip = ToothTip(sample, tooth_length);
    json["t"].push_back(sample.t);
    json["arc_length"].push_back(sample.s);
    json["kappa"].push_back(is_known ? Json(sample.kappa) : Json(nullptr));
    json["points"].push_back(std::vector<double>(sample.point, sample.point + curve.dimension()));
    json["tips"].push_back(
        is_known ? Json(std::vector<double>(tip.begin(), tip.begin() + curve.dimension()))
                 : Json(nullptr));
  }
  return json;
}

Json FairingChoiceJson(const FitReport& report) {
  if (!report.fairing_choice.has_value()) return nullptr;
  const FairingChoice& choice = *report.fairing_choice;
  return {{"rule", ToString(choice.rule)}, {"weight", choice.weight},
          {"score", choice.chosen.score},  {"residual", choice.chosen.residual},
          {"bend", choice.chosen.bend},    {"effective_control_points", choice.chosen.trace},
          {"noise", choice.noise},         {"solves", choice.samples.size()},
          {"seconds", choice.seconds},     {"warning", FairingChoiceWarning(choice)}};
}

/// Everything of fit.json but the spline and the parameters, which may be long.
Json Header(const Problem& problem, const RunResult& run, const RunSpec& spec,
            const FitReport& report) {
  const Counts& counts = run.counts;
  Json json;
  json["problem"] = problem.name();
  json["energy"] = run.energy;
  json["energy_at_foot_points"] = report.energy_at_foot_points;
  json["terms"] = TermEnergies(problem, run);
  json["gradient_norm"] = run.gradient_norm;
  const bool is_constrained = problem.nonlinear_constraints() != nullptr;
  json["constraint_violation"] = is_constrained ? Json(run.violation) : Json(nullptr);
  json["constraint_parameters"] = ConstraintParameters(problem, run);
  json["distance"] = {{"rms", report.rms},
                      {"max", report.max},
                      {"rms_orthogonal", report.rms_orthogonal},
                      {"max_orthogonal", report.max_orthogonal},
                      {"num_ties", report.num_ties.has_value() ? Json(*report.num_ties) : Json()}};
  json["shape"] = ShapeJson(report);
  json["fairness"] = FairnessJson(report);
  json["curvature"] = CurvatureJson(problem, run, report);
  json["fairing_choice"] = FairingChoiceJson(report);
  const CurveFit* const fit = problem.curve_fit();
  const bool weighs_spans = fit != nullptr && !fit->spec().span_weights.empty();
  json["span_weights"] = weighs_spans ? Json(fit->spec().span_weights) : Json(nullptr);
  json["solver"] = run.solver.ToString();
  json["options"] = run.options;
  json["mode"] = ToString(spec.mode);
  json["seed"] = spec.seed;
  json["threads"] = spec.threads;
  json["stop"] = ToString(run.outcome.reason);
  json["message"] = run.outcome.message;
  json["notes"] = Json::array();
  for (const auto& [name, value] : run.notes) {
    json["notes"].push_back({{"name", name}, {"value", value}});
  }
  json["iterations"] = run.iterations;
  json["counts"] = {
      {"energy_calls", counts.energy_calls},     {"gradient_calls", counts.gradient_calls},
      {"jacobian_calls", counts.jacobian_calls}, {"products", counts.products},
      {"projections", counts.projections},       {"distinct_points", counts.distinct_points}};
  json["seconds"] = run.seconds;
  json["setup_seconds"] = run.setup_seconds;
  json["cpu_seconds"] = run.cpu_seconds;
  json["start"] = {{"energy", run.start_energy}, {"gradient_norm", run.start_gradient_norm}};
  json["audit"] = nullptr;
  if (report.audited) {
    json["audit"] = {{"verified", report.verdict.holds},
                     {"failure", report.verdict.failure},
                     {"energy", report.audit.energy},
                     {"gradient_norm", report.audit.gradient_norm},
                     {"covers_gradient", report.audit.covers_gradient},
                     {"projected_gradient_norm", report.audit.projected_gradient_norm},
                     {"gradient_floor", report.audit.gradient_floor},
                     {"missed", report.audit.missed},
                     {"constraint_violation", report.audit.violation},
                     {"rms", report.audit.rms_distance},
                     {"max", report.audit.max_distance},
                     {"num_sharing", report.audit.num_sharing}};
  }
  json["version"] = kVersion;
  json["commit"] = kGitCommit;
  for (const LoadedPlugin& plugin : LoadedPlugins()) {
    json["plugins"][plugin.path] = plugin.sha256;
  }
  return json;
}

}  // namespace

void WriteFitJson(const Problem& problem, const RunResult& run, const RunSpec& spec,
                  const FitReport& report, std::ostream* stream) {
  *stream << "{\n  \"format\": \"batten.fit/1\"";
  if (const CurveFit* fit = problem.curve_fit()) {
    const BsplineBasis& basis = fit->basis();
    *stream << ",\n  \"spline\": {\n    \"degree\": " << basis.degree()
            << ",\n    \"periodic\": " << (basis.periodic() ? "true" : "false")
            << ",\n    \"dimension\": " << fit->dimension() << ",\n    \"knots\": ";
    WriteNumbers(basis.knots().data(), static_cast<Eigen::Index>(basis.knots().size()), stream);
    *stream << ",\n    \"control_points\": ";
    const bool is_complete = run.x.size() == problem.num_variables();
    WriteRows(is_complete ? fit->ControlPoints(run.x) : Points(), "\n      ", stream);
    *stream << "\n  },\n  \"parameter_kind\": \"" << ToString(fit->spec().parameter_kind)
            << "\",\n  \"parameters\": ";
    const Eigen::VectorXd t = is_complete ? fit->Parameters(run.x) : fit->parameters();
    WriteNumbers(t.data(), t.size(), stream);
  }
  const Json header = Header(problem, run, spec, report);
  for (const auto& [key, value] : header.items()) {
    *stream << ",\n  " << Dump(Json(key)) << ": " << Dump(value);
  }
  *stream << "\n}\n";
}

std::string FitJson(const Problem& problem, const RunResult& run, const RunSpec& spec,
                    const FitReport& report) {
  std::ostringstream stream;
  WriteFitJson(problem, run, spec, report, &stream);
  return stream.str();
}

std::string IteratesJsonLines(const Problem& problem, const RunResult& run) {
  const CurveFit* fit = problem.curve_fit();
  std::ostringstream stream;
  for (const Iterate& iterate : run.iterates) {
    stream << "{\"iteration\": " << iterate.iteration << ", \"control_points\": ";
    if (fit != nullptr) {
      WriteRows(fit->ControlPoints(iterate.x), "", &stream);
      stream << ", \"parameters\": ";
      const Eigen::VectorXd t = fit->Parameters(iterate.x);
      WriteNumbers(t.data(), t.size(), &stream);
    } else {
      WriteNumbers(iterate.x.data(), iterate.x.size(), &stream);
    }
    stream << "}\n";
  }
  return stream.str();
}

std::string RunTraceCsv(const Problem& problem, const RunResult& run) {
  std::vector<std::string> names;
  for (const Problem::TermInstance& term : problem.terms()) names.push_back(term.name);
  return TraceCsv(run.trace, names, problem.nonlinear_constraints() != nullptr);
}

}  // namespace batten
