#include "experiments/trace.h"

#include <gtest/gtest.h>

#include <limits>

#include "cost_functions/options.h"

namespace batten {
namespace {

constexpr char kColumns[] =
    "iteration,energy_calls,gradient_calls,jacobian_calls,products,projections,seconds,"
    "cpu_seconds,energy,gradient_norm,step_norm";

TraceRow SomeRow() {
  TraceRow row;
  row.iteration = 3;
  row.counts = {4, 5, 6, 7, 8, 9};
  row.seconds = 0.125;
  row.cpu_seconds = 0.25;
  row.energy = 0.1;
  row.gradient_norm = 1e-300;
  row.step_norm = 2.0;
  return row;
}

TEST(TraceCsv, HasOneLinePerIterationBelowTheHeader) {
  EXPECT_EQ(TraceCsv({SomeRow()}, {}),
            std::string(kColumns) + "\n3,4,5,6,7,8,0.125,0.25,0.1,1e-300,2\n");
  EXPECT_EQ(TraceCsv({}, {}), std::string(kColumns) + "\n");
}

TEST(TraceCsv, GivesEachTermItsColumn) {
  TraceRow row = SomeRow();
  row.term_energies = {0.0625, 0.5};
  EXPECT_EQ(TraceCsv({row}, {"interpolation", "fairing/weight=0.5"}),
            std::string(kColumns) +
                ",energy_interpolation,energy_fairing/weight=0.5\n"
                "3,4,5,6,7,8,0.125,0.25,0.1,1e-300,2,0.0625,0.5\n");
}

TEST(TraceCsv, GivesASingleTermTheWholeEnergy) {
  EXPECT_EQ(
      TraceCsv({SomeRow()}, {"interpolation"}),
      std::string(kColumns) + ",energy_interpolation\n3,4,5,6,7,8,0.125,0.25,0.1,1e-300,2,0.1\n");
}

TEST(TraceCsv, LeavesFieldsEmptyThatAreNoFiniteNumber) {
  TraceRow row = SomeRow();
  row.energy = std::numeric_limits<double>::quiet_NaN();
  row.gradient_norm = std::numeric_limits<double>::infinity();
  EXPECT_EQ(TraceCsv({row}, {"interpolation"}),
            std::string(kColumns) + ",energy_interpolation\n3,4,5,6,7,8,0.125,0.25,,,2,\n");
}

TEST(TraceCsv, QuotesATermNameThatWouldEndItsField) {
  const std::string text = TraceCsv({}, {"a,\"b\""});
  EXPECT_EQ(text, std::string(kColumns) + ",\"energy_a,\"\"b\"\"\"\n");
}

TEST(TraceCsv, WritesNumbersThatReadBackToTheSameDouble) {
  for (const double value : {0.1 + 0.2, 5e-324, 1.7976931348623157e308, -1.0 / 3.0}) {
    TraceRow row = SomeRow();
    row.step_norm = value;
    const std::string text = TraceCsv({row}, {});
    double read = 0.0;
    const std::size_t comma = text.rfind(',');
    ASSERT_TRUE(ParseNumber(text.substr(comma + 1, text.size() - comma - 2), &read)) << text;
    EXPECT_EQ(read, value);
  }
}

}  // namespace
}  // namespace batten
