#include "experiments/max_distance_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "experiments/run_control.h"
#include "splines/closest_point.h"

namespace batten {
namespace {

// Roundings of a coordinate that lie between the search and the curve that is written: centring,
// scaling and back, and the evaluation of a point.
constexpr double kDistanceRoundings = 64.0;

/// The data points that count, without those that repeat the one before, in the unit box.
struct CountedPoints {
  std::vector<Eigen::Index> rows;  // in the data
  Points points;
  double scale = 1.0;  // a power of two
  Eigen::RowVectorXd center;
};

CountedPoints Count(const DataSet& data, bool closed) {
  CountedPoints counted;
  const auto counts = [&](Eigen::Index i) {
    return !data.weights.has_value() || (*data.weights)[i] > 0.0;
  };
  const auto same = [&](Eigen::Index i, Eigen::Index j) {
    return data.points.row(i) == data.points.row(j);
  };
  std::vector<Eigen::Index>& rows = counted.rows;
  for (Eigen::Index i = 0; i < data.points.rows(); ++i) {
    if (counts(i) && (rows.empty() || !same(rows.back(), i))) rows.push_back(i);
  }
  while (closed && rows.size() > 1 && same(rows.front(), rows.back())) rows.pop_back();
  counted.points = data.points(rows, Eigen::all);
  if (rows.empty()) return counted;
  const Eigen::RowVectorXd low = counted.points.colwise().minCoeff();
  const Eigen::RowVectorXd high = counted.points.colwise().maxCoeff();
  const double side = (high - low).maxCoeff();
  if (side > 0.0) counted.scale = std::exp2(-std::ceil(std::log2(side)));
  counted.center = low + 0.5 * (high - low);
  counted.points = (counted.points.rowwise() - counted.center) * counted.scale;
  return counted;
}

bool Check(const DataSet& data, const FitSpec& spec, double bound, const CountedPoints& counted,
           std::string* error) {
  if (data.points.cols() < 2) {
    *error = "max_distance needs points in the plane or in space; found dimension 1";
    return false;
  }
  const auto fewest = FewestControlPoints(spec.degree, spec.closed);
  const auto m = static_cast<int>(counted.rows.size());
  if (m < fewest) {
    *error = "max_distance finds " + std::to_string(m) + " points that count and differ from the " +
             "one before; a curve of degree " + std::to_string(spec.degree) + " needs at least " +
             std::to_string(fewest);
    return false;
  }
  const double least = LeastMaxDistance(data.points.cwiseAbs().maxCoeff());
  if (!(bound >= least)) {
    *error = "max_distance is " + NumberText(bound) +
             ", which the rounding of the data's coordinates does not allow; allowed: at least " +
             NumberText(least);
    return false;
  }
  return true;
}

/// Where the search left each data point; those that did not take part, at a neighbour's place.
Eigen::VectorXd StartsOfFeet(const TrackedCurve& found, const BsplineBasis& basis,
                             const CountedPoints& counted, Eigen::Index num_points) {
  Eigen::VectorXd starts(num_points);
  Eigen::Index next = 0;
  for (Eigen::Index i = 0; i < num_points; ++i) {
    const auto last = static_cast<Eigen::Index>(counted.rows.size()) - 1;
    while (next < last && counted.rows[static_cast<std::size_t>(next + 1)] <= i) ++next;
    starts[i] = basis.Wrap(found.parameter(static_cast<int>(next)));
  }
  return starts;
}

double LargestCounted(const CountedPoints& counted, const Eigen::VectorXd& squared_distances) {
  double largest = 0.0;
  for (const Eigen::Index i : counted.rows) largest = std::max(largest, squared_distances[i]);
  return std::sqrt(largest);
}

/// The curve as a problem in the user's units, parameters at certified feet.
bool MakeProblem(DataSet data, const FitSpec& asked, const TrackedCurve& found,
                 const CountedPoints& counted, MaxDistanceFit* fit, std::string* error) {
  const std::optional<BsplineCurve> curve = found.ToCurve();
  if (!curve.has_value()) {
    *error = "max_distance found knots that coincide";
    return false;
  }
  const Points control_points =
      (curve->control_points() / counted.scale).rowwise() + counted.center;
  Eigen::VectorXd feet = StartsOfFeet(found, curve->basis(), counted, data.points.rows());
  const BsplineCurve moved(curve->basis(), control_points);
  ClosestPoint(moved).FindAll(data.points, 1, &feet, nullptr);

  FitSpec spec;
  spec.name = asked.name;
  spec.degree = asked.degree;
  spec.closed = asked.closed;
  spec.given_knots = curve->basis().knots();
  spec.control_points = curve->basis().num_control_points();
  spec.parameters.reset();
  spec.start_points = control_points;
  data.parameters = feet;
  fit->problem = MakeFitProblem(data, std::move(spec), error);
  if (fit->problem == nullptr) return false;

  // What is written has been scaled once more: the certificate is of that curve.
  const CurveFit& written = *fit->problem->curve_fit();
  const BsplineCurve last = written.Curve(fit->problem->start());
  Eigen::VectorXd squared_distances(feet.size());
  ClosestPoint(last).FindAll(data.points, 1, &feet, &squared_distances);
  fit->largest_distance = LargestCounted(counted, squared_distances);
  return true;
}

/// Energy and gradient at the curve, which no solver moves.
bool Measure(double bound, const Stopwatch& watch, double cpu_seconds, MaxDistanceFit* fit,
             std::string* error) {
  RunSpec spec;
  spec.max_iterations = 0;
  if (!Run(*fit->problem, {"lbfgs", {}, nullptr}, spec, &fit->run, error)) return false;
  RunResult& run = fit->run;
  run.solver = {"max_distance", {}, nullptr};
  run.options = {{"bound", NumberText(bound)}};
  run.outcome.reason = StopReason::kNativeStop;
  run.outcome.message = "largest distance " + NumberText(fit->largest_distance) +
                        " at certified feet, allowed " + NumberText(bound);
  run.counts = {};
  run.trace.clear();
  run.notes.clear();
  run.observed_rate = std::numeric_limits<double>::quiet_NaN();
  run.setup_seconds = 0.0;
  run.seconds = watch.SecondsNow();
  run.cpu_seconds = cpu_seconds;
  return true;
}

}  // namespace

double LeastMaxDistance(double largest) {
  return 4.0 * kDistanceRoundings * std::numeric_limits<double>::epsilon() * largest;
}

bool FitWithinDistance(DataSet data, const FitSpec& spec, double bound, const SearchWatch& watch,
                       MaxDistanceFit* fit, std::string* error) {
  Stopwatch stopwatch;
  stopwatch.Resume();
  const CountedPoints counted = Count(data, spec.closed);
  if (!Check(data, spec, bound, counted, error)) return false;
  const auto parameters = Parameterize(spec.parameters.value_or(Parameterization::kChordLength),
                                       spec.closed, counted.points, error);
  if (!parameters.has_value()) return false;
  const double rounding = kDistanceRoundings * std::numeric_limits<double>::epsilon() *
                          data.points.cwiseAbs().maxCoeff();
  bool went_on = true;
  const auto found = SearchFewControlPoints(spec.degree, spec.closed, counted.points, *parameters,
                                            (bound - rounding) * counted.scale,
                                            [&](int num_control_points, double fraction) {
                                              return went_on = watch(num_control_points, fraction);
                                            });
  if (!found.has_value()) {
    *error = went_on ? "max_distance is " + NumberText(bound) +
                           ", which not even the spline through all points keeps; give a larger one"
                     : "interrupted; nothing was written";
    return false;
  }
  if (!MakeProblem(std::move(data), spec, *found, counted, fit, error)) return false;
  if (!(fit->largest_distance <= bound)) {
    *error = "max_distance is " + NumberText(bound) + ", but the certified distance is " +
             NumberText(fit->largest_distance) + "; give a larger one";
    return false;
  }
  stopwatch.Pause();
  return Measure(bound, stopwatch, stopwatch.cpu_seconds(), fit, error);
}

}  // namespace batten
