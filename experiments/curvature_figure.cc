#include "experiments/curvature_figure.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "experiments/run.h"
#include "experiments/short_number.h"

namespace batten {
namespace {

using Samples = std::vector<CurvatureSample>;

/// Largest |kappa| but for the sharpest two percent, which would leave the other teeth invisible.
double UsualCurvature(const Samples& samples) {
  std::vector<double> sizes;
  for (const CurvatureSample& sample : samples) {
    if (std::isfinite(sample.kappa)) sizes.push_back(std::abs(sample.kappa));
  }
  if (sizes.empty()) return 0.0;
  const auto place = sizes.begin() + static_cast<std::ptrdiff_t>(0.98 * (sizes.size() - 1.0));
  std::nth_element(sizes.begin(), place, sizes.end());
  return *place;
}

double LongestSide(const Samples& samples) {
  double longest = 0.0;
  for (int c = 0; c < 2; ++c) {
    const auto [low, high] =
        std::minmax_element(samples.begin(), samples.end(),
                            [c](const auto& a, const auto& b) { return a.point[c] < b.point[c]; });
    longest = std::max(longest, high->point[c] - low->point[c]);
  }
  return longest;
}

PlotPanel CombPanel(const std::string& name, const Samples& samples, double tooth) {
  PlotPanel panel;
  panel.title = name;
  panel.equal_scale = true;
  panel.legend = false;
  PlotSeries curve, comb;
  curve.style = comb.style = PlotSeries::Style::kLine;
  comb.color = 1;
  // Some hundred teeth are seen one by one; the curve itself takes all samples.
  constexpr std::size_t kTeeth = 400;
  const std::size_t every = std::max<std::size_t>(1, samples.size() / kTeeth);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const CurvatureSample& sample = samples[i];
    curve.x.push_back(sample.point[0]);
    curve.y.push_back(sample.point[1]);
    if (i % every != 0 || !std::isfinite(sample.kappa)) continue;
    const std::array<double, kMaxDimension> tip = ToothTip(sample, tooth);
    for (const double* place : {sample.point, tip.data(), sample.point}) {
      comb.x.push_back(place[0]);
      comb.y.push_back(place[1]);
    }
  }
  panel.series = {comb, curve};
  return panel;
}

PlotSeries CurvatureSeries(const std::string& name, const Samples& samples, int color) {
  PlotSeries series;
  series.label = name;
  series.style = PlotSeries::Style::kLine;
  series.color = color;
  for (const CurvatureSample& sample : samples) {
    if (!std::isfinite(sample.kappa)) continue;
    series.x.push_back(sample.s / samples.back().s);
    series.y.push_back(sample.kappa);
  }
  return series;
}

/// Whether some curvature was beyond +-limit, which it is now.
bool CutAt(double limit, Samples* samples) {
  bool was_beyond = false;
  for (CurvatureSample& sample : *samples) {
    if (!(std::abs(sample.kappa) > limit)) continue;
    sample.kappa = std::copysign(limit, sample.kappa);
    was_beyond = true;
  }
  return was_beyond;
}

void AppendDirectFit(const std::string& name, DataSet data, const FitSpec& spec,
                     std::vector<NamedCurve>* curves) {
  std::string error;
  const std::unique_ptr<Problem> problem = MakeFitProblem(std::move(data), spec, &error);
  RunResult run;
  if (problem == nullptr || !Run(*problem, {"banded_qr", {}, nullptr}, {}, &run, &error) ||
      !run.skipped.empty() || !IsSuccess(run.outcome.reason)) {
    return;
  }
  curves->push_back({name, problem->curve_fit()->Curve(run.x), true});
}

/// The data without weights by increasing parameter; nothing where one curve cannot pass them.
std::optional<DataSet> InOrderOfParameters(const CurveFit& fit) {
  constexpr Eigen::Index kMost = 20'000;
  const Eigen::VectorXd& t = fit.parameters();
  const BsplineBasis& basis = fit.basis();
  if (t.size() > kMost || t.size() <= basis.degree()) return std::nullopt;
  std::vector<Eigen::Index> order(static_cast<std::size_t>(t.size()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::sort(order.begin(), order.end(), [&t](auto a, auto b) { return t[a] < t[b]; });
  DataSet data = fit.data();
  data.weights.reset();
  data.parameters.emplace(t.size());
  for (Eigen::Index i = 0; i < t.size(); ++i) {
    data.points.row(i) = fit.data().points.row(order[static_cast<std::size_t>(i)]);
    (*data.parameters)[i] = t[order[static_cast<std::size_t>(i)]];
    if (i > 0 && !((*data.parameters)[i] > (*data.parameters)[i - 1])) return std::nullopt;
  }
  return data;
}

FitSpec InterpolationSpec(const CurveFit& fit) {
  FitSpec spec;
  spec.degree = fit.basis().degree();
  spec.closed = fit.basis().periodic();
  spec.control_points = static_cast<int>(fit.parameters().size());
  spec.parameters.reset();
  spec.knots = KnotRule::kAveraged;
  spec.domain = {fit.basis().domain_begin(), fit.basis().domain_end()};
  return spec;
}

}  // namespace

double ToothLength(const std::vector<std::vector<CurvatureSample>>& curves) {
  constexpr double kLongestTooth = 0.15;  // of the longest side
  double largest = 0.0, side = 0.0;
  for (const Samples& samples : curves) {
    largest = std::max(largest, UsualCurvature(samples));
    side = std::max(side, LongestSide(samples));
  }
  return largest > 0.0 ? kLongestTooth * side / largest : 0.0;
}

std::array<double, kMaxDimension> ToothTip(const CurvatureSample& sample, double tooth_length) {
  std::array<double, kMaxDimension> tip = {};
  for (std::size_t c = 0; c < tip.size(); ++c) {
    tip[c] = sample.point[c] - tooth_length * std::abs(sample.kappa) * sample.normal[c];
  }
  return tip;
}

std::vector<PlotPanel> CurvaturePanels(const std::vector<NamedCurve>& curves) {
  constexpr int kMostSamples = 20'000;
  // One sharp bend, or all of a curve through noise, would leave nothing else to be seen.
  constexpr double kCutAt = 3.0;
  std::vector<Samples> all, judged;
  double largest = 0.0;
  for (const NamedCurve& named : curves) {
    all.push_back(SampleCurvatureUpTo(named.curve, kMostSamples));
    if (named.is_for_comparison) continue;
    judged.push_back(all.back());
    largest = std::max(largest, UsualCurvature(all.back()));
  }
  const double tooth = ToothLength(judged);
  std::vector<PlotPanel> panels;
  PlotPanel curvature;
  curvature.title = "curvature";
  curvature.x_label = "part of the arc length";
  curvature.y_label = "kappa";
  for (std::size_t i = 0; i < curves.size(); ++i) {
    std::string title = curves[i].name;
    if (largest > 0.0 && CutAt(kCutAt * largest, &all[i])) {
      title += " (cut at kappa " + ShortNumber(kCutAt * largest, 2) + ")";
    }
    panels.push_back(CombPanel(title, all[i], tooth));
    // Drawn first what is drawn over: the last curve moves most.
    curvature.series.insert(curvature.series.begin(),
                            CurvatureSeries(title, all[i], static_cast<int>(i)));
  }
  panels.push_back(std::move(curvature));
  return panels;
}

std::vector<NamedCurve> FitBesideOthers(const Problem& problem, const Eigen::VectorXd& x) {
  const CurveFit& fit = *problem.curve_fit();
  std::vector<NamedCurve> curves = {{"fit", fit.Curve(x)}};
  FitSpec spec = fit.spec();
  const auto is_fairing = [](const NameSpec& term) {
    return term.name == "fairing" || term.name == "curve_fairing";
  };
  const auto end = std::remove_if(spec.terms.begin(), spec.terms.end(), is_fairing);
  const bool is_fair = end != spec.terms.end() && end != spec.terms.begin();
  if (is_fair && fit.basis().num_control_points() < fit.parameters().size()) {
    spec.terms.erase(end, spec.terms.end());
    spec.parameters.reset();
    spec.given_knots = fit.basis().knots();
    DataSet data = fit.data();
    data.parameters = fit.parameters();
    AppendDirectFit("without fairing", std::move(data), spec, &curves);
  }
  std::optional<DataSet> ordered = InOrderOfParameters(fit);
  if (ordered.has_value()) {
    AppendDirectFit("interpolating curve", *std::move(ordered), InterpolationSpec(fit), &curves);
  }
  return curves;
}

}  // namespace batten
