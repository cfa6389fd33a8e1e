#include "experiments/curvature_figure.h"

#include <algorithm>
#include <cmath>

#include "experiments/run.h"

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
  std::vector<Samples> all;
  for (const NamedCurve& named : curves) {
    all.push_back(SampleCurvatureUpTo(named.curve, kMostSamples));
  }
  const double tooth = ToothLength(all);
  std::vector<PlotPanel> panels;
  PlotPanel curvature;
  curvature.title = "curvature";
  curvature.x_label = "part of the arc length";
  curvature.y_label = "kappa";
  for (std::size_t i = 0; i < curves.size(); ++i) {
    panels.push_back(CombPanel(curves[i].name, all[i], tooth));
    // Drawn first what is drawn over: the last curve moves most.
    curvature.series.insert(curvature.series.begin(),
                            CurvatureSeries(curves[i].name, all[i], static_cast<int>(i)));
  }
  panels.push_back(std::move(curvature));
  return panels;
}

std::vector<NamedCurve> FitBesideTheUnfaired(const Problem& problem, const Eigen::VectorXd& x) {
  const CurveFit& fit = *problem.curve_fit();
  std::vector<NamedCurve> curves = {{"fit", fit.Curve(x)}};
  FitSpec spec = fit.spec();
  const auto is_fairing = [](const NameSpec& term) {
    return term.name == "fairing" || term.name == "curve_fairing";
  };
  const auto end = std::remove_if(spec.terms.begin(), spec.terms.end(), is_fairing);
  if (end == spec.terms.end() || end == spec.terms.begin()) return curves;
  spec.terms.erase(end, spec.terms.end());
  DataSet data = fit.data();
  data.parameters = fit.parameters();
  spec.parameters.reset();
  spec.given_knots = fit.basis().knots();
  std::string error;
  const std::unique_ptr<Problem> plain = MakeFitProblem(std::move(data), spec, &error);
  RunResult run;
  if (plain == nullptr || !Run(*plain, {"banded_qr", {}, nullptr}, {}, &run, &error) ||
      !run.skipped.empty() || !IsSuccess(run.outcome.reason)) {
    return curves;
  }
  curves.push_back({"without fairing", plain->curve_fit()->Curve(run.x)});
  return curves;
}

}  // namespace batten
