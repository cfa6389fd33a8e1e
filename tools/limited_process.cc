#include "tools/limited_process.h"

#include <poll.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstring>

#include "experiments/child_process.h"
#include "experiments/run.h"

namespace batten {
namespace {

std::string Seconds(double seconds) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.1f s", seconds);
  return text;
}

/// Why the work did not return.
std::string Reason(const ChildEnd& end, const ProcessLimits& limits, const std::string& log) {
  const std::string last = LastLineOfLog(log);
  const std::string said = last.empty() ? "" : ": " + last;
  if (end.how == ChildEnd::How::kWallLimit) {
    return "does not end within " + Seconds(limits.seconds) + ", of which it works " +
           Seconds(end.cpu_seconds);
  }
  if (end.how == ChildEnd::How::kOutOfMemory) {
    return "needs more than " + std::to_string(std::lround(limits.memory_in_mib)) +
           " MiB of memory";
  }
  if (!end.thrown.empty()) return "throws: " + end.thrown;
  if (WIFSIGNALED(end.wait_status)) {
    return std::string("crashes: ") + strsignal(WTERMSIG(end.wait_status)) + said;
  }
  return "ends the program with status " + std::to_string(WEXITSTATUS(end.wait_status)) + said;
}

}  // namespace

ProcessEnd RunLimited(const std::function<std::string()>& work, const ProcessLimits& limits) {
  // A second more of the processor: what hangs is told by the clock on the wall.
  const ChildLimits child_limits = {limits.seconds, std::ceil(limits.seconds) + 1.0,
                                    static_cast<int>(std::lround(limits.memory_in_mib))};
  ProcessEnd end;
  end.kind = ProcessEnd::Kind::kFailed;
  const int prints = memfd_create("prints", MFD_CLOEXEC);
  const std::string log = "/proc/self/fd/" + std::to_string(prints);
  std::string error;
  const auto child = ChildProcess::Start(child_limits, log, work, &error);
  if (child == nullptr) {
    end.reason = "cannot be started: " + error;
  } else {
    while (!child->Attend() && !InterruptRequested()) {
      constexpr int kMilliseconds = 50;  // to look at the clock and for interrupts
      pollfd wanted = {child->file(), POLLIN, 0};
      poll(&wanted, 1, kMilliseconds);
    }
    if (InterruptRequested()) {
      end.kind = ProcessEnd::Kind::kInterrupted;
    } else {
      const ChildEnd ended = child->Finish();
      if (ended.how == ChildEnd::How::kAnswered) end.kind = ProcessEnd::Kind::kReturned;
      end.output = ended.answer;
      if (end.kind == ProcessEnd::Kind::kFailed) end.reason = Reason(ended, limits, log);
    }
  }
  if (prints >= 0) close(prints);
  return end;
}

}  // namespace batten
