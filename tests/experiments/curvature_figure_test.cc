#include "experiments/curvature_figure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "experiments/curve_fairness.h"
#include "tests/experiments/outlines.h"
#include "tests/solvers/test_fits.h"

namespace batten {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(CurvatureFigure, ShowsTheFitBesideTheOneWithoutFairing) {
  const auto rhino = LoadCatalogueProblem("rhino");
  FitSpec spec = rhino->curve_fit()->spec();
  std::string error;
  ASSERT_TRUE(ParseNameSpecList("interpolation,fairing/weight=1e-2", &spec.terms, &error));
  const auto problem = MakeFitProblem(rhino->curve_fit()->data(), spec, &error);
  ASSERT_NE(problem, nullptr) << error;
  const std::vector<NamedCurve> curves =
      FitBesideOthers(*problem, RunSolver(*problem, "banded_qr").x);
  ASSERT_EQ(curves.size(), 3U);
  EXPECT_EQ(curves[1].name, "without fairing");
  EXPECT_LT(MeasureFairness(curves[0].curve).curvature_variation,
            0.5 * MeasureFairness(curves[1].curve).curvature_variation);
  const std::vector<PlotPanel> panels = CurvaturePanels(curves);
  ASSERT_EQ(panels.size(), 4U);
  EXPECT_EQ(panels[3].series.size(), 3U);
  EXPECT_EQ(FitBesideOthers(*rhino, RunSolver(*rhino, "banded_qr").x).size(), 2U);
}

TEST(CurvatureFigure, ShowsTheCurveThatInterpolatesTheData) {
  for (const bool closed : {false, true}) {
    const DataSet data = MakeNoisyLoop(40, 2, 11);
    const auto problem = MakeFit(data, MakeSpec(3, closed, 12, "interpolation"));
    const std::vector<NamedCurve> curves =
        FitBesideOthers(*problem, RunSolver(*problem, "banded_qr").x);
    ASSERT_EQ(curves.size(), 2U);
    EXPECT_EQ(curves[1].name, "interpolating curve");
    EXPECT_EQ(curves[1].curve.basis().periodic(), closed);
    const Points at = curves[1].curve.Sample(problem->curve_fit()->parameters());
    EXPECT_LT((at - data.points).cwiseAbs().maxCoeff(), 1e-10);
    // It bends through the noise, much more than three times as sharply as the fit.
    const std::vector<PlotPanel> panels = CurvaturePanels(curves);
    ASSERT_EQ(panels.size(), 3U);
    EXPECT_THAT(panels[1].title, HasSubstr("interpolating curve (cut at kappa "));
    EXPECT_THAT(panels[0].title, StartsWith("fit"));
    const std::vector<double>& drawn = panels[2].series[0].y;
    const std::vector<double>& fit = panels[2].series[1].y;
    EXPECT_LE(*std::max_element(drawn.begin(), drawn.end()),
              3.0 * *std::max_element(fit.begin(), fit.end()));
  }
}

TEST(CurvatureFigure, LeavesOutACurveThatCannotInterpolate) {
  DataSet data = MakeNoisyLoop(40, 2, 11);
  data.parameters = Eigen::VectorXd::LinSpaced(40, 0.0, 1.0);
  (*data.parameters)[20] = (*data.parameters)[19];
  FitSpec spec = MakeSpec(3, false, 12, "interpolation");
  spec.parameters.reset();
  const auto problem = MakeFit(data, spec);
  EXPECT_EQ(FitBesideOthers(*problem, RunSolver(*problem, "banded_qr").x).size(), 1U);
}

}  // namespace
}  // namespace batten
