// `batten check`: what it passes, and what it finds in plugins with one fault each.
#include <gmock/gmock.h>

#include <filesystem>

#include "solvers/batten_c.h"
#include "tests/tools/plugin_files.h"
#include "tests/tools/program.h"

namespace batten {
namespace {

using ::testing::HasSubstr;

Ended Check(const std::string& plugin, const TemporaryFolder& folder,
            std::vector<std::string> flags = {}) {
  flags.insert(flags.begin(),
               {"check", Plugin(plugin), "--quiet", "--badge=" + (folder / "badge.svg")});
  return RunBatten(flags);
}

/// "  gradient          FAILED  ..." with what goes on in the lines below it, in one line.
std::string RowOf(const std::string& table, const std::string& check) {
  std::string row;
  for (const std::string& line : Lines(table)) {
    const bool begins = line.rfind("  " + check + " ", 0) == 0;
    const bool goes_on = line.rfind("      ", 0) == 0;
    if (!begins && !(goes_on && !row.empty())) {
      if (!row.empty()) break;
      continue;
    }
    row += (row.empty() ? "" : " ") + line.substr(line.find_first_not_of(' '));
  }
  return row;
}

class GoodPlugin : public ::testing::TestWithParam<std::string> {};

TEST_P(GoodPlugin, PassesEveryCheck) {
  const TemporaryFolder folder;
  const Ended ended = Check(GetParam(), folder);
  EXPECT_EQ(ended.status, 0) << ended.out << ended.err;
  EXPECT_THAT(ended.out, ::testing::Not(HasSubstr("FAILED")));
  const std::string badge = ReadFile(folder / "badge.svg");
  EXPECT_THAT(badge, HasSubstr("checks passed"));
  EXPECT_THAT(badge, HasSubstr("#2a7d2a"));
}

INSTANTIATE_TEST_SUITE_P(Examples, GoodPlugin,
                         ::testing::Values("barzilai_borwein", "tension", "polak_ribiere",
                                           "fault_none"),
                         [](const auto& row) { return row.param; });

TEST(Check, MeasuresTheTaylorSlopeOfATerm) {
  const TemporaryFolder folder;
  const Ended ended = Check("tension", folder);
  // E is quadratic: the remainder is one square, but for rounding.
  EXPECT_THAT(RowOf(ended.out, "gradient"),
              ::testing::ContainsRegex("lowest Taylor slope (1.9|2.0)"));
}

struct FaultInCheck {
  std::string plugin;
  std::string check;   // that must find it
  std::string reason;  // a part of what it says
  std::vector<std::string> flags;
};

class FaultyPlugin : public ::testing::TestWithParam<FaultInCheck> {};

TEST_P(FaultyPlugin, IsFound) {
  const FaultInCheck& fault = GetParam();
  const TemporaryFolder folder;
  const Ended ended = Check(fault.plugin, folder, fault.flags);
  EXPECT_EQ(ended.signal, 0);
  EXPECT_EQ(ended.status, 3) << ended.err;
  const std::string row = RowOf(ended.out, fault.check);
  EXPECT_THAT(row, HasSubstr("FAILED")) << ended.out;
  EXPECT_THAT(row, HasSubstr(fault.reason)) << ended.out;
  EXPECT_THAT(RowOf(ended.out, "description"), HasSubstr("passed"));
  EXPECT_THAT(ReadFile(folder / "badge.svg"), HasSubstr("#b3261e"));
}

#if defined(__SANITIZE_ADDRESS__)
// The sanitizer is the first to see it and ends the process.
const FaultInCheck kCheckReadsPastX = {
    "fault_reads_past_x", "descent", "ends the program with status 1", {}};
#else
const FaultInCheck kCheckReadsPastX = {
    "fault_reads_past_x", "memory", "what stands behind the end of x changes", {}};
#endif

INSTANTIATE_TEST_SUITE_P(
    Faults, FaultyPlugin,
    ::testing::Values(
        FaultInCheck{"fault_wrong_gradient", "gradient", "the Taylor slope of E is ", {}},
        FaultInCheck{"fault_nan_term", "repeatability", "differs at call ", {}},
        FaultInCheck{"fault_nan", "descent", "it ends where E is no number", {}},
        FaultInCheck{"fault_other_options",
                     "options",
                     "ran with other options: asked memory=5, ran memory=6",
                     {}},
        FaultInCheck{"fault_liar", "claims", "claim", {}},
        FaultInCheck{"fault_ignores_stop", "stop at evaluation", "evaluations and books ", {}},
        FaultInCheck{"fault_ignores_stop", "stop at iterate", "after a stop", {}},
        FaultInCheck{"fault_steps_past_stop",
                     "stop at iterate",
                     "it goes on from the iterate that said stop",
                     {}},
        FaultInCheck{"fault_crasher", "descent", "crashes: Aborted", {}},
        FaultInCheck{"fault_throws", "descent", "it ends with numerical_failure", {}},
        FaultInCheck{"fault_throws", "threads", "throws: no such luck", {}},
        FaultInCheck{
            "fault_sleeper", "descent", "does not end within 0.5 s", {"--seconds_per_check=0.5"}},
        kCheckReadsPastX,
        FaultInCheck{"fault_remembers", "repeatability", "two runs part at iterate ", {}}),
    [](const auto& row) {
      return row.param.plugin.substr(6) + "_" +
             row.param.check.substr(row.param.check.find_last_of(' ') + 1);
    });

TEST(Check, FindsAMemoryHog) {
  if (!kCanLimitMemory) GTEST_SKIP() << "the sanitizer needs terabytes of addresses";
  const TemporaryFolder folder;
  const Ended ended = Check("fault_memory_hog", folder, {"--memory_per_check=200"});
  EXPECT_EQ(ended.status, 3) << ended.err;
  EXPECT_THAT(RowOf(ended.out, "descent"), HasSubstr("needs more than 200 MiB of memory"));
}

TEST(Check, WritesTheBadgeThatIsAskedFor) {
  const TemporaryFolder folder;
  std::filesystem::copy(Plugin("fault_none"), folder / "mine.so");
  ASSERT_EQ(RunBatten({"check", folder / "mine.so", "--quiet"}).status, 0);
  EXPECT_THAT(ReadFile(folder / "mine.badge.svg"), HasSubstr("<svg"));
  ASSERT_EQ(
      RunBatten({"check", folder / "mine.so", "--quiet", "--badge=" + (folder / "b.json")}).status,
      0);
  const auto badge = nlohmann::json::parse(ReadFile(folder / "b.json"));
  EXPECT_EQ(badge["schemaVersion"], 1);
  EXPECT_EQ(badge["color"], "success");
}

TEST(Check, RefusesBadInput) {
  const TemporaryFolder folder;
  const std::string text = folder.Write("text.so", "no plugin");
  ExpectRefused(RunBatten({"check"}), {"found 0 files; allowed: one PLUGIN.so"});
  ExpectRefused(RunBatten({"check", text}), {text + ": is no shared object"});
  ExpectRefused(RunBatten({"check", Plugin("forged_api_level")}),
                {"its API level is " + std::to_string(BATTEN_API_LEVEL + 1)});
  ExpectRefused(RunBatten({"check", Plugin("tension"), "--badge=" + (folder / "badge.png")}),
                {"--badge: found ", "allowed: FILE.svg, FILE.json"});
  ExpectRefused(RunBatten({"check", Plugin("tension"), "--seconds_per_check=0"}),
                {"--seconds_per_check: found 0; allowed: above 0"});
  EXPECT_EQ(folder.Names(), std::vector<std::string>{"text.so"});
}

TEST(Check, IsInterrupted) {
  const TemporaryFolder folder;
  Program program({"check", Plugin("fault_sleeper"), "--quiet", "--seconds_per_check=100",
                   "--badge=" + (folder / "badge.svg")});
  usleep(500000);  // most of it, it waits for the plugin to wake up
  program.Send(SIGINT);
  EXPECT_EQ(program.Wait().status, 130);
  EXPECT_THAT(folder.Names(), ::testing::IsEmpty());
}

}  // namespace
}  // namespace batten
