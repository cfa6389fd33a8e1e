#include "experiments/report_document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "experiments/report_traces.h"
#include "tests/experiments/report_folder.h"

namespace batten {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class ReportDocumentTest : public ReportFolder {};

TEST_F(ReportDocumentTest, PutsWhatAllRowsShareInOnePlace) {
  Write("cells.jsonl",
        "{\"problem\": \"a\", \"solver\": \"cg\", \"mode\": \"race\", \"basin\": 1}\n"
        "{\"problem\": \"a\", \"solver\": \"gim\", \"mode\": \"race\"}\n");
  ASSERT_TRUE(Read()) << error_;
  const json cells = Summary()["cells"];
  EXPECT_EQ(cells["common"], json::parse("{\"problem\": \"a\", \"mode\": \"race\"}"));
  EXPECT_EQ(cells["fields"], json::parse("[\"solver\", \"basin\"]"));
  EXPECT_EQ(cells["rows"], json::parse("[[\"cg\", 1], [\"gim\", null]]"));
  EXPECT_EQ(document_.num_cells, 2);
}

TEST_F(ReportDocumentTest, OfRowsWithOneKeyTheLastCounts) {
  Write("cells.jsonl",
        "{\"key\": \"1\", \"solver\": \"cg\"}\n{\"key\": \"2\", \"solver\": \"gim\"}\n"
        "{\"key\": \"1\", \"solver\": \"newton\"}\n");
  ASSERT_TRUE(Read()) << error_;
  EXPECT_EQ(Summary()["cells"]["rows"], json::parse("[[\"1\", \"newton\"], [\"2\", \"gim\"]]"));
}

TEST_F(ReportDocumentTest, LeavesOutCellsThatTheSuiteNoLongerHas) {
  Write("cells.jsonl",
        "{\"key\": \"a\", \"problem\": \"p\"}\n{\"key\": \"b\", \"problem\": \"p\"}\n"
        "{\"key\": \"c\", \"problem\": \"p\"}\n");
  Write("manifest.json", "{\"format\": \"batten.manifest/1\", \"cells\": [\"c\", \"d\", \"a\"]}");
  ASSERT_TRUE(Read()) << error_;
  EXPECT_EQ(Summary()["group_of"].size(), 2u);
  EXPECT_THAT(Summary()["notes"].dump(),
              ::testing::HasSubstr("of cells that the suite had before: 1"));
}

// Rows stand in the order in which they were finished, which differs from run to run.
TEST_F(ReportDocumentTest, HasTheCellsOfABenchmarkInTheOrderOfItsSuite) {
  Write("cells.jsonl",
        "{\"key\": \"c\", \"problem\": \"r\"}\n{\"key\": \"a\", \"problem\": \"q\"}\n"
        "{\"key\": \"b\", \"problem\": \"p\"}\n");
  Write("manifest.json", "{\"format\": \"batten.manifest/1\", \"cells\": [\"b\", \"c\", \"a\"]}");
  ASSERT_TRUE(Read()) << error_;
  EXPECT_EQ(Summary()["cells"]["rows"],
            json::parse("[[\"b\", \"p\"], [\"c\", \"r\"], [\"a\", \"q\"]]"));
  EXPECT_EQ(Summary()["groups"][0]["problem"], "p");
}

TEST_F(ReportDocumentTest, LeavesOutATornLastLineAndSaysSo) {
  Write("cells.jsonl", "{\"solver\": \"cg\"}\n{\"solver\": \"gi");
  ASSERT_TRUE(Read()) << error_;
  EXPECT_EQ(document_.num_cells, 1);
  EXPECT_THAT(Summary()["notes"][0].get<std::string>(), HasSubstr("cells.jsonl:2: the last line"));
}

TEST_F(ReportDocumentTest, NamesTheLineThatIsNoRow) {
  Write("cells.jsonl", "{\"solver\": \"cg\"}\n\nnonsense\n{\"solver\": \"gim\"}\n");
  EXPECT_FALSE(Read());
  EXPECT_EQ(error_,
            folder_ + "/cells.jsonl:3: found \"nonsense\"; allowed: one JSON object a line");
}

TEST_F(ReportDocumentTest, RefusesAKeyThatLeadsOutOfTheFolder) {
  Write("cells.jsonl", "{\"key\": \"../secret\"}\n");
  EXPECT_FALSE(Read());
  EXPECT_THAT(error_, HasSubstr("cells.jsonl:1: /key: found \"../secret\"; allowed: letters"));
}

TEST_F(ReportDocumentTest, RefusesFoldersWithoutResults) {
  EXPECT_FALSE(Read());
  EXPECT_THAT(error_, HasSubstr(folder_ + ": found no results; allowed: a folder that compare"));
  Write("file", "");
  EXPECT_FALSE(ReadReportDocument(folder_ + "/file", limits_, &document_, &error_));
  EXPECT_THAT(error_, HasSubstr("/file: found a file; allowed: a folder"));
  EXPECT_FALSE(ReadReportDocument(folder_ + "/none", limits_, &document_, &error_));
  EXPECT_THAT(error_, HasSubstr("/none: found nothing there; allowed: a folder"));
}

TEST_F(ReportDocumentTest, HasTheNotesOfABenchmarkAlone) {
  Write("cells.jsonl", "{\"problem\": \"p\"}\n");
  Write("notes.md", "# small\n\nAll is finished.\n\n- a | own: cg: diverged\n");
  ASSERT_TRUE(Read()) << error_;
  EXPECT_TRUE(Summary()["bench_notes"].empty());
  Write("instances.jsonl", "{}\n");
  ASSERT_TRUE(Read()) << error_;
  EXPECT_EQ(Summary()["bench_notes"],
            json::parse("[\"All is finished.\", \"- a | own: cg: diverged\"]"));
}

TEST_F(ReportDocumentTest, NamesTheLineOfABrokenTrace) {
  Write("cells.jsonl", "{\"key\": \"a\"}\n");
  Write("traces/a.csv", "iteration,energy\n0,1\n1,two\n2,3\n");
  EXPECT_FALSE(Read());
  EXPECT_EQ(error_, folder_ + "/traces/a.csv:3: found \"two\"; allowed: a number");
  Write("traces/a.csv", "iteration,energy\n0\n2,3\n");
  EXPECT_FALSE(Read());
  EXPECT_THAT(error_, HasSubstr("a.csv:2: found 1 fields; allowed: 2, as in the header"));
  // Torn: its last number may have lost digits.
  Write("traces/a.csv", "iteration,energy\n0,9\n1,3");
  ASSERT_TRUE(Read()) << error_;
  EXPECT_EQ(Traces()["a"][0], 1);
  EXPECT_THAT(Summary()["notes"][0].get<std::string>(), HasSubstr("traces/a.csv:3: the last line"));
}

TEST_F(ReportDocumentTest, RoundsControlPointsToTheSizeOfTheStart) {
  Write("cells.jsonl", "{\"key\": \"a\", \"problem\": \"p\"}\n");
  Write("iterates/a.jsonl",
        "{\"iteration\": 0, \"control_points\": [[1, 2], [3, 2], [3, 3]]}\n"
        "{\"iteration\": 1, \"control_points\": [[1.5, 2.00011], [3, 2], [-1, 1e300]]}\n"
        "{\"iteration\": 2, \"control_points\": [[1, 2], [3, 2], [null, 3]]}\n");
  Write("curves/p.json",
        "{\"degree\": 1, \"periodic\": false, \"knots\": [0, 0, 1, 2, 2], \"points\": [[1, 2]]}");
  ASSERT_TRUE(Read()) << error_;
  const json run = Curves()["runs"]["a"];
  EXPECT_EQ(run["origin"], json::parse("[1, 2]"));
  EXPECT_EQ(run["unit"], 2e-4);
  EXPECT_EQ(run["iterations"], json::parse("[0, 1, 2]"));
  EXPECT_EQ(run["points"][0], json::parse("[0, 0, 10000, 0, 10000, 5000]"));
  EXPECT_EQ(run["points"][1], json::parse("[2500, 1, 10000, 0, -10000, null]"));
  EXPECT_EQ(run["points"][2], json::parse("[0, 0, 10000, 0, null, 5000]"));
  EXPECT_EQ(run["curve"], "p");
  EXPECT_EQ(Curves()["problems"]["p"]["degree"], 1);
}

TEST_F(ReportDocumentTest, DrawsRunsOfBenchByTheirInstancesAlikeOnesOnce) {
  Write("cells.jsonl",
        "{\"key\": \"a\", \"problem\": \"p/kind=free\", \"instance\": \"1\"}\n"
        "{\"key\": \"b\", \"problem\": \"p/kind=free\", \"instance\": \"2\"}\n"
        "{\"key\": \"c\", \"problem\": \"p/kind=free\", \"instance\": \"3\"}\n"
        "{\"key\": \"d\", \"problem\": \"p/kind=free\", \"instance\": \"4\"}\n");
  for (const char* key : {"a", "b", "c", "d"}) {
    Write(std::string("iterates/") + key + ".jsonl",
          "{\"iteration\": 0, \"control_points\": [[1, 2], [3, 2], [3, 3]]}\n");
  }
  const auto curve = [](const char* point) {
    return std::string("{\"degree\": 1, \"periodic\": false, \"knots\": [0, 0, 1, 2, 2], ") +
           "\"points\": [" + point + "]}";
  };
  Write("curves/1.json", curve("[1, 2]"));
  Write("curves/2.json", curve("[1, 2]"));
  Write("curves/3.json", curve("[5, 6]"));
  ASSERT_TRUE(Read()) << error_;
  const json curves = Curves();
  EXPECT_EQ(curves["runs"]["a"]["curve"], "1");
  EXPECT_EQ(curves["runs"]["b"]["curve"], "1");
  EXPECT_EQ(curves["runs"]["c"]["curve"], "3");
  EXPECT_EQ(curves["runs"]["d"]["curve"], "");  // none there: its control polygon alone
  EXPECT_EQ(curves["problems"].size(), 2u);
  EXPECT_EQ(curves["problems"]["3"]["points"], json::parse("[[5, 6]]"));
}

TEST_F(ReportDocumentTest, ReadsIteratesOfManyControlPoints) {
  constexpr int kPoints = 200'000;  // 5 MB a line
  std::string points = "[0.123456789012345, 0]";
  for (int i = 1; i < kPoints; ++i) points += ", [0.123456789012345, " + std::to_string(i) + "]";
  Write("cells.jsonl", "{\"key\": \"a\"}\n");
  Write("iterates/a.jsonl", "{\"iteration\": 0, \"control_points\": [" + points + "]}\n" +
                                "{\"iteration\": 5, \"control_points\": [" + points + "]}\n");
  ASSERT_TRUE(Read()) << error_;
  EXPECT_EQ(Curves()["runs"]["a"]["iterations"], json::parse("[0, 5]"));
  EXPECT_EQ(Curves()["runs"]["a"]["points"][1].size(), 2u * kPoints);
}

TEST_F(ReportDocumentTest, NamesTheLineOfABrokenIterate) {
  Write("cells.jsonl", "{\"key\": \"a\"}\n");
  Write("iterates/a.jsonl", "{\"iteration\": 0, \"control_points\": [[1, 2], [3]]}\n");
  EXPECT_FALSE(Read());
  EXPECT_THAT(error_, HasSubstr("iterates/a.jsonl:1: found no iterate; allowed: "));
}

TEST_F(ReportDocumentTest, ReadsTablesPicturesAndVerdictsOfAReproduction) {
  Write("order.csv", "# batten reproduce p order\n# tables:\nsolver,rate\ncg,0.5\n");
  Write("order.svg", "<svg/>");
  Write("order.dat", "1 0.5\n");
  Write("p.md",
        "# The paper\n\n## Verdicts\n\n| a | b | c |\n\n## Order\n\nText.\n\n"
        "> superlinear (Sec. 3)\n\n**does not hold**: the error falls by 0.5  \nRule: last rate\n\n"
        "![order](order.svg)\n\n*The error.*\n\nData: [order.csv](order.csv).\n");
  ASSERT_TRUE(Read()) << error_;
  const json summary = Summary();
  EXPECT_EQ(summary["tables"][0]["columns"], json::parse("[\"solver\", \"rate\"]"));
  EXPECT_EQ(summary["tables"][0]["rows"], json::parse("[[\"cg\", \"0.5\"]]"));
  EXPECT_EQ(summary["pictures"][0]["svg"], "<svg/>");
  EXPECT_EQ(summary["pictures"][0]["data"], "1 0.5\n");
  const json section = summary["pages"][0]["sections"][1];
  EXPECT_EQ(section["claims"][0]["quote"], "superlinear (Sec. 3)");
  EXPECT_EQ(section["claims"][0]["verdict"], "does not hold");
  EXPECT_EQ(section["claims"][0]["because"], "the error falls by 0.5");
  EXPECT_EQ(section["claims"][0]["rule"], "last rate");
  EXPECT_EQ(section["pictures"][0]["caption"], "The error.");
  EXPECT_EQ(section["tables"], json::parse("[\"order.csv\"]"));
}

TEST_F(ReportDocumentTest, LeavesOutTheDataOfAPictureThatIsTooLargeAndSaysSo) {
  Write("t.csv", "a\n1\n");
  Write("a.svg", "<svg/>");
  Write("a.dat", std::string(100, '1'));
  Write("b.svg", "<svg/>");
  limits_.picture_bytes = 50;
  ASSERT_TRUE(Read()) << error_;
  const json pictures = Summary()["pictures"];
  ASSERT_EQ(pictures.size(), 2u);
  EXPECT_FALSE(pictures[0].contains("data"));
  EXPECT_THAT(Summary()["notes"][0].get<std::string>(), HasSubstr("a.svg: what it plots is not"));
}

constexpr char kPanel[] =
    "{\"title\":\"T\",\"x_label\":\"x\",\"y_label\":\"y\",\"log_x\":false,\"log_y\":true,"
    "\"equal_scale\":false,\"is_share\":false,\"legend\":true,\"x_names\":[],\"series\":[";

std::string PlotWith(const std::string& series) {
  return std::string("{\"format\":\"batten.plot/1\",\"columns\":1,\"panels\":[") + kPanel + series +
         "]}]}";
}

TEST_F(ReportDocumentTest, ReadsThePanelsOfFiguresAndThinsLongLines) {
  Write("t.csv", "a\n1\n");
  Write("a.svg", "<svg/>");
  Write("a.plot.json",
        PlotWith("{\"label\":\"cg\",\"style\":\"dashed\",\"color\":3,\"x\":[1,2,3,4,5],"
                 "\"y\":[0.5,null,0.25,0.1,0.123456789]}"));
  Write("b.plot.json", PlotWith(""));
  limits_.points_per_series = 3;
  ASSERT_TRUE(Read()) << error_;
  const json summary = Summary();
  EXPECT_EQ(summary["pictures"][0]["panels"], json::parse("[\"T\"]"));
  EXPECT_EQ(summary["pictures"][1]["name"], "b.svg");  // gnuplot was not there
  EXPECT_THAT(summary["notes"][0].get<std::string>(), HasSubstr("a: the plot has 3 of 5 points"));
  const json series = json::parse(document_.plots)["a"][0]["series"][0];
  EXPECT_EQ(series["x"], json::parse("[1, 3, 5]"));
  EXPECT_EQ(series["y"], json::parse("[0.5, 0.25, 0.123457]"));
  EXPECT_EQ(series["num_points"], 5);
  EXPECT_EQ(series["style"], "dashed");
}

TEST_F(ReportDocumentTest, ThinsAllPlotsWhereTogetherTheyAreTooMany) {
  Write("t.csv", "a\n1\n");
  const json numbers = std::vector<int>(1000, 1);
  const json series = {
      {"label", ""}, {"style", "line"}, {"color", 0}, {"x", numbers}, {"y", numbers}};
  for (const char* name : {"a", "b", "c"}) {
    Write(std::string(name) + ".plot.json", PlotWith(series.dump()));
  }
  limits_.plot_points = 1600;
  ASSERT_TRUE(Read()) << error_;
  EXPECT_EQ(json::parse(document_.plots)["c"][0]["series"][0]["x"].size(), 500u);
  EXPECT_EQ(Summary()["notes"].size(), 3u);
}

TEST_F(ReportDocumentTest, NamesTheFieldOfAPlotThatIsWrong) {
  Write("t.csv", "a\n1\n");
  const std::pair<std::string, const char*> cases[] = {
      {"[]", "a.plot.json: found no plot; allowed: an object of format batten.plot/1"},
      {PlotWith("{\"label\":\"\",\"style\":\"dots\",\"color\":0,\"x\":[],\"y\":[]}"),
       "a.plot.json: /panels/0/series/0/style: found another thing or nothing; allowed: line, "
       "points"},
      {PlotWith("{\"label\":\"\",\"style\":\"line\",\"color\":0,\"x\":[1],\"y\":[]}"),
       "a.plot.json: /panels/0/series/0/x: found another thing or nothing; allowed: two lists"},
      {"{\"format\":\"batten.plot/1\",\"panels\":[{\"title\":3}]}",
       "a.plot.json: /panels/0/title: found another thing or nothing; allowed: text"}};
  for (const auto& [text, message] : cases) {
    Write("a.plot.json", text);
    EXPECT_FALSE(Read()) << text;
    EXPECT_THAT(error_, HasSubstr(message));
  }
}

TEST_F(ReportDocumentTest, NamesTheRowOfATableThatIsTooShort) {
  Write("t.csv", "a,b\n1,2\n3\n");
  EXPECT_FALSE(Read());
  EXPECT_THAT(error_, HasSubstr("t.csv:3: found 1 fields; allowed: 2, as in the header"));
}

TEST_F(ReportDocumentTest, KeepsTheEndOfALongLogAndReplacesBadBytes) {
  Write("cells.jsonl", "{\"key\": \"a\"}\n");
  Write("logs/a.log", std::string(100, 'x') + "\xff the end");
  limits_.log_bytes = 10;
  ASSERT_TRUE(Read()) << error_;
  EXPECT_EQ(Summary()["logs"]["a"], "[the last 10 of 109 bytes]\nx\xef\xbf\xbd the end");
}

TEST(CsvFields, FollowsRfc4180) {
  EXPECT_THAT(CsvFields("a,\"b,c\",\"d \"\"e\"\"\","), ElementsAre("a", "b,c", "d \"e\"", ""));
  EXPECT_THAT(CsvFields("a\r"), ElementsAre("a"));
}

}  // namespace
}  // namespace batten
