// The command `report`, run as a process; what the page does is tried by tests/report/run.sh.
#include <gmock/gmock.h>

#include "tests/tools/page_text.h"
#include "tests/tools/program.h"

namespace batten {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::size_t Count(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

TEST(ReportCommand, ShowsWhatCompareWrote) {
  const TemporaryFolder folder;
  const std::string out = folder / "out";
  ASSERT_EQ(
      RunBatten({"compare", "--problems=rhino,rhino_free", "--solvers=cg,foot_newton",
                 "--repetitions=1", "--nofigures", "--keep_iterates=5", "--out=" + out, "--quiet"})
          .status,
      0);
  const Ended ended = RunBatten({"report", out});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.out, "Page: " + out + "/report.html  (4 rows)\n");
  const std::string page = ReadFile(out + "/report.html");
  const nlohmann::json summary = nlohmann::json::parse(ScriptText(page, "summary-data"));
  EXPECT_EQ(summary["cells"]["rows"].size(), 4u);
  EXPECT_EQ(summary["groups"][0]["direct"], true);
  EXPECT_EQ(summary["groups"][1]["direct"], false);
  // rhino by cg and rhino_free by foot_newton; the other two do not apply.
  const nlohmann::json traces = nlohmann::json::parse(ScriptText(page, "traces-data"));
  const nlohmann::json curves = nlohmann::json::parse(ScriptText(page, "curves-data"));
  EXPECT_EQ(traces.size(), 2u);
  EXPECT_EQ(curves["runs"].size(), 2u);
  for (const nlohmann::json& run : curves["runs"]) EXPECT_LE(run["points"].size(), 5u);
  EXPECT_EQ(curves["problems"]["rhino"]["points"].size(), 100u);
  EXPECT_EQ(curves["problems"]["rhino"]["periodic"], true);
}

TEST(ReportCommand, TracesOfCompareAreThoseOfFit) {
  const TemporaryFolder folder;
  const std::string out = folder / "out";
  ASSERT_EQ(RunBatten({"compare", "--problems=rhino", "--solvers=cg", "--repetitions=1",
                       "--nofigures", "--out=" + out, "--quiet"})
                .status,
            0);
  const std::string key =
      nlohmann::json::parse(ReadFile(out + "/cells.jsonl"))["key"].get<std::string>();
  ASSERT_EQ(
      RunBatten({"fit", "--problem=rhino", "--solver=cg", "--trace=" + (folder / "t.csv")}).status,
      0);
  // All columns but the times.
  const auto without_times = [](const std::string& text) {
    std::vector<std::string> lines = Lines(text);
    for (std::string& line : lines) {
      std::size_t begin = 0;
      for (int k = 0; k < 6; ++k) begin = line.find(',', begin) + 1;
      line.erase(begin, line.find(',', line.find(',', begin) + 1) - begin);
    }
    return lines;
  };
  EXPECT_EQ(without_times(ReadFile(out + "/traces/" + key + ".csv")),
            without_times(ReadFile(folder / "t.csv")));
  EXPECT_GT(Lines(ReadFile(folder / "t.csv")).size(), 10u);
}

TEST(ReportCommand, NoTextOfTheDataEndsItsScript) {
  const TemporaryFolder folder;
  const std::string hostile = "</script><b>bold</b><!--<script>\xe2\x80\xa8{{curves}}";
  const nlohmann::json row = {{"problem", hostile}, {"solver", hostile},
                              {"key", "k"},         {"options", {{hostile, hostile}}},
                              {"message", hostile}, {"stop", "stalled"}};
  folder.Write("cells.jsonl", row.dump() + "\n");
  std::filesystem::create_directory(folder / "logs");
  folder.Write("logs/k.log", hostile);
  folder.Write("bad.svg", "<svg onload=\"alert(1)\"></svg><script>alert(2)</script>");
  const Ended ended = RunBatten({"report", folder / "", "--out=" + (folder / "r.html")});
  ASSERT_EQ(ended.status, 0) << ended.err;
  const std::string page = ReadFile(folder / "r.html");
  EXPECT_THAT(page, Not(HasSubstr("<b>bold")));
  EXPECT_THAT(page, Not(HasSubstr("<!--<script>")));
  EXPECT_THAT(page, Not(HasSubstr("alert(2)</script>")));
  EXPECT_THAT(ScriptText(page, "summary-data"), Not(HasSubstr("\xe2\x80\xa8")));
  const nlohmann::json summary = nlohmann::json::parse(ScriptText(page, "summary-data"));
  EXPECT_EQ(summary["logs"]["k"], hostile);
  // Four of data, three of the library, one of the page.
  EXPECT_EQ(Count(page, "</script>"), 8u);
}

TEST(ReportCommand, TheProgramHoldsTheFilesOfThePageAsTheyStand) {
  const TemporaryFolder folder;
  folder.Write("t.csv", "a\n1\n");
  ASSERT_EQ(RunBatten({"report", folder / ""}).status, 0);
  const std::string page = ReadFile(folder / "report.html");
  const std::string source = std::string(BATTEN_SOURCE_DIR) + "/tools/report/";
  for (const char* name :
       {"report.css", "data.js", "charts.js", "plots.js", "costs.js", "profiles.js", "pairs.js",
        "tables.js", "sections.js", "folder.js", "player.js", "report.js", "vendor/vega.min.js",
        "vendor/vega-lite.min.js", "vendor/vega-embed.min.js"}) {
    const std::string text = ReadFile(source + name);
    EXPECT_GT(text.size(), 1000u) << name;
    EXPECT_NE(page.find(text), std::string::npos) << name;
  }
  // Nothing to be fetched: the addresses in the library are names of formats.
  EXPECT_THAT(page, Not(HasSubstr("<script src")));
  EXPECT_THAT(page, Not(HasSubstr("@import")));
}

TEST(ReportCommand, NamesWhatIsWrongInOneLineAndWritesNothing) {
  const TemporaryFolder folder;
  const auto expect_refused = [&folder](const std::vector<std::string>& arguments,
                                        const std::string& what) {
    const Ended ended = RunBatten(arguments);
    EXPECT_EQ(ended.status, 2) << what;
    EXPECT_EQ(ended.out, "");
    EXPECT_EQ(Lines(ended.err).size(), 1u) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr(what));
    EXPECT_FALSE(std::filesystem::exists(folder / "report.html"));
  };
  expect_refused({"report"}, "report: found 0 folders; allowed: one");
  expect_refused({"report", folder / "", "b"}, "report: found 2 folders; allowed: one");
  expect_refused({"report", folder / "none"}, "found nothing there; allowed: a folder that");
  expect_refused({"report", folder / ""}, "found no results; allowed: a folder that");
  folder.Write("cells.jsonl", "{\"solver\": \"cg\"}\n[1]\n{\"solver\": \"gim\"}\n");
  expect_refused({"report", folder / ""}, "cells.jsonl:2: found \"[1]\"; allowed: one JSON object");
  folder.Write("cells.jsonl", "{\"solver\": \"cg\"}\n");
  expect_refused({"report", folder / "", "--out=" + (folder / "cells.jsonl")},
                 "which is read; allowed: another file");
  expect_refused({"report", folder / "", "--out=" + (folder / "none/r.html")}, "cannot write ");
}

