// The command `replay`, run as a process.
#include <gmock/gmock.h>

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

TEST(ReplayCommand, RefusesBadInput) {
  ExpectRefused(RunBatten({"replay"}), {"--problem"});
  ExpectRefused(RunBatten({"replay", "--problem=nowhere"}), {"--problem", "nowhere"});
  ExpectRefused(RunBatten({"replay", "--problem=rhino"}),
                {"lbfgs makes Hessian products", "--nocompile"});
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
