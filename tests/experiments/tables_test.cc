#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "experiments/comparison_tables.h"
#include "tests/not_a_number.h"
namespace batten {
namespace {

using ::testing::Contains;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;
using Json = nlohmann::json;

ComparisonRow Row(const std::string& problem, const std::string& solver, StopReason reason) {
  ComparisonRow row;
  row.problem = problem;
  row.solver = solver;
  row.run.outcome.reason = reason;
  row.run.iterations = 46;
  row.run.counts = {1, 52, 0, 51, 0, 52};
  row.run.energy = 4.486845758379909;
  row.run.start_energy = 83.8;
  row.run.gradient_norm = 1.0 / 3e9;
  row.run.observed_rate = 0.66612345;
  row.repetitions = 5;
  row.setup_seconds = 1.23456e-5;
  row.solve_seconds = 0.1 + 0.2;
  row.seconds = row.setup_seconds + row.solve_seconds;
  row.times_cholesky = 6.777;
  row.gap = 3.5e-20;
  row.distance_to_direct = 9.5e-12;
  row.report.audited = true;
  row.report.verdict.holds = true;
  return row;
}

/// Three solvers on two problems, with names that need escaping.
ComparisonResult SomeResult() {
  ComparisonResult result;
  result.spec.repetitions = 5;
  result.rows.push_back(Row("rhino_|_100%", "lbfgs/memory=10", StopReason::kGradientSmall));
  ComparisonRow gim = Row("rhino_|_100%", "gim", StopReason::kGradientSmall);
  gim.run.notes = {{"spectral radius of I - A", "0.66666666666666663"}};
  result.rows.push_back(gim);
  ComparisonRow skipped = Row("a, \"b\"", "gim", StopReason::kNotRun);
  skipped.problem_index = 1;
  skipped.run = RunResult();
  skipped.run.skipped = "gim needs 100 control points for 80 points";
  skipped.report = FitReport();
  result.rows.push_back(skipped);
  ComparisonRow ended = Row("a, \"b\"", "ceres_lbfgs", StopReason::kLineSearchEnded);
  ended.problem_index = 1;
  ended.run.outcome.message = "Ceres: step_size & {tolerance} < 1e-9 #1 ~ $^\\";
  ended.run.options = {{"memory", "20"}, {"wolfe", "strong"}};
  ended.gap = kNan;
  ended.report.verdict = {false, "claims energy 1, but the audit finds 2"};
  result.rows.push_back(ended);
  result.disagreements = {"rhino: gim is 0.1 away"};
  return result;
}

std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  std::string line;
  while (std::getline(stream, line)) lines.push_back(line);
  return lines;
}

std::vector<std::string> LinesWith(const std::string& text, const std::string& part) {
  std::vector<std::string> lines = Lines(text);
  lines.erase(
      std::remove_if(lines.begin(), lines.end(),
                     [&](const std::string& line) { return line.find(part) == std::string::npos; }),
      lines.end());
  return lines;
}

/// RFC 4180.
std::vector<std::vector<std::string>> ReadCsv(const std::string& text) {
  std::vector<std::vector<std::string>> rows(1, {""});
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '"' && i + 1 < text.size() && text[i + 1] == '"') {
      rows.back().back() += text[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (!quoted && c == ',') {
      rows.back().emplace_back();
    } else if (!quoted && c == '\n') {
      rows.push_back({""});
    } else {
      rows.back().back() += c;
    }
  }
  EXPECT_FALSE(quoted);
  EXPECT_THAT(rows.back(), testing::ElementsAre(""));  // after the last line's end
  rows.pop_back();
  return rows;
}

TEST(ComparisonText, FitsTheWidthWhateverTheNames) {
  ComparisonResult result = SomeResult();
  for (const int length : {1, 20, 200}) {
    result.rows[0].problem = std::string(static_cast<std::size_t>(length), 'p');
    result.rows[0].solver = std::string(static_cast<std::size_t>(length), 's');
    result.rows[2].run.skipped = "it needs " + std::string(static_cast<std::size_t>(length), 'x') +
                                 " and much more, " + std::string(120, 'y');
    std::vector<std::string> table = Lines(ComparisonText(result));
    table.resize(3 + 2 + 1 + 2);
    // The rows; in the notes below a single long word stays whole.
    for (const std::string& line : table) EXPECT_LE(line.size(), 160u) << line;
  }
}

TEST(ComparisonText, ShowsShortNumbersInColumns) {
  const std::string text = ComparisonText(SomeResult());
  const auto lines = LinesWith(text, "lbfgs/memory=10");
  ASSERT_EQ(lines.size(), 1u);
  std::istringstream words(lines[0]);
  std::vector<std::string> cells;
  std::string word;
  while (words >> word) cells.push_back(word);
  EXPECT_THAT(cells, testing::ElementsAre("rhino_|_100%", "lbfgs/memory=10", "gradient_small",
                                          "yes", "46", "1", "52", "0", "51", "0.0123", "300",
                                          "6.78", "4.486846", "3.3e-10", "3.5e-20", "9.5e-12"));
}

TEST(ComparisonText, SaysWhatDidNotRunAndWhatFailed) {
  const std::string text = ComparisonText(SomeResult());
  EXPECT_THAT(text, HasSubstr("skipped: gim needs 100 control points for 80 points\n"));
  EXPECT_THAT(LinesWith(text, "line_search_ended"), SizeIs(1));
  EXPECT_THAT(LinesWith(text, "line_search_ended")[0], HasSubstr(" NO "));
  EXPECT_THAT(text, HasSubstr("NOT VERIFIED: claims energy 1, but the audit finds 2"));
  EXPECT_THAT(text, HasSubstr("DISAGREES: rhino: gim is 0.1 away"));
}

TEST(ComparisonNotes, PutTheObservedRateBesideTheSpectralRadius) {
  EXPECT_THAT(ComparisonNotes(SomeResult()),
              Contains("rhino_|_100%, gim: spectral radius of I - A: 0.667, observed rate 0.666"));
}

TEST(ComparisonNotes, SayAWarningOnceAndLeaveOutNothingElse) {
  ComparisonResult result = SomeResult();
  RunResult& run = result.rows[1].run;
  run.notes = {{"may not converge", "a radius of 1"}, {"window", "5"}};
  run.outcome.message = "no iterate came nearer in 15; a radius of 1";
  EXPECT_THAT(
      ComparisonNotes(result),
      Contains("rhino_|_100%, gim: window: 5; no iterate came nearer in 15; a radius of 1"));
}

TEST(ComparisonLatex, OfNoRowsHasNoTable) {
  EXPECT_THAT(ComparisonLatex(ComparisonResult()), ::testing::Not(HasSubstr("tabular")));
}

TEST(ComparisonNotes, StateTheRuleOfTheRuns) {
  ComparisonResult result = SomeResult();
  EXPECT_EQ(ComparisonNotes(result)[0],
            "race: stop when |g| <= 1e-10 |g(start)|, at the rounding floor, after 10000 "
            "iterations or 60 s. Times: medians of 5 interleaved repetitions.");
  result.spec.run.mode = Mode::kNative;
  result.spec.repetitions = 1;
  EXPECT_EQ(ComparisonNotes(result)[0],
            "native: stop by each method's own rule (largest step < 1e-06, or |g| < 1e-06), at "
            "the rounding floor, after 10000 iterations or 60 s. Times: of one run.");
}

TEST(ComparisonMarkdown, HasTheSameCellsInEveryLine) {
  const std::string text = ComparisonMarkdown(SomeResult());
  const std::vector<std::string> lines = Lines(text);
  ASSERT_GE(lines.size(), 6u);
  for (std::size_t k = 0; k < 6; ++k) {
    int pipes = 0;
    for (std::size_t i = 0; i < lines[k].size(); ++i) {
      if (lines[k][i] == '|' && (i == 0 || lines[k][i - 1] != '\\')) ++pipes;
    }
    EXPECT_EQ(pipes, 17) << lines[k];
  }
  EXPECT_THAT(text, HasSubstr("| rhino_\\|_100% | lbfgs/memory=10 |"));
  EXPECT_EQ(lines[6], "");
}

/// What LaTeX would stumble over: special characters that are not escaped, braces without partner.
std::string LatexFault(const std::string& text) {
  int depth = 0;
  bool math = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\\') {
      ++i;  // the escaped character, or the first of a command's name
      continue;
    }
    if (c == '%' && (i == 0 || text[i - 1] == '\n')) {  // our comment
      i = text.find('\n', i);
      continue;
    }
    if (c == '$') math = !math;
    if (c == '{') ++depth;
    if (c == '}' && --depth < 0) return "} too many";
    const bool special = c == '_' || c == '%' || c == '#' || c == '~' || (c == '^' && !math) ||
                         (!math && (c == '<' || c == '>' || c == '|'));
    if (special) return text.substr(i < 20 ? 0 : i - 20, 40);
    if (c == '\n' && math) return "math goes on behind the line";
  }
  return depth == 0 ? "" : "braces stay open";
}

