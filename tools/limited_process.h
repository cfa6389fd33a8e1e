#ifndef BATTEN_TOOLS_LIMITED_PROCESS_H_
#define BATTEN_TOOLS_LIMITED_PROCESS_H_

#include <functional>
#include <string>

namespace batten {

struct ProcessLimits {
  double seconds = 20.0;          ///< Of wall time.
  double memory_in_mib = 1024.0;  ///< Beyond what this process has. Not kept under a sanitizer.
};

/// How a child process came to its end.
struct ProcessEnd {
  enum class Kind { kReturned, kFailed, kInterrupted };
  Kind kind = Kind::kReturned;
  std::string output;  ///< What the work returned.
  std::string reason;  ///< One sentence where it did not return.
};

/// Calls `work` in a copy of this process (experiments/child_process.h), which may not take more
/// than `limits` and of whose prints at most the last line is told: a crash, a hang or a hunger for
/// memory ends the copy alone. Between InterruptibleRun's, an interrupt ends it.
ProcessEnd RunLimited(const std::function<std::string()>& work, const ProcessLimits& limits);

}  // namespace batten

#endif  // BATTEN_TOOLS_LIMITED_PROCESS_H_
