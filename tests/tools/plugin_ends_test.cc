// Plugins that cannot be made, and what becomes of a program in whose own process they run.
#include <gmock/gmock.h>

#include <csignal>
#include <filesystem>

#include "tests/tools/plugin_files.h"
#include "tests/tools/program.h"

namespace batten {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

struct Unmade {
  std::string name;
  std::string solver;
  std::string terms;
  std::vector<std::string> parts;  // of the one line
};
void PrintTo(const Unmade& row, std::ostream* stream) { *stream << row.name; }

class UnmadePlugin : public ::testing::TestWithParam<Unmade> {};

TEST_P(UnmadePlugin, IsOneLineOfBenchWithItsPlace) {
  const Unmade& row = GetParam();
  const TemporaryFolder folder;
  const json suite = {
      {"format", "batten.suite/1"}, {"name", "unmade"},     {"plugins", {Plugin("fault_made")}},
      {"problems", {"rhino"}},      {"terms", {row.terms}}, {"solvers", {"cg", row.solver}}};
  const Ended ended = RunBatten(
      {"bench", folder.Write("suite.json", suite.dump()), "--out=" + (folder / "out"), "--quiet"});
  ExpectRefused(ended, row.parts);
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

// The sanitizer sees the signal first, and ends the process itself.
#if defined(__SANITIZE_ADDRESS__)
constexpr char kCrashed[] = " ended with status 1 and no result while ";
#else
constexpr char kCrashed[] = " ended by signal 11 (Segmentation fault) while ";
#endif

INSTANTIATE_TEST_SUITE_P(
    Ways, UnmadePlugin,
    ::testing::Values(
        Unmade{"throwing_solver",
               "faulty/how=throws",
               "own",
               {"suite.json: /solvers/1: solver faulty threw an exception while it was made: "
                "\"out of order\""}},
        Unmade{
            "crashing_solver",
            "faulty/how=crashes",
            "own",
            {"suite.json: /solvers/1: found faulty/how=crashes, a plugin's solver that", kCrashed}},
        Unmade{"hanging_solver",
               "faulty/how=hangs",
               "own",
               {"/solvers/1: found faulty/how=hangs", "killed after 10 s of wall time"}},
        Unmade{"throwing_term",
               "lbfgs",
               "distance,faulty_term/how=throws",
               {"/problems/0: rhino: ",
                "rhino.json: term faulty_term threw an exception while it was made"}},
        Unmade{"crashing_term",
               "lbfgs",
               "distance,faulty_term/how=crashes",
               {"/problems/0: rhino: a term of a plugin", kCrashed}}),
    [](const auto& row) { return row.param.name; });

Ended Compare(const std::string& plugin, const TemporaryFolder& folder) {
  return RunBatten({"compare", "--problems=rhino", "--solvers=faulty,banded_qr", PluginFlag(plugin),
                    "--out=" + (folder / "out"), "--nofigures", "--quiet"});
}

TEST(PluginEnds, OneThatThrowsIsARowAndTheOthersGoOn) {
  for (const auto& [plugin, why] : {std::pair{"fault_throws", "no such luck"},
                                    {"fault_resizes", "books 161 variables where there are 160"},
                                    {"fault_reason", "returns the reason 77"}}) {
    const TemporaryFolder folder;
    Compare(plugin, folder);
    const json table = json::parse(ReadFile(folder / "out/table.json"));
    ASSERT_EQ(table["rows"].size(), 2u) << plugin;
    EXPECT_EQ(table["rows"][0]["stop"], "numerical_failure");
    EXPECT_THAT(table["rows"][0]["message"].get<std::string>(), HasSubstr("threw an exception: "));
    EXPECT_THAT(table["rows"][0]["message"].get<std::string>(), HasSubstr(why));
    EXPECT_EQ(table["rows"][1]["stop"], "solved");
  }
}

TEST(PluginEnds, OneThatCallsExitIsNoSuccess) {
  const TemporaryFolder folder;
  const Ended ended = Compare("fault_exits", folder);
  EXPECT_EQ(ended.status, 70);
  EXPECT_EQ(ended.err, "batten: faulty: a plugin has ended the program with exit()\n");
}

#if !defined(__SANITIZE_ADDRESS__)
TEST(PluginEnds, OneThatCrashesIsNamed) {
  const TemporaryFolder folder;
  const Ended ended = Compare("fault_crasher", folder);
  EXPECT_EQ(ended.signal, SIGABRT);
  EXPECT_EQ(ended.err, "batten: faulty: ended by a signal: Aborted\n");
}
#endif

}  // namespace
}  // namespace batten
