#include "experiments/fit_report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

#include "experiments/audited_constraints.h"
#include "experiments/audited_terms.h"
#include "problems/free_view.h"
#include "splines/closest_point.h"

namespace batten {
namespace {

/// What the terms that are distances from the data together weigh.
double DistanceWeight(const Problem& problem) {
  double weight = 0.0;
  for (const Problem::TermInstance& term : problem.terms()) {
    if (IsDistanceTerm(term, *problem.curve_fit())) weight += term.family->weight();
  }
  return weight;
}

/// Where the audit knows all terms.
bool AuditApplies(const Problem& problem) {
  AuditedFit ignored;
  return DistanceWeight(problem) > 0.0 && AddTerms(problem, &ignored);
}

std::vector<ParameterState> ParameterStates(const Problem& problem, const Eigen::VectorXd& x) {
  const CurveFit& fit = *problem.curve_fit();
  if (!fit.has_free_parameters()) return {};
  const std::unique_ptr<FreeView> view = FreeView::Make(problem);
  const auto m = fit.parameters().size();
  const auto is_held = [&](int i) {
    return view != nullptr ? view->is_held(i) : fit.setting().ends_held && (i == 0 || i == m - 1);
  };
  const Eigen::VectorXd t = fit.OrderedIfKept(x.segment(fit.setting().parameter_offset, m));
  std::vector<ParameterState> states(static_cast<std::size_t>(m));
  for (int place = 0; place < m; ++place) {
    const auto i = static_cast<std::size_t>(place);
    if (is_held(place)) {
      states[i] = ParameterState::kHeld;
    } else {
      states[i] = PlaceOnCurve(fit.basis(), t[place]).moves ? ParameterState::kMoves
                                                            : ParameterState::kPastEnd;
    }
  }
  return states;
}

/// Which points share a parameter because the order is kept; empty where it is not.
std::vector<int> SharedParameters(const CurveFit& fit, const Eigen::VectorXd& x) {
  if (!fit.setting().keep_order) return {};
  const int held = fit.setting().ends_held ? 1 : 0;
  std::vector<int> blocks =
      fit.Order(x.segment(fit.setting().parameter_offset, fit.parameters().size())).BlockOf();
  // Those that are held come to no block: any number will do.
  blocks.insert(blocks.begin(), static_cast<std::size_t>(held), 0);
  blocks.insert(blocks.end(), static_cast<std::size_t>(held), 0);
  return blocks;
}

AuditedFit PlainNumbers(const Problem& problem, const Eigen::VectorXd& x) {
  const auto copy = [](const auto& matrix) {
    return std::vector<double>(matrix.data(), matrix.data() + matrix.size());
  };
  const CurveFit& fit = *problem.curve_fit();
  AuditedFit plain;
  plain.degree = fit.basis().degree();
  plain.periodic = fit.basis().periodic();
  plain.dimension = fit.dimension();
  plain.knots = fit.basis().knots();
  plain.control_points = copy(fit.ControlPoints(x));
  plain.points = copy(fit.data().points);
  plain.parameters = copy(fit.Parameters(x));
  plain.parameter_states = ParameterStates(problem, x);
  plain.parameter_blocks = SharedParameters(fit, x);
  plain.at_foot_points = fit.is_projected();
  plain.length = problem.units().length;
  if (fit.data().weights.has_value()) plain.weights = copy(*fit.data().weights);
  AddTerms(problem, &plain);
  AddConstraints(problem, x, &plain);
  return plain;
}

/// Distances at the parameters t.
void MeasureDistances(const CurveFit& fit, const BsplineCurve& curve, const Eigen::VectorXd& t,
                      FitReport* report) {
  const Points& points = fit.data().points;
  const Eigen::VectorXd distances = (curve.Sample(t) - points).rowwise().norm();
  report->rms = std::sqrt(distances.squaredNorm() / static_cast<double>(points.rows()));
  report->max = distances.maxCoeff();
}

/// Distances at the foot points, which replace the parameters they are searched from.
void MeasureFootPoints(const CurveFit& fit, const BsplineCurve& curve, double term_weight,
                       Eigen::VectorXd* feet, FitReport* report) {
  const Points& points = fit.data().points;
  const std::vector<FootPoint> found = ClosestPoint(curve).FindAll(
      points, static_cast<int>(std::max(1U, std::thread::hardware_concurrency())), *feet, true);
  Eigen::VectorXd squared_distances(points.rows());
  report->num_ties = 0;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const FootPoint& foot = found[static_cast<std::size_t>(i)];
    (*feet)[i] = foot.parameter;
    squared_distances[i] = foot.squared_distance;
    *report->num_ties += foot.tie ? 1 : 0;
    const double weight = fit.data().weights.has_value() ? (*fit.data().weights)[i] : 1.0;
    report->energy_at_foot_points += term_weight * weight * squared_distances[i];
  }
  report->rms_orthogonal = std::sqrt(squared_distances.sum() / static_cast<double>(points.rows()));
  report->max_orthogonal = std::sqrt(squared_distances.maxCoeff());
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
  const BsplineCurve curve = fit->Curve(run.x);
  const double weight = DistanceWeight(problem);
  report.audited = AuditApplies(problem);
  Eigen::VectorXd feet = fit->Parameters(run.x);
  MeasureDistances(*fit, curve, feet, &report);
  MeasureFootPoints(*fit, curve, weight, &feet, &report);
  report.shape = ShapeBesideData(*fit, curve, feet);
  if (curve.dimension() >= 2) report.fairness = MeasureFairness(curve);
  if (report.audited) {
    report.audit = Audit(PlainNumbers(problem, run.x));
    Claim claim = ClaimOf(run, spec);
    constexpr double kHeld = 1e-10;  // docs/constraints.md
    claim.violation_target = kHeld * fit->size();
    report.verdict = Verify(claim, report.audit);
  }
  return report;
}

std::optional<CurveShape> ShapeBesideData(const CurveFit& fit, const BsplineCurve& curve,
                                          const Eigen::VectorXd& feet) {
  if (fit.dimension() < 2) return std::nullopt;
  if (!fit.data().weights.has_value()) return MeasureShape(curve, fit.data().points, feet);
  std::vector<Eigen::Index> counted;
  for (Eigen::Index i = 0; i < feet.size(); ++i) {
    if ((*fit.data().weights)[i] > 0.0) counted.push_back(i);
  }
  return MeasureShape(curve, fit.data().points(counted, Eigen::all), feet(counted));
}

Claim ClaimOf(const RunResult& run, const RunSpec& spec) {
  // A direct answer to a problem whose rank is cut off at 1e-11 of the largest diagonal entry is a
  // minimum to about ten digits of the gradient at the start, whatever was asked of the others.
  constexpr double kDirect = 1e-10;
  Claim claim;
  claim.energy = run.energy;
  claim.gradient_norm = run.gradient_norm;
  claim.start_energy = run.start_energy;
  claim.violation = run.violation;
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

}  // namespace batten
