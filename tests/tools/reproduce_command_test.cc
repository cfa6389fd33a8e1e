// The command `reproduce`, run as a process.
#include <gmock/gmock.h>

#include "tests/tools/program.h"

namespace batten {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

class ReproduceCommand : public ::testing::Test {
 protected:
  Ended Reproduce(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "reproduce");
    arguments.push_back("--out=" + folder_ / "out");
    return RunBatten(std::move(arguments));
  }
  TemporaryFolder folder_;
};

TEST_F(ReproduceCommand, WritesThePageOfOneExperiment) {
  const Ended ended = Reproduce({"accelerated-gim", "--only=figure_1", "--repetitions=1"});
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.err, "");
  EXPECT_THAT(ended.out, HasSubstr("GIM 134 iterations, L-BFGS 8"));
  for (const char* name :
       {"accelerated-gim.md", "accelerated-gim.html", "figure_1.csv", "figure_1_counts.svg",
        "figure_1_counts.plot.json", "cells.jsonl", "traces/figure_1-0001.csv"}) {
    EXPECT_TRUE(std::filesystem::is_regular_file(folder_ / "out/" + name)) << name;
  }
}

TEST_F(ReproduceCommand, TakesARunThatMustDivergeForARow) {
  // An eigenvalue of diag(N)^-1 N is above 2 on the dolphin: docs/solvers/jacobi_pia.md.
  const Ended ended = Reproduce({"accelerated-gim", "--only=spectrum", "--repetitions=1"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ReadFile(folder_ / "out/spectrum.csv"), HasSubstr("jacobi_pia/w=1,diverged"));
}

TEST_F(ReproduceCommand, TakesOverFinishedExperiments) {
  const std::vector<std::string> arguments = {"accelerated-gim", "--only=figure_1",
                                              "--repetitions=1", "--resume"};
  ASSERT_EQ(Reproduce(arguments).status, 0);
  const std::string before = ReadFile(folder_ / "out/figure_1.csv");
  const Ended ended = Reproduce(arguments);
  EXPECT_THAT(ended.out, HasSubstr("(taken over)"));
  EXPECT_EQ(ReadFile(folder_ / "out/figure_1.csv"), before);
}

TEST_F(ReproduceCommand, RefusesWhatItDoesNotKnow) {
  struct Case {
    std::vector<std::string> arguments;
    const char* message;
  };
  for (const Case& c :
       {Case{{}, "reproduce: found 0 names; allowed: one of accelerated-gim"},
        Case{{"accelerated-gmi"}, "unknown reproduction \"accelerated-gmi\"; did you mean"},
        Case{{"accelerated-gim", "--only=figure_2"}, "--only: unknown experiment \"figure_2\""},
        Case{{"accelerated-gim", "--repetitions=0"}, "--repetitions: found 0"}}) {
    const Ended ended = Reproduce(c.arguments);
    EXPECT_EQ(ended.status, 2);
    EXPECT_EQ(Lines(ended.err).size(), 1U) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr(c.message));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
  }
}

TEST_F(ReproduceCommand, RefusesAFolderThatCannotBeMade) {
  folder_.Write("file", "");
  const Ended ended = RunBatten(
      {"reproduce", "accelerated-gim", "--only=figure_1", "--out=" + folder_ / "file/out"});
  EXPECT_EQ(ended.status, 2);
  EXPECT_THAT(ended.err, HasSubstr("--out: "));
}

}  // namespace
}  // namespace batten