TEST(ReportCommand, AFolderWithoutAFinishedRunHasAPage) {
  const TemporaryFolder folder;
  folder.Write("cells.jsonl", "");
  const Ended ended = RunBatten({"report", folder / ""});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("(0 rows)"));
}

TEST(ReportCommand, AFileWhereTracesBelongIsSeenBeforeAnythingRuns) {
  const TemporaryFolder folder;
  folder.Write("traces", "");
  const Ended ended = RunBatten({"compare", "--problems=rhino", "--solvers=cg", "--repetitions=1",
                                 "--nofigures", "--out=" + (folder / "")});
  EXPECT_EQ(ended.status, 2);
  EXPECT_EQ(ended.err, "--out: cannot write into " + (folder / "traces") + ": it is no folder\n");
  EXPECT_EQ(folder.Names(), std::vector<std::string>{"traces"});
}

TEST(ReportCommand, ItsIteratesAreKeptOnlyInAFolder) {
  const Ended ended =
      RunBatten({"compare", "--problems=rhino", "--solvers=cg", "--keep_iterates=5"});
  EXPECT_EQ(ended.status, 2);
  EXPECT_EQ(ended.err,
            "--keep_iterates: found without --out; allowed: with the folder to keep them in, "
            "without --starts\n");
}

}  // namespace
}  // namespace batten
