// Exit statuses that good and bad input alone do not give; 3 is in resume_test.cc.
#include <gmock/gmock.h>

#include "tests/tools/program.h"

namespace batten {
namespace {

TEST(ExitStatus, IsSeventyWhereMemoryRunsOut) {
  if (!kCanLimitMemory) GTEST_SKIP() << "the sanitizer needs terabytes of addresses";
  const TemporaryFolder folder;
  Program::Streams streams;
  streams.memory = rlim_t{400} << 20;
  const Ended ended = Program({"fit", "--problem=rhino", "--control_points=10000000",
                               "--out=" + (folder / "fit.json")},
                              streams)
                          .Wait();
  EXPECT_EQ(ended.status, 70);
  EXPECT_EQ(ended.err, "batten: out of memory: this problem needs more than the system gives\n");
  EXPECT_EQ(ended.out, "");
  EXPECT_THAT(folder.Names(), ::testing::IsEmpty());
}

}  // namespace
}  // namespace batten