TEST(ComparisonLatex, EscapesWhatIsSpecial) {
  const std::string text = ComparisonLatex(SomeResult());
  EXPECT_EQ(LatexFault(text), "");
  EXPECT_THAT(text, HasSubstr("rhino\\_\\textbar{}\\_100\\%"));
  EXPECT_THAT(text, HasSubstr("step\\_size \\& \\{tolerance\\} \\textless{} 1e-9 \\#1 "
                              "\\textasciitilde{} \\$\\textasciicircum{}\\textbackslash{}"));
  EXPECT_THAT(text, HasSubstr("$3.5\\cdot10^{-20}$"));
}

TEST(ComparisonLatex, IsABooktabsTableAProblemWithTheSameCellsInEveryLine) {
  const std::string text = ComparisonLatex(SomeResult());
  for (const char* part : {"\\begin{table*}", "\\end{table*}", "\\toprule", "\\bottomrule",
                           "\\begin{tabular}{llllrrrrrrrrrrrr}", "\\end{tabular}"}) {
    EXPECT_THAT(LinesWith(text, part), SizeIs(2)) << part;
  }
  EXPECT_THAT(LinesWith(text, "\\midrule"), SizeIs(2));
  const std::vector<std::string> lines = LinesWith(text, " \\\\");
  EXPECT_EQ(lines.size(), 6u);
  for (const std::string& line : lines) {
    int cells = 1;
    for (std::size_t i = 1; i < line.size(); ++i) cells += line[i] == '&' && line[i - 1] != '\\';
    if (line.find("\\multicolumn{14}") != std::string::npos) cells += 13;
    EXPECT_EQ(cells, 16) << line;
  }
}

