#include "experiments/csv_table.h"

#include <gmock/gmock.h>

#include <cmath>

namespace batten {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

CsvTable ReadTable(const std::string& text) {
  CsvTable table;
  std::string error;
  EXPECT_TRUE(CsvTable::FromCsv(text, &table, &error)) << error;
  return table;
}

TEST(CsvTable, ReadsBackWhatItWrites) {
  const std::string text = "solver,n\nlbfgs,10\ncg,20\ncg,30\n";
  const CsvTable table = ReadTable("# a comment\n" + text);
  EXPECT_EQ(table.ToCsv(), text);
  EXPECT_EQ(table.num_rows(), 3U);
  EXPECT_EQ(table.Text(1, "solver"), "cg");
  EXPECT_EQ(table.Number(1, "n"), 20.0);
  EXPECT_TRUE(std::isnan(table.Number(1, "solver")));
}

TEST(CsvTable, ChoosesRowsByTheirCells) {
  const CsvTable table = ReadTable("solver,n\nlbfgs,10\ncg,20\ncg,30\n");
  EXPECT_THAT(table.Where("solver", "cg").Numbers("n"), ElementsAre(20.0, 30.0));
  EXPECT_EQ(table.Where("solver", "newton").num_rows(), 0U);
  EXPECT_THAT(table.Distinct("solver"), ElementsAre("lbfgs", "cg"));
}

TEST(CsvTable, RefusesRowsThatAreNotAsLongAsTheHeader) {
  CsvTable table;
  std::string error;
  EXPECT_FALSE(CsvTable::FromCsv("a,b\n1,2\n3\n", &table, &error));
  EXPECT_THAT(error, HasSubstr("line 3: found 1 cells; allowed: 2"));
  EXPECT_FALSE(CsvTable::FromCsv("# nothing\n", &table, &error));
  EXPECT_THAT(error, HasSubstr("no header"));
}

}  // namespace
}  // namespace batten
