#include "experiments/fit_report.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "cost_functions/options.h"
#include "experiments/build_info.h"
#include "splines/closest_point.h"

namespace batten {
namespace {

using Json = nlohmann::ordered_json;

/// What the interpolation terms of `problem` together weigh; NaN if some term is another one, has a
/// loss, or the control points are constrained.
double InterpolationWeight(const Problem& problem) {
  double weight = 0.0;
  bool plain = problem.curve_fit() != nullptr && problem.elimination().trivial();
  for (const Problem::TermInstance& term : problem.terms()) {
    NameSpec name;
    std::string error;
    plain = plain && ParseNameSpec(term.name, &name, &error) && name.name == "interpolation" &&
            term.family->loss() == nullptr;
    weight += term.family->weight();
  }
  return plain ? weight : std::numeric_limits<double>::quiet_NaN();
}

AuditedFit PlainNumbers(const CurveFit& fit, const Points& control_points, double term_weight) {
  const auto copy = [](const auto& matrix) {
    return std::vector<double>(matrix.data(), matrix.data() + matrix.size());
  };
  AuditedFit plain;
  plain.degree = fit.basis().degree();
  plain.periodic = fit.basis().periodic();
  plain.dimension = fit.dimension();
  plain.knots = fit.basis().knots();
  plain.control_points = copy(control_points);
  plain.points = copy(fit.data().points);
  plain.parameters = copy(fit.parameters());
  if (fit.data().weights.has_value()) plain.weights = copy(*fit.data().weights);
  if (term_weight != 1.0) {
    plain.weights.resize(plain.parameters.size(), 1.0);
    for (double& weight : plain.weights) weight *= term_weight;
  }
  return plain;
}

void MeasureDistances(const CurveFit& fit, const Points& control_points, double term_weight,
                      FitReport* report) {
  const BsplineCurve curve(fit.basis(), control_points);
  const ClosestPoint closest(curve);
  const Points at_parameters = curve.Sample(fit.parameters());
  const Points& points = fit.data().points;
  Eigen::VectorXd feet = fit.parameters();
  Eigen::VectorXd squared_distances;
  closest.FindAll(points, static_cast<int>(std::max(1U, std::thread::hardware_concurrency())),
                  &feet, &squared_distances);
  double squares = 0.0;
  double squares_orthogonal = 0.0;
  double largest_orthogonal = 0.0;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const double squared = (at_parameters.row(i) - points.row(i)).squaredNorm();
    const double weight = fit.data().weights.has_value() ? (*fit.data().weights)[i] : 1.0;
    squares += squared;
    report->max = std::max(report->max, std::sqrt(squared));
    squares_orthogonal += squared_distances[i];
    largest_orthogonal = std::max(largest_orthogonal, squared_distances[i]);
    report->energy_at_foot_points += term_weight * weight * squared_distances[i];
  }
  const auto m = static_cast<double>(points.rows());
  report->rms = std::sqrt(squares / m);
  report->rms_orthogonal = std::sqrt(squares_orthogonal / m);
  report->max_orthogonal = std::sqrt(largest_orthogonal);
}

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
  json["distance"] = {{"rms", report.rms},
                      {"max", report.max},
                      {"rms_orthogonal", report.rms_orthogonal},
                      {"max_orthogonal", report.max_orthogonal}};
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
                     {"gradient_floor", report.audit.gradient_floor},
                     {"rms", report.audit.rms_distance},
                     {"max", report.audit.max_distance}};
  }
  json["version"] = kVersion;
  json["commit"] = kGitCommit;
  return json;
}

}  // namespace

FitReport MeasureFit(const Problem& problem, const RunResult& run, const RunSpec& spec) {
  FitReport report;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const CurveFit* fit = problem.curve_fit();
  if (fit == nullptr || run.x.size() != problem.num_variables() || !run.x.allFinite()) {
    report.rms = report.max = report.rms_orthogonal = report.max_orthogonal = nan;
    report.energy_at_foot_points = nan;
    return report;
  }
  const Points control_points = fit->ControlPoints(run.x);
  const double weight = InterpolationWeight(problem);
  report.audited = !std::isnan(weight);
  MeasureDistances(*fit, control_points, report.audited ? weight : 1.0, &report);
  if (report.audited) {
    report.audit = Audit(PlainNumbers(*fit, control_points, weight));
    report.verdict = Verify(ClaimOf(run, spec), report.audit);
  }
  return report;
}

Claim ClaimOf(const RunResult& run, const RunSpec& spec) {
  // A direct answer to a problem whose rank is cut off at 1e-11 of the largest diagonal entry is a
  // minimum to about ten digits of the gradient at the start, whatever was asked of the others.
  constexpr double kDirect = 1e-10;
  Claim claim;
  claim.energy = run.energy;
  claim.gradient_norm = run.gradient_norm;
  claim.start_energy = run.start_energy;
  const bool race = spec.mode == Mode::kRace;
  switch (run.outcome.reason) {
    case StopReason::kSolved:
      claim.minimum = true;
      claim.gradient_target = std::max(spec.gradient_tolerance, kDirect) * run.start_gradient_norm;
      break;
    case StopReason::kGradientSmall:
      claim.minimum = true;
      claim.gradient_target =
          race ? spec.gradient_tolerance * run.start_gradient_norm : spec.native_gradient;
      break;
    case StopReason::kRoundingFloor:
      claim.minimum = true;
      claim.gradient_target = run.gradient_floor;
      break;
    default:  // says nothing about a minimum; a small step (native) is no statement about |g|
      break;
  }
  return claim;
}

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
    WriteRows(run.x.size() == problem.num_variables() ? fit->ControlPoints(run.x) : Points(),
              "\n      ", stream);
    *stream << "\n  },\n  \"parameter_kind\": \"fixed\",\n  \"parameters\": ";
    WriteNumbers(fit->parameters().data(), fit->parameters().size(), stream);
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
      WriteNumbers(fit->parameters().data(), fit->parameters().size(), &stream);
    } else {
      WriteNumbers(iterate.x.data(), iterate.x.size(), &stream);
    }
    stream << "}\n";
  }
  return stream.str();
}

}  // namespace batten
