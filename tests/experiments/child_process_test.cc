#include "experiments/child_process.h"

#include <gmock/gmock.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "tests/problems/scratch_folder.h"

namespace batten {
namespace {

using ::testing::HasSubstr;
using How = ChildEnd::How;

class Child : public ::testing::Test {
 protected:
  ChildEnd Run(const std::function<std::string()>& work) {
    std::string error;
    const auto child = ChildProcess::Start(limits_, log_, work, &error);
    EXPECT_NE(child, nullptr) << error;
    for (bool ended = false; !ended;) {
      pollfd file = {child->file(), POLLIN, 0};
      poll(&file, 1, 10);
      ended = child->Attend();
    }
    return child->Finish();
  }
  std::string Log() const {
    std::ifstream file(log_);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }

  ScratchFolder folder_;
  std::string log_ = folder_.path() / "log";
  ChildLimits limits_ = {10.0, 10.0, 512};
};

TEST_F(Child, Answers) {
  const std::string long_answer(3'000'000, 'x');  // more than a pipe holds
  const ChildEnd end = Run([&] { return long_answer; });
  EXPECT_EQ(end.how, How::kAnswered);
  EXPECT_EQ(end.answer, long_answer);
  EXPECT_EQ(end.message, "");
  EXPECT_GT(end.peak_memory_kb, 0);
}

TEST_F(Child, PrintsToItsLog) {
  const ChildEnd end = Run([] {
    std::puts("to output");
    std::fputs("to error\n", stderr);
    return std::string("x");
  });
  EXPECT_EQ(end.how, How::kAnswered);
  EXPECT_THAT(Log(), HasSubstr("to output"));
  EXPECT_THAT(Log(), HasSubstr("to error"));
}

TEST_F(Child, ThatCrashesIsToldWithItsSignal) {
  const ChildEnd end = Run([]() -> std::string {
    signal(SIGSEGV, SIG_DFL);  // sanitizers have their own
    raise(SIGSEGV);
    return "x";
  });
  EXPECT_EQ(end.how, How::kCrashed);
  EXPECT_THAT(end.message, HasSubstr("signal 11"));
}

TEST_F(Child, ThatThrowsOrLeavesIsToldSo) {
  const ChildEnd thrown = Run([]() -> std::string { throw std::runtime_error("no such luck"); });
  EXPECT_EQ(thrown.how, How::kCrashed);
  EXPECT_THAT(thrown.message, HasSubstr("no such luck"));
  const ChildEnd left = Run([]() -> std::string { _exit(7); });
  EXPECT_EQ(left.how, How::kCrashed);
  EXPECT_THAT(left.message, HasSubstr("status 7"));
}

TEST_F(Child, ThatSleepsIsKilled) {
  limits_.wall_seconds = 0.2;
  const ChildEnd end = Run([] {
    pause();
    return std::string("x");
  });
  EXPECT_EQ(end.how, How::kWallLimit);
  EXPECT_GE(end.wall_seconds, 0.2);
}

TEST_F(Child, ThatWorksForTooLongIsKilled) {
  limits_.cpu_seconds = 1.0;
  const ChildEnd end = Run([] {
    for (volatile unsigned k = 0;; k = k + 1U) {
    }
    return std::string("x");
  });
  EXPECT_EQ(end.how, How::kCpuLimit) << end.message;
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST_F(Child, ThatTakesTooMuchMemoryIsToldSo) {
  limits_.memory_mb = 64;
  const ChildEnd end = Run([] {
    std::vector<char> hog(std::size_t{256} << 20, 'x');
    return std::string(1, hog.back());
  });
  EXPECT_EQ(end.how, How::kOutOfMemory);
  EXPECT_THAT(end.message, HasSubstr("64 MB"));
}
#endif

TEST_F(Child, LeavesNoProcessBehind) {
  limits_.wall_seconds = 0.2;
  // Its own child holds the pipe open.
  const ChildEnd end = Run([this] {
    const pid_t grandchild = fork();
    if (grandchild == 0) {
      pause();
      _exit(0);
    }
    std::ofstream(folder_.path() / "grandchild") << grandchild << "\n";
    return std::string("x");
  });
  EXPECT_EQ(end.how, How::kAnswered);
  pid_t grandchild = 0;
  std::ifstream(folder_.path() / "grandchild") >> grandchild;
  ASSERT_GT(grandchild, 0);
  // It may be there as a zombie until its new parent has seen it.
  std::string state = "gone";
  for (int attempt = 0; attempt < 100 && state != "Z" && state != "X"; ++attempt) {
    std::ifstream stat("/proc/" + std::to_string(grandchild) + "/stat");
    std::string field;
    if (!(stat >> field >> field >> state)) break;
    usleep(10000);
  }
  EXPECT_NE(state, "S");
}

}  // namespace
}  // namespace batten