TEST(ComparisonCsv, ReadsBackToTheSameValues) {
  const ComparisonResult result = SomeResult();
  const auto rows = ReadCsv(ComparisonCsv(result));
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_THAT(rows, Each(SizeIs(rows[0].size())));
  const auto field = [&rows](std::size_t row, const std::string& name) {
    const auto found = std::find(rows[0].begin(), rows[0].end(), name);
    EXPECT_NE(found, rows[0].end()) << name;
    return rows[row + 1][static_cast<std::size_t>(found - rows[0].begin())];
  };
  EXPECT_EQ(field(2, "problem"), "a, \"b\"");
  EXPECT_EQ(std::stod(field(0, "solve_seconds")), 0.1 + 0.2);
  EXPECT_EQ(std::stod(field(0, "gradient_norm")), 1.0 / 3e9);
  EXPECT_EQ(field(0, "verified"), "true");
  EXPECT_EQ(field(0, "gradient_calls"), "52");
  EXPECT_EQ(field(1, "notes"), "spectral radius of I - A: 0.66666666666666663");
  EXPECT_EQ(field(2, "stop"), "skipped");
  EXPECT_EQ(field(2, "message"), "gim needs 100 control points for 80 points");
  EXPECT_EQ(field(2, "energy"), "");
  EXPECT_EQ(field(2, "iterations"), "");
  EXPECT_EQ(field(2, "verified"), "");
  EXPECT_EQ(field(3, "stop"), "line_search_ended");
  EXPECT_EQ(field(3, "gap"), "");
  EXPECT_EQ(field(3, "options"), "memory=20 wolfe=strong");
}

TEST(ComparisonJson, ReadsBackToTheSameValues) {
  const ComparisonResult result = SomeResult();
  const Json written = Json::parse(ComparisonJson(result));
  EXPECT_EQ(written["format"], "batten.comparison/1");
  EXPECT_EQ(written["mode"], "race");
  EXPECT_EQ(written["disagreements"], Json({"rhino: gim is 0.1 away"}));
  ASSERT_EQ(written["rows"].size(), 4u);
  const Json& row = written["rows"][0];
  EXPECT_EQ(row["solve_seconds"].get<double>(), result.rows[0].solve_seconds);
  EXPECT_EQ(row["energy"].get<double>(), result.rows[0].run.energy);
  EXPECT_EQ(row["gap"].get<double>(), result.rows[0].gap);
  EXPECT_EQ(row["verified"], true);
  EXPECT_EQ(written["rows"][1]["notes"][0]["name"], "spectral radius of I - A");
  EXPECT_TRUE(written["rows"][2]["energy"].is_null());
  EXPECT_TRUE(written["rows"][3]["gap"].is_null());
  EXPECT_EQ(written["rows"][3]["verified"], false);
}

TEST(ComparisonJsonLines, HasTheFieldsOfTheCsv) {
  const ComparisonResult result = SomeResult();
  const std::vector<std::string> lines = Lines(ComparisonJsonLines(result));
  const auto header = ReadCsv(ComparisonCsv(result))[0];
  ASSERT_EQ(lines.size(), 4u);
  for (const std::string& line : lines) {
    const auto written = nlohmann::ordered_json::parse(line);
    std::vector<std::string> names;
    for (const auto& [name, value] : written.items()) names.push_back(name);
    EXPECT_EQ(names, header);
    EXPECT_EQ(written["format"], "batten.cell/1");
  }
}

TEST(SomeClaimFailed, LooksAtAuditedRowsOnly) {
  ComparisonResult result = SomeResult();
  EXPECT_TRUE(SomeClaimFailed(result));
  result.rows.back().report.verdict.holds = true;
  EXPECT_FALSE(SomeClaimFailed(result));
}

}  // namespace
}  // namespace batten
