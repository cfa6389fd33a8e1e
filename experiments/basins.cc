#include "experiments/basins.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "problems/fit_problem.h"
#include "splines/closest_point.h"

namespace batten {
namespace {

Points SampleSpans(const BsplineCurve& curve) {
  constexpr int kPerSpan = 16;
  const BsplineBasis& basis = curve.basis();
  std::vector<double> t;
  for (int k = basis.first_span(); k <= basis.last_span(); ++k) {
    const double low = basis.knots()[k], high = basis.knots()[k + 1];
    for (int i = 0; i < kPerSpan && low < high; ++i) t.push_back(low + i * (high - low) / kPerSpan);
  }
  t.push_back(basis.domain_end());
  return curve.Sample(
      Eigen::Map<const Eigen::VectorXd>(t.data(), static_cast<Eigen::Index>(t.size())));
}

/// The longest side of the box around the points.
double LongestSide(const Points& points) {
  return (points.colwise().maxCoeff() - points.colwise().minCoeff()).maxCoeff();
}

double LargestDistance(const Points& samples, const BsplineCurve& curve) {
  Eigen::VectorXd t = Eigen::VectorXd::Constant(samples.rows(), curve.basis().domain_begin());
  Eigen::VectorXd squared;
  ClosestPoint(curve).FindAll(samples, 1, &t, &squared);
  return std::sqrt(squared.maxCoeff());
}

/// In the user's units; not a number where E has no value.
double EnergyAt(const Problem& problem, const Eigen::VectorXd& x) {
  double sum = 0.0;
  for (const Problem::TermInstance& term : problem.terms()) {
    const BlockFamily& family = *term.family;
    if (family.Evaluate(x, 0, family.size(), &sum, nullptr) != Status::kOk) return std::nan("");
  }
  return sum * problem.units().energy;
}

/// Whether rho(r^2) bends upwards everywhere: rho' + 2 s rho'' >= 0 at s = r^2.
bool IsConvex(const ceres::LossFunction& loss) {
  constexpr int kFarthest = 60;  // squared residuals of 2^-60 to 2^60 of the data's size
  for (int k = -kFarthest; k <= kFarthest; ++k) {
    const double s = std::ldexp(1.0, k);
    double rho[3];
    loss.Evaluate(s, rho);
    constexpr double kRounding = 1e-12;
    if (rho[1] + 2.0 * s * rho[2] < -kRounding * std::abs(rho[1])) return false;
  }
  return true;
}

}  // namespace

bool MayHaveSeveralMinima(const Problem& problem) {
  const CurveFit* fit = problem.curve_fit();
  if (fit == nullptr) return false;
  if (fit->spec().parameter_kind != ParameterKind::kFixed) return true;
  for (const Problem::TermInstance& term : problem.terms()) {
    if (term.family->rows() != nullptr) continue;
    if (term.family->rows_without_loss() == nullptr) return true;
    if (!IsConvex(*term.family->loss())) return true;
  }
  return false;
}

double EnergyAtFootPoints(const CurveFit& fit, const Points& control_points) {
  const BsplineCurve curve(fit.basis(), control_points);
  Eigen::VectorXd t = fit.parameters();
  Eigen::VectorXd squared;
  ClosestPoint(curve).FindAll(fit.data().points, 1, &t, &squared);
  return fit.data().weights.has_value() ? fit.data().weights->dot(squared) : squared.sum();
}

BasinEnd Polish(const Problem& problem, const Eigen::VectorXd& x, double max_seconds) {
  RunSpec spec;
  spec.start = x;
  spec.gradient_tolerance = 0.0;
  spec.max_iterations = 2000;
  spec.max_seconds = max_seconds;
  spec.keep_trace = false;
  NameSpec newton;
  newton.name = "newton";
  RunResult run;
  std::string error;
  BasinEnd end;
  const bool ran = Run(problem, newton, spec, &run, &error) && run.skipped.empty();
  const Eigen::VectorXd& last = ran ? run.x : x;
  end.control_points = problem.curve_fit()->ControlPoints(last);
  end.energy = ran ? run.energy : EnergyAt(problem, x);
  end.energy_at_foot_points = EnergyAtFootPoints(*problem.curve_fit(), end.control_points);
  end.polished =
      ran && (IsSuccess(run.outcome.reason) || run.outcome.reason == StopReason::kLineSearchEnded);
  return end;
}

double CurveDistanceBetween(const BsplineCurve& a, const BsplineCurve& b) {
  return std::max(LargestDistance(SampleSpans(a), b), LargestDistance(SampleSpans(b), a));
}

std::vector<int> FindBasins(const Problem& problem, const std::vector<BasinEnd>& ends) {
  const CurveFit& fit = *problem.curve_fit();
  if (fit.spec().parameter_kind != ParameterKind::kFixed) {
    return FindBasins(fit.basis(), fit.size(), ends);
  }
  std::vector<BasinEnd> by_energy = ends;
  for (BasinEnd& end : by_energy) end.energy_at_foot_points = end.energy;
  return FindBasins(fit.basis(), fit.size(), by_energy);
}

std::vector<int> FindBasins(const BsplineBasis& basis, double size,
                            const std::vector<BasinEnd>& ends) {
  std::vector<std::size_t> order(ends.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&ends](std::size_t a, std::size_t b) {
    return ends[a].energy_at_foot_points < ends[b].energy_at_foot_points;
  });
  // One curve has one energy: only ends with like energies have to be compared as curves. At a
  // distance of kSameCurve E differs by its first-order part, which a minimum does not have.
  constexpr double kLikeEnergies = 1e-4;
  // Below it no data point is kSameCurve away, and how energies compare is rounding.
  const double all_fit = std::pow(kSameCurve * size, 2);
  std::vector<std::size_t> firsts;  // of the basins
  std::vector<int> basins(ends.size(), -1);
  for (const std::size_t k : order) {
    const BsplineCurve curve(basis, ends[k].control_points);
    for (std::size_t b = firsts.size(); b-- > 0 && basins[k] < 0;) {
      const BasinEnd& first = ends[firsts[b]];
      const double energy = ends[k].energy_at_foot_points;
      const double apart = energy - first.energy_at_foot_points;
      if (apart > kLikeEnergies * energy && energy > all_fit) break;
      const BsplineCurve other(basis, first.control_points);
      // Far from the data E hardly says where a curve is, and rounding is the larger there.
      const double larger = std::max(size, LongestSide(first.control_points));
      if (CurveDistanceBetween(curve, other) < kSameCurve * larger) {
        basins[k] = static_cast<int>(b);
      }
    }
    if (basins[k] >= 0) continue;
    basins[k] = static_cast<int>(firsts.size());
    firsts.push_back(k);
  }
  return basins;
}

}  // namespace batten
