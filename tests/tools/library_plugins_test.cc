// libLBFGS and NLopt as plugins: the algorithm that ran, by what the library says and by what it
// does.
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "tests/tools/plugin_files.h"
#include "tests/tools/program.h"

namespace batten {
namespace {

using ::testing::HasSubstr;

/// fit.json of a run, empty where it did not end well.
nlohmann::json FitBy(const std::string& plugin, const std::string& solver) {
  const TemporaryFolder folder;
  const Ended ended =
      RunBatten({"fit", "--problem=rhino", "--solver=" + solver, "--quiet", "--max_iterations=60",
                 "--max_seconds=2", "--out=" + (folder / "fit.json"), PluginFlag(plugin)});
  EXPECT_LE(ended.status, 1) << ended.err;
  return nlohmann::json::parse(ReadFile(folder / "fit.json"), nullptr, false);
}

std::string NoteOf(const nlohmann::json& fit, const char* name = "algorithm that ran") {
  for (const auto& note : fit["notes"]) {
    if (note["name"] == name) return note["value"];
  }
  return "";
}

TEST(LibraryPlugins, NloptRunsTheAlgorithmThatIsNamed) {
  if (!std::filesystem::exists(Plugin("nlopt"))) GTEST_SKIP() << "NLopt is not there";
  // The names are NLopt's own (its reference manual, "NLopt Algorithms").
  const std::map<std::string, std::string> names = {
      {"lbfgs", "L-BFGS"},
      {"var1", "rank 1"},
      {"var2", "rank 2"},
      {"tnewton_precond_restart", "Newton"},
      {"mma", "MMA"},
      {"ccsaq", "CCSA"},
      {"slsqp", "(SQP)"},
      {"sbplx", "Sbplx"},
      {"tnewton", "Truncated Newton"},
      {"tnewton_restart", "Truncated Newton with restarting"},
      {"tnewton_precond", "Preconditioned truncated Newton"},
      {"bobyqa", "BOBYQA"},
      {"neldermead", "Nelder-Mead"}};
  std::set<double> energies;
  for (const auto& [word, name] : names) {
    SCOPED_TRACE(word);
    const auto fit = FitBy("nlopt", "nlopt/algorithm=" + word);
    EXPECT_THAT(NoteOf(fit), HasSubstr(name));
    EXPECT_THAT(NoteOf(fit), ::testing::MatchesRegex("NLopt 2\\.[0-9]+\\.[0-9]+: .*"));
    EXPECT_EQ(NoteOf(fit, "options that ran"), "nlopt/algorithm=" + word + "/memory=10");
    EXPECT_LT(fit["energy"].get<double>(), fit["start"]["energy"].get<double>());
    // Derivative-free ones ask for no gradient.
    EXPECT_EQ(fit["counts"]["gradient_calls"].get<int>() == 0,
              word == "sbplx" || word == "bobyqa" || word == "neldermead");
    energies.insert(fit["energy"].get<double>());
  }
  // Different algorithms are at different places after 60 iterations.
  EXPECT_EQ(energies.size(), names.size());
}

class LibraryPlugin : public ::testing::TestWithParam<std::string> {};

TEST_P(LibraryPlugin, PassesTheConformanceSuiteWithEachAlgorithm) {
  if (!std::filesystem::exists(Plugin(GetParam()))) GTEST_SKIP() << "the library is not there";
  const TemporaryFolder folder;
  const Ended ended = RunBatten({"check", Plugin(GetParam()), "--quiet", "--seconds_per_check=120",
                                 "--badge=" + (folder / "badge.svg")});
  EXPECT_EQ(ended.status, 0) << ended.out << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("9 of 9 checks passed"));
  // Beside the one that is used by default.
  const char* const others = GetParam() == "nlopt" ? "likewise of 12 words" : "likewise of 3 words";
  EXPECT_THAT(ended.out, HasSubstr(others));
}

INSTANTIATE_TEST_SUITE_P(All, LibraryPlugin, ::testing::Values("nlopt", "liblbfgs"),
                         [](const auto& row) { return row.param; });

TEST(LibraryPlugins, LibLbfgsHeedsItsOptions) {
  if (!std::filesystem::exists(Plugin("liblbfgs"))) GTEST_SKIP() << "libLBFGS is not there";
  std::set<double> energies;
  // Asked, and with what stays as it is by default.
  const std::map<std::string, std::string> options = {
      {"/memory=1", "/memory=1/line_search=more_thuente"},
      {"/memory=20", "/memory=20/line_search=more_thuente"},
      {"/line_search=armijo", "/memory=6/line_search=armijo"}};
  for (const auto& [option, ran] : options) {
    SCOPED_TRACE(option);
    const auto fit = FitBy("liblbfgs", "liblbfgs" + option);
    EXPECT_EQ(NoteOf(fit, "options that ran"), "liblbfgs" + ran);
    EXPECT_THAT(NoteOf(fit), HasSubstr("libLBFGS L-BFGS m="));
    EXPECT_GT(fit["counts"]["gradient_calls"].get<int>(), 0);
    energies.insert(fit["energy"].get<double>());
  }
  EXPECT_EQ(energies.size(), options.size());
}

/// What a command prints, without the last line's end.
std::string OutputOf(const std::string& command) {
  const TemporaryFolder folder;
  EXPECT_EQ(std::system((command + " > " + (folder / "out")).c_str()), 0) << command;
  std::string text = ReadFile(folder / "out");
  if (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

TEST(LibraryPlugins, TheManifestHasTheLibrariesThatWereLoaded) {
  for (const std::string name : {"nlopt", "liblbfgs"}) {
    if (!std::filesystem::exists(Plugin(name))) GTEST_SKIP() << name << " is not there";
    const TemporaryFolder folder;
    const nlohmann::json suite = {{"format", "batten.suite/1"}, {"name", "libraries"},
                                  {"plugins", {Plugin(name)}},  {"problems", {"rhino"}},
                                  {"solvers", {"cg"}},          {"repetitions", 1}};
    ASSERT_EQ(RunBatten({"bench", folder.Write("suite.json", suite.dump()),
                         "--out=" + (folder / "out"), "--nofigures", "--quiet"})
                  .status,
              0);
    const auto manifest = nlohmann::json::parse(ReadFile(folder / "out/manifest.json"));
    // As the loader says, without symbolic links.
    const std::string library = name == "nlopt" ? "libnlopt" : "liblbfgs";
    const std::string path = OutputOf("readlink -f $(ldd " + Plugin(name) + " | awk '/" + library +
                                      "[-.0-9]*so/ {print $3}')");
    bool is_there = false;
    for (const auto& needed : manifest["plugins"][0]["libraries"]) {
      if (needed["file"] != std::filesystem::path(path).filename().string()) continue;
      is_there = true;
      EXPECT_EQ(needed["sha256"], OutputOf("sha256sum " + path + " | cut -d' ' -f1"));
    }
    EXPECT_TRUE(is_there) << path << " in " << manifest["plugins"].dump();
  }
}

TEST(LibraryPlugins, AChangedLibraryRunsItsCellsAgain) {
  if (!std::filesystem::exists(Plugin("liblbfgs"))) GTEST_SKIP() << "libLBFGS is not there";
  const TemporaryFolder folder;
  const std::string needed =
      OutputOf("ldd " + Plugin("liblbfgs") + " | awk '/liblbfgs[-.0-9]*so/ {print $1, $3}'");
  const std::size_t space = needed.find(' ');
  ASSERT_NE(space, std::string::npos) << needed;
  const std::string copy = folder / needed.substr(0, space);
  std::filesystem::copy_file(needed.substr(space + 1), copy);
  const nlohmann::json suite = {
      {"format", "batten.suite/1"},
      {"name", "libraries"},
      {"plugins", {Plugin("liblbfgs")}},
      {"problems",
       {{{"synthetic", "wave"}, {"name", "wave"}, {"points", 30}, {"control_points", 8}}}},
      {"solvers", {"liblbfgs"}},
      {"warm_up", 0},
      {"repetitions", 2}};
  const std::string file = folder.Write("suite.json", suite.dump());
  const auto RowsNow = [&] {
    EXPECT_EQ(
        RunBatten({"bench", file, "--out=" + (folder / "out"), "--nofigures", "--quiet"}).status,
        0);
    return Lines(ReadFile(folder / "out/cells.jsonl")).size();
  };
  setenv("LD_LIBRARY_PATH", (folder / "").c_str(), 1);
  EXPECT_EQ(RowsNow(), 2u);
  EXPECT_EQ(RowsNow(), 2u);
  std::ofstream(copy, std::ios::app) << "another build";
  EXPECT_EQ(RowsNow(), 4u);
  unsetenv("LD_LIBRARY_PATH");
}

}  // namespace
}  // namespace batten
