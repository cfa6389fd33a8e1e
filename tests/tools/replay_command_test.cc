// The command `replay`, run as a process.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/tools/program.h"

namespace batten {
namespace {

using ::testing::HasSubstr;

TEST(ReplayCommand, SaysThatEqualStreamsAreEqual) {
  const Ended ended = RunBatten({"replay", "--problem=rhino", "--solver=ceres_lbfgs",
                                 "--against=ceres_lbfgs/form=problem", "--nocompile"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("points, bit for bit"));
}

TEST(ReplayCommand, SaysWhereOursAndCeresPart) {
  const Ended ended = RunBatten(
      {"replay", "--problem=rhino", "--solver=lbfgs", "--against=ceres_lbfgs", "--nocompile"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("bit for bit: part at evaluation "));
}

TEST(ReplayCommand, SplitsTimeAndWritesTapesThatReadBack) {
  const std::string folder = ::testing::TempDir() + "replay_tapes";
  std::filesystem::remove_all(folder);
  const Ended ended = RunBatten(
      {"replay", "--problem=rhino", "--solver=lbfgs", "--against=ceres_lbfgs", "--out=" + folder});
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("medians of its parts: evaluation "));
  const auto replay = nlohmann::json::parse(std::ifstream(folder + "/replay.json"));
  const auto& first = replay.at("first");
  // lbfgs on a quadratic asks for one product per iteration beside the gradient.
  EXPECT_GT(first.at("products").get<int>(), 10);
  EXPECT_EQ(first.at("energy_calls").get<int>(), 0);
  EXPECT_EQ(replay.at("second").at("products").get<int>(), 0);
  EXPECT_GT(first.at("seconds").get<double>(), 0.0);
  EXPECT_GT(first.at("evaluation_seconds").get<double>(), 0.0);
  EXPECT_EQ(replay.at("partings").size(), 4U);
  // A header and one line per request.
  std::ifstream tape(folder + "/tape_1.csv");
  int lines = 0;
  for (std::string line; std::getline(tape, line);) ++lines;
  EXPECT_EQ(lines, 1 + first.at("gradient_calls").get<int>() + first.at("products").get<int>());
  EXPECT_TRUE(std::filesystem::exists(folder + "/replay.svg"));
}

TEST(ReplayCommand, RefusesBadInput) {
  ExpectRefused(RunBatten({"replay"}), {"--problem"});
  ExpectRefused(RunBatten({"replay", "--problem=nowhere"}), {"--problem", "nowhere"});
  ExpectRefused(RunBatten({"replay", "--problem=rhino", "--solver=ceres_lm"}),
                {"ceres_lm makes Jacobians"});
  ExpectRefused(RunBatten({"replay", "--problem=rhino", "--repetitions=0"}), {"--repetitions"});
  ExpectRefused(RunBatten({"replay", "--problem=rhino", "--out=/dev/null/x"}), {"/dev/null/x"});
  ExpectRefused(RunBatten({"replay", "rhino"}), {"replay: found rhino"});
  ExpectRefused(RunBatten({"replay", "--problem=rhino", "--solver=lbfgs,cg"}),
                {"--solver", "one solver"});
  ExpectRefused(RunBatten({"replay", "--problem=rhino", "--against=nosuch"}),
                {"--against", "nosuch"});
  ExpectRefused(RunBatten({"replay", "--problem=rhino", "--solver=banded_qr"}),
                {"banded_qr makes", "a tape holds"});
}

}  // namespace
}  // namespace batten
