#ifndef BATTEN_EXPERIMENTS_CHILD_PROCESS_H_
#define BATTEN_EXPERIMENTS_CHILD_PROCESS_H_

#include <sys/types.h>

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace batten {

struct ChildLimits {
  double wall_seconds = 60.0;
  double cpu_seconds = 60.0;  // rounded up to whole ones
  int memory_mb = 4096;       // on top of what the parent has
};

/// How a child ended.
struct ChildEnd {
  enum class How { kAnswered, kCrashed, kOutOfMemory, kWallLimit, kCpuLimit };
  How how = How::kCrashed;
  std::string message;  // one sentence, empty if it answered
  std::string answer;
  std::string thrown;   // what() of an exception that ended the work
  int wait_status = 0;  // as of wait(2)
  double wall_seconds = 0.0;
  double cpu_seconds = 0.0;
  long peak_memory_kb = 0;
};
/// answered, crashed, out_of_memory, wall_limit, cpu_limit.
const char* ToString(ChildEnd::How how);

/// The last line of what a child printed that is not empty: its first 300 characters, in ASCII.
std::string LastLineOfLog(const std::string& path);

/// A piece of work in a process of its own, which is a copy of this one (fork without exec: a
/// program that links Ceres takes 10 ms and more to start). What it prints goes to a log file; it
/// dies with its parent. The parent may have other threads that hold no lock the work needs.
class ChildProcess {
 public:
  /// Null with one sentence in `error` where no process can be made. `work` runs in the child and
  /// returns its answer.
  static std::unique_ptr<ChildProcess> Start(const ChildLimits& limits, const std::string& log_file,
                                             const std::function<std::string()>& work,
                                             std::string* error);
  ~ChildProcess();  ///< Kills it if it still runs.
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  int file() const { return file_; }  ///< Of its answer: readable when there is something to do.
  double seconds_left() const;        ///< Until it is killed.
  double seconds() const;             ///< Since its start.
  /// Takes what is there; true when it has ended or its time is over.
  bool Attend();
  /// After Attend() said so: waits, and tells how it went.
  ChildEnd Finish();

 private:
  using Clock = std::chrono::steady_clock;
  ChildProcess() = default;

  pid_t pid_ = -1;
  int file_ = -1;
  ChildLimits limits_;
  Clock::time_point start_;
  std::string answer_;
  bool is_late_ = false;
};

/// In a child, of which no file, its log included, grows beyond 16 MB before: from now on others
/// may.
void AllowLargeFiles();

/// What `work` comes to in a process of its own that keeps no log; nothing where no process can be
/// made.
std::optional<ChildEnd> RunInChild(const ChildLimits& limits,
                                   const std::function<std::string()>& work);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_CHILD_PROCESS_H_
