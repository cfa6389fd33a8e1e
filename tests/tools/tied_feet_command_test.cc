// Points with several closest points on the curve, as `fit` tells of them; run as a process.
#include <gmock/gmock.h>

#include <cmath>

#include "cost_functions/options.h"
#include "tests/tools/program.h"

namespace batten {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

struct Fitted {
  json file;
  std::string summary;
};

/// Fits a closed cubic to an ellipse with half-axes 2 and 1, both of which it is symmetric to, and
/// measures `more` beside it, points of weight 0.
Fitted FitEllipseBeside(const std::vector<std::pair<double, double>>& more) {
  constexpr int kPoints = 16;
  std::string points = "t,x,y,weight\n";
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2.0 * M_PI * i / kPoints;
    points += NumberText(static_cast<double>(i) / kPoints) + "," +
              NumberText(2.0 * std::cos(angle)) + "," + NumberText(std::sin(angle)) + ",1\n";
  }
  for (const auto& [x, y] : more) {
    points += "0.3," + NumberText(x) + "," + NumberText(y) + ",0\n";
  }
  const TemporaryFolder folder;
  const Ended ended =
      RunBatten({"fit", folder.Write("ellipse.csv", points), "--closed", "--control_points=8",
                 "--parameters=given", "--solver=banded_qr", "--out=" + (folder / "fit.json")});
  EXPECT_EQ(ended.status, 0) << ended.err;
  return {json::parse(ReadFile(folder / "fit.json"), nullptr, false), ended.out};
}

TEST(FitCommand, SaysHowManyPointsAreAsNearToAnotherPointOfTheCurve) {
  // By symmetry: the long axis between the centres of curvature (at 1.5 of a true ellipse) is as
  // near to either side; the centre too.
  const Fitted two = FitEllipseBeside({{0.5, 0.0}, {0.0, 0.0}, {0.5, 0.01}});
  EXPECT_EQ(two.file["distance"]["num_ties"], 2);
  EXPECT_THAT(two.summary,
              HasSubstr(" 2 points are as near to another point of the curve as to the foot\n"));
  const Fitted one = FitEllipseBeside({{-0.75, 0.0}});
  EXPECT_EQ(one.file["distance"]["num_ties"], 1);
  EXPECT_THAT(one.summary, HasSubstr(" 1 point is as near to another point of the curve"));
}

TEST(FitCommand, SaysNothingOfTiesWhereEveryFootIsOne) {
  // On the long axis, but beyond the centre of curvature of the vertex; on the short axis, and
  // outside.
  const Fitted none = FitEllipseBeside({{1.8, 0.0}, {0.0, 0.5}, {0.0, -3.0}, {4.0, 0.0}});
  EXPECT_EQ(none.file["distance"]["num_ties"], 0);
  EXPECT_THAT(none.summary, Not(HasSubstr("as near to another point")));
}

}  // namespace
}  // namespace batten
