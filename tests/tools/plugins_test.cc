// Plugins: what the program loads, what it refuses, and that there is one registry.
#include <gmock/gmock.h>

#include <filesystem>

#include "solvers/batten_c.h"
#include "tests/tools/plugin_files.h"
#include "tests/tools/program.h"

namespace batten {
namespace {

TEST(Plugins, SolverAndTermAppearInList) {
  const Ended ended = RunBatten(
      {"list", "--json", "--plugins=" + Plugin("barzilai_borwein") + "," + Plugin("tension")});
  ASSERT_EQ(ended.status, 0) << ended.err;
  const std::string names = ended.Json().dump();
  EXPECT_THAT(names, ::testing::HasSubstr("\"name\":\"barzilai_borwein\""));
  EXPECT_THAT(names, ::testing::HasSubstr("\"name\":\"tension\""));
  EXPECT_THAT(RunBatten({"list", "--json"}).Json().dump(),
              ::testing::Not(::testing::HasSubstr("\"name\":\"barzilai_borwein\"")));
}

TEST(Plugins, SolverFitsWithATermOfAnotherPlugin) {
  const TemporaryFolder folder;
  const std::vector<std::string> common = {
      "--terms=interpolation,tension/weight=1e-3",
      "--plugins=" + Plugin("barzilai_borwein") + "," + Plugin("tension")};
  double energies[2] = {0.0, 0.0};
  const char* const solvers[2] = {"barzilai_borwein", "newton"};
  for (int s = 0; s < 2; ++s) {
    std::vector<std::string> arguments = {"fit", "--problem=rhino",
                                          std::string("--solver=") + solvers[s],
                                          "--out=" + (folder / "fit.json")};
    arguments.insert(arguments.end(), common.begin(), common.end());
    const Ended ended = RunBatten(arguments);
    ASSERT_EQ(ended.status, 0) << ended.err << ended.out;
    const auto fit = nlohmann::json::parse(ReadFile(folder / "fit.json"));
    EXPECT_EQ(fit["solver"], solvers[s]);
    EXPECT_GT(fit["terms"][1]["energy"].get<double>(), 0.0) << fit["terms"].dump();
    energies[s] = fit["energy"];
  }
  // Both at the minimum of one convex E: it is flat there, so that E agrees to rounding.
  EXPECT_NEAR(energies[0], energies[1], 1e-10 * energies[1]);
}

TEST(Plugins, SolverIsComparedWithOurs) {
  const TemporaryFolder folder;
  const Ended ended =
      RunBatten({"compare", "--problems=rhino", "--solvers=banded_qr,barzilai_borwein", "--quiet",
                 "--out=" + (folder / "out"), PluginFlag("barzilai_borwein")});
  ASSERT_EQ(ended.status, 0) << ended.err << ended.out;
  const std::vector<std::string> cells = Lines(ReadFile(folder / "out/cells.jsonl"));
  ASSERT_EQ(cells.size(), 2u);
  const auto cell = nlohmann::json::parse(cells[1]);
  EXPECT_EQ(cell["solver"], "barzilai_borwein");
  EXPECT_EQ(cell["stop"], "gradient_small") << cell.dump();
  ASSERT_EQ(cell["plugins"].size(), 1u);
  // Of the file, as sha256sum prints it.
  EXPECT_EQ(cell["plugins"].begin().value().get<std::string>().size(), 64u);
}

TEST(Plugins, AnswersTheNearestNameOfAPlugin) {
  ExpectRefused(RunBatten({"fit", "--problem=rhino", "--solver=barzilai_borwien",
                           PluginFlag("barzilai_borwein")}),
                {"did you mean barzilai_borwein?"});
}

TEST(Plugins, ProblemReaderAndCutRuleAreThere) {
  const TemporaryFolder folder;
  const std::string data = folder.Write("square.pairs", "pairs 0 0 2 0 2 2 0 2\n");
  const Ended fit = RunBatten({"fit", data, "--closed", "--control_points=4",
                               "--out=" + (folder / "fit.json"), PluginFlag("every_kind")});
  ASSERT_EQ(fit.status, 0) << fit.err;
  EXPECT_EQ(nlohmann::json::parse(ReadFile(folder / "fit.json"))["parameters"].size(), 4u);

  const Ended made = RunBatten(
      {"compare", "--problems=made_circle", "--solvers=banded_qr,lbfgs", PluginFlag("every_kind")});
  EXPECT_EQ(made.status, 0) << made.err;
  EXPECT_THAT(made.out, ::testing::HasSubstr("made_circle"));
  EXPECT_EQ(RunBatten({"fit", "--problem=made_circle", PluginFlag("every_kind")}).status, 0);
  EXPECT_THAT(RunBatten({"list", "problems", PluginFlag("every_kind")}).out,
              ::testing::HasSubstr("48 points on a circle, made by a plugin"));

  const std::string curve = folder.Write("curve.csv", "x,y\n0,0\n1,2\n2,0\n");
  const Ended cut = RunBatten({"subdivide", curve, "--rule=third", PluginFlag("every_kind")});
  EXPECT_EQ(cut.status, 0) << cut.err;
}

TEST(Plugins, ReaderThatFailsIsQuoted) {
  const TemporaryFolder folder;
  const std::string data = folder.Write("bad.PAIRS", "triples 1 2 3\n");
  ExpectRefused(RunBatten({"fit", data, "--control_points=4", PluginFlag("every_kind")}),
                {data + ":1:1: found no word pairs"});
  const std::string empty = folder.Write("empty.pairs", "pairs\n");
  ExpectRefused(RunBatten({"fit", empty, "--control_points=4", PluginFlag("every_kind")}),
                {empty, "data reader pairs", "found 0 points"});
}

TEST(Plugins, PathNamesFilesAndFolders) {
  const TemporaryFolder folder;
  std::filesystem::copy(Plugin("tension"), folder / "tension.so");
  folder.Write("notes.txt", "is no plugin and is not looked at");
  const Environment path("BATTEN_PLUGIN_PATH", (folder / "") + ":" + Plugin("barzilai_borwein"));
  const std::string out = RunBatten({"list"}).out;
  EXPECT_THAT(out, ::testing::HasSubstr("tension"));
  EXPECT_THAT(out, ::testing::HasSubstr("barzilai_borwein"));
  // The same file again, under another name too.
  std::filesystem::create_symlink(Plugin("barzilai_borwein"), folder / "again.so");
  EXPECT_EQ(RunBatten({"list", PluginFlag("barzilai_borwein")}).status, 0);
}

TEST(Plugins, BrokenPathIsRefusedByItsName) {
  const Environment path("BATTEN_PLUGIN_PATH", "/nowhere/mine.so");
  ExpectRefused(RunBatten({"list"}), {"BATTEN_PLUGIN_PATH: /nowhere/mine.so", "No such file"});
  EXPECT_EQ(RunBatten({"help"}).status, 0);
  EXPECT_EQ(RunBatten({"list", "--help"}).status, 0);
}

struct Refused {
  std::string plugin;
  std::vector<std::string> parts;
};

class RefusedPlugin : public ::testing::TestWithParam<Refused> {};

TEST_P(RefusedPlugin, IsOneLineWithStatusTwo) {
  const auto& [plugin, parts] = GetParam();
  ExpectRefused(RunBatten({"list", PluginFlag(plugin)}), parts);
  ExpectRefused(RunBatten({"list", PluginFlag(plugin)}), {"--plugins: " + Plugin(plugin) + ": "});
}

INSTANTIATE_TEST_SUITE_P(
    Card, RefusedPlugin,
    ::testing::Values(
        Refused{"forged_api_level",
                {"its API level is " + std::to_string(BATTEN_API_LEVEL + 1) +
                 ", this program's is " + std::to_string(BATTEN_API_LEVEL)}},
        Refused{"forged_card_size", {"its card size is ", "this program's is "}},
        Refused{"forged_compiler", {"its compiler is GCC 3, this program's is "}},
        Refused{"forged_no_compiler", {"its compiler is nothing, this program's is "}},
        Refused{"forged_cxx_library", {"its C++ library is libstdc++, cxx11 ABI 0"}},
        Refused{"forged_eigen_version", {"its Eigen version is 3.3.9, this program's is 3."}},
        Refused{"forged_eigen_alignment", {"its Eigen alignment is 64", "-march=native"}},
        Refused{"forged_interface", {"its interface is Rust; allowed: C++, C"}},
        Refused{"forged_ceres_version", {"its Ceres version is 1.14.0, this program's is 2."}},
        Refused{"forged_class_layout", {"its class layout is ", "this program's is "}}),
    [](const auto& row) { return row.param.plugin; });

INSTANTIATE_TEST_SUITE_P(
    Symbols, RefusedPlugin,
    ::testing::Values(
        Refused{"forged_without_card", {"has no symbol batten_plugin_card"}},
        Refused{"forged_without_register", {"has no symbol batten_plugin_register"}},
        Refused{"forged_undefined_symbol", {"batten::FunctionThatNoBattenHas(int)"}},
        Refused{"forged_throws", {"threw while it registered: no licence found"}},
        Refused{"forged_empty", {"registers nothing"}},
        Refused{"forged_c_options_1", {"solver forged_c has 2 options, but no list"}},
        Refused{"forged_c_options_2", {"has two options named momentum"}},
        Refused{"forged_c_options_3", {"has an option named \"mom=x\"; allowed: letters"}},
        Refused{"forged_taken_name", {"registers a solver named lbfgs, which is there already"}}),
    [](const auto& row) { return row.param.plugin; });

TEST(Plugins, BuiltForWiderVectorsIsRefused) {
  if (!std::filesystem::exists(Plugin("wider_vectors"))) GTEST_SKIP() << "no such processor";
  ExpectRefused(RunBatten({"list", PluginFlag("wider_vectors")}),
                {"its Eigen alignment is 32, this program's is 16"});
  ExpectRefused(RunBatten({"list", PluginFlag("wider_packets")}),
                {"its Eigen packet size is 32, this program's is 16",
                 "-DEIGEN_MAX_ALIGN_BYTES=16 -DEIGEN_DONT_VECTORIZE"});
}

TEST(Plugins, BuiltForWiderVectorsAsTheRefusalAdvisesPassesEveryCheck) {
  if (!std::filesystem::exists(Plugin("wider_without_eigen"))) GTEST_SKIP() << "no such processor";
  const TemporaryFolder folder;
  const Ended result =
      RunBatten({"check", Plugin("wider_without_eigen"), "--badge=" + (folder / "badge.json")});
  EXPECT_EQ(result.status, 0) << result.out << result.err;
}

TEST(Plugins, WhatIsNoSharedObjectIsRefused) {
  const TemporaryFolder folder;
  const std::string text = folder.Write("text.so", "int main() { return 0; }\n");
  ExpectRefused(RunBatten({"list", "--plugins=" + text}), {text + ": is no shared object"});
  const std::string cut = folder.Write("cut.so", ReadFile(Plugin("tension")).substr(0, 3000));
  ExpectRefused(RunBatten({"list", "--plugins=" + cut}), {cut + ": is cut off"});
  ExpectRefused(RunBatten({"list", "--plugins=" + (folder / "none.so")}),
                {folder / "none.so", "No such file"});
  ExpectRefused(RunBatten({"list", "--plugins=" + (folder / "")}), {"Is a directory"});
  ExpectRefused(RunBatten({"list", "--plugins="}), {"--plugins: found \"\""});
  ExpectRefused(RunBatten({"list", "--plugins=" + text + ","}), {"--plugins: found "});
}

TEST(Plugins, TwoThatBringOneNameAreRefused) {
  const TemporaryFolder folder;
  std::filesystem::copy(Plugin("tension"), folder / "copy.so");
  ExpectRefused(RunBatten({"list", "--plugins=" + Plugin("tension") + "," + (folder / "copy.so")}),
                {"copy.so: registers a term named tension, which is there already"});
}

}  // namespace
}  // namespace batten
