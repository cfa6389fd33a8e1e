#include "experiments/figure_panels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace batten {
namespace {

using ::testing::HasSubstr;

TEST(LayOutPanels, GivesEveryUnitTheSameLength) {
  FigurePanel wide;
  wide.horizontal = {"x", 1, -2.0, 18.0};
  wide.vertical = {"y", 2, 0.0, 3.0};
  FigurePanel tall;
  tall.horizontal = {"y", 2, 0.0, 3.0};
  tall.vertical = {"z", 3, 100.0, 110.0};
  for (const std::vector<FigurePanel>& panels :
       {std::vector<FigurePanel>{wide}, {tall}, {wide, tall, wide}}) {
    const FigureCanvas canvas = LayOutPanels(panels, true);
    const double scale = canvas.panels[0].width / canvas.panels[0].horizontal.length();
    for (const FigurePanel& panel : canvas.panels) {
      // Sides are rounded to pixels.
      EXPECT_NEAR(panel.width, scale * panel.horizontal.length(), 4.0);
      EXPECT_NEAR(panel.height, scale * panel.vertical.length(), 4.0);
      EXPECT_LT(panel.left + panel.width, canvas.width);
      EXPECT_LT(panel.bottom + panel.height, canvas.height);
    }
  }
}

TEST(TickStep, IsRoundAndWideEnough) {
  EXPECT_DOUBLE_EQ(TickStep(10.0, 100, 10), 1.0);
  EXPECT_DOUBLE_EQ(TickStep(10.1, 100, 10), 2.0);
  EXPECT_DOUBLE_EQ(TickStep(0.03, 100, 10), 0.005);
  EXPECT_DOUBLE_EQ(TickStep(7e5, 100, 10), 1e5);
}

TEST(FigureAxis, TakesARoundNumberOffDataFarFromTheOrigin) {
  EXPECT_EQ(FigureAxis({"x", 1, -2.0, 18.0}).offset(), 0.0);
  EXPECT_EQ(FigureAxis({"x", 1, -2.0, 18.0}).Column(), "1");
  // 2000040 still fits before the axis.
  EXPECT_EQ(FigureAxis({"x", 1, 2000000.0, 2000100.0}).offset(), 0.0);
  EXPECT_EQ(FigureAxis({"x", 1, 1.5e12, 2.5e12}).offset(), 0.0);
  const FigureAxis far = {"x", 2, 1e9 - 1.04, 1e9 + 1.04};
  EXPECT_EQ(far.offset(), 1e9);
  EXPECT_EQ(far.Column(), "($2-(1e+09))");
  EXPECT_EQ(FigureAxis({"x", 1, -1e9 - 1.04, -1e9 + 1.04}).offset(), -1e9);
}

TEST(PanelCommands, NamesTheOffsetOfAnAxis) {
  FigurePanel panel;
  panel.horizontal = {"x", 1, -1e9 - 2.0, -1e9 + 2.0};
  panel.vertical = {"y", 2, 1e9 - 2.0, 1e9 + 2.0};
  const FigureCanvas canvas = LayOutPanels({panel}, true);
  const std::string commands = PanelCommands(canvas, canvas.panels[0]);
  EXPECT_THAT(commands, HasSubstr("set xrange [-2:2]\n"));
  EXPECT_THAT(commands, HasSubstr("set xlabel 'x + 1e+09'"));
  EXPECT_THAT(commands, HasSubstr("set ylabel 'y - 1e+09'"));
}

}  // namespace
}  // namespace batten
