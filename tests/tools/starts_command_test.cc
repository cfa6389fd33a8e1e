// `compare --starts`, run as a process.
#include <gmock/gmock.h>

#include "tests/tools/program.h"

namespace batten {
namespace {

using ::testing::HasSubstr;

TEST(CompareStarts, CountsBasinsOfEverySolver) {
  const TemporaryFolder folder;
  const Ended ended =
      RunBatten({"compare", "--problems=dolphin_free", "--solvers=foot_newton,newton", "--starts=3",
                 "--out=" + (folder / "out"), "--quiet"});
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("From 3 disturbed circles"));
  const auto solvers = Lines(ReadFile(folder / "out/starts_solvers.csv"));
  ASSERT_EQ(solvers.size(), 3U);
  EXPECT_THAT(solvers[1], HasSubstr("dolphin_free,foot_newton,3,"));
  EXPECT_EQ(Lines(ReadFile(folder / "out/starts_runs.csv")).size(), 7U);
  EXPECT_GE(Lines(ReadFile(folder / "out/starts_basins_dolphin_free.csv")).size(), 2U);
}

TEST(CompareStarts, GivesTheSameNumbersTwiceButForTimes) {
  const auto energies = [] {
    const TemporaryFolder folder;
    RunBatten({"compare", "--problems=cat_free", "--solvers=newton", "--starts=2",
               "--out=" + (folder / "out"), "--quiet"});
    std::string text;
    for (const std::string& line : Lines(ReadFile(folder / "out/starts_runs.csv"))) {
      // problem,solver,start,status,iterations,seconds,energy,...
      std::size_t comma = 0;
      for (int k = 0; k < 5; ++k) comma = line.find(',', comma) + 1;
      text += line.substr(0, comma) + line.substr(line.find(',', comma)) + "\n";
    }
    return text;
  };
  EXPECT_EQ(energies(), energies());
}

TEST(CompareStarts, RefusesFixedParametersAndNoStarts) {
  const Ended fixed = RunBatten({"compare", "--problems=rhino", "--solvers=cg", "--starts=2"});
  EXPECT_EQ(fixed.status, 2);
  EXPECT_THAT(fixed.err, HasSubstr("rhino: starts are compared where parameters are free"));
  const Ended none =
      RunBatten({"compare", "--problems=rhino_free", "--solvers=newton", "--starts=0"});
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("--starts: found 0"));
}

}  // namespace
}  // namespace batten
