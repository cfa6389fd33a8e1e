#include <cmath>

#include "experiments/fairing_choice.h"

namespace batten {
namespace {

constexpr double FairingSample::*kWeight = &FairingSample::weight;
constexpr double FairingSample::*kResidual = &FairingSample::residual;

/// One number of the samples over another, the chosen one marked; what was not judged is left out.
PlotPanel Panel(const FairingChoice& choice, const std::string& title,
                double FairingSample::*x_value, double FairingSample::*y_value, bool log_y) {
  PlotPanel panel;
  panel.title = title;
  panel.x_label = x_value == kWeight ? "weight" : "RSS";
  panel.log_x = true;
  panel.log_y = log_y;
  panel.legend = false;
  PlotSeries tried, chosen;
  chosen.style = PlotSeries::Style::kCircles;
  chosen.color = 1;
  for (const FairingSample& sample : choice.samples) {
    if (std::isnan(sample.*y_value)) continue;
    tried.x.push_back(sample.*x_value);
    tried.y.push_back(sample.*y_value);
    if (sample.weight != choice.weight) continue;
    chosen.x.push_back(sample.*x_value);
    chosen.y.push_back(sample.*y_value);
  }
  panel.series = {tried, chosen};
  return panel;
}

}  // namespace

std::vector<PlotPanel> FairingChoicePanels(const FairingChoice& choice) {
  const bool is_l_curve = choice.rule == FairingRule::kLCurve;
  std::vector<PlotPanel> panels = {Panel(choice, std::string("choice by ") + ToString(choice.rule),
                                         kWeight, &FairingSample::score, !is_l_curve)};
  panels.back().y_label = ScoreName(choice.rule);
  if (is_l_curve) {
    panels.push_back(Panel(choice, "the L-curve", kResidual, &FairingSample::bend, true));
    panels.back().y_label = "bend: integral at weight 1";
  }
  panels.push_back(Panel(choice, "residual", kWeight, kResidual, true));
  panels.back().y_label = "RSS";
  panels.push_back(Panel(choice, "effective control points", kWeight, &FairingSample::trace, true));
  panels.back().y_label = "trace";
  return panels;
}

}  // namespace batten
