#include "experiments/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>
#include <new>

namespace batten {
namespace {

// Sanitizers need terabytes of addresses.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kCanLimitMemory = false;
#else
constexpr bool kCanLimitMemory = true;
#endif

// The first character of what a child writes; its last is the end of a line.
constexpr char kAnswer = 'A';
constexpr char kOutOfMemory = 'M';
constexpr char kException = 'E';

constexpr rlim_t kLongestLog = 16 << 20;  // bytes

void Limit(__rlimit_resource resource, rlim_t soft, rlim_t hard) {
  rlimit limit = {};
  getrlimit(resource, &limit);
  limit.rlim_max = std::min(limit.rlim_max, hard);
  limit.rlim_cur = std::min(limit.rlim_max, soft);
  setrlimit(resource, &limit);
}

rlim_t BytesInUse() {
  std::ifstream file("/proc/self/statm");
  rlim_t pages = 0;
  file >> pages;
  return pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
}

void SetLimits(const ChildLimits& limits) {
  Limit(RLIMIT_CORE, 0, 0);
  // Who prints in a loop is not to fill the disk.
  Limit(RLIMIT_FSIZE, kLongestLog, RLIM_INFINITY);
  const auto seconds = static_cast<rlim_t>(std::ceil(std::min(limits.cpu_seconds, 1e9)));
  // SIGXCPU at the first, SIGKILL a second later.
  Limit(RLIMIT_CPU, seconds, seconds + 1);
  if (!kCanLimitMemory) return;
  const rlim_t bytes = BytesInUse() + static_cast<rlim_t>(limits.memory_mb) * 1024 * 1024;
  Limit(RLIMIT_AS, bytes, bytes);
}

void WriteAll(int file, const std::string& text) {
  for (std::size_t begin = 0; begin < text.size();) {
    const ssize_t written = write(file, text.data() + begin, text.size() - begin);
    if (written < 0 && errno != EINTR) return;
    if (written > 0) begin += static_cast<std::size_t>(written);
  }
}

/// Signals as a program finds them at its start, but that a file which must not grow is an error of
/// writing; no file of the parent but `answer`, which moves to number 3, and the log.
void LeaveParent(pid_t parent, int answer, const std::string& log_file) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(0);
  setpgid(0, 0);  // an interrupt at the terminal is the parent's
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) signal(number, SIG_DFL);
  signal(SIGXFSZ, SIG_IGN);
  constexpr int kAnswerFile = 3;
  const int log = open(log_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
  // What was printed before a crash is to be in the log: in a file it would wait for a whole block.
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
  dup2(nothing, STDIN_FILENO);
  dup2(log >= 0 ? log : nothing, STDOUT_FILENO);
  dup2(log >= 0 ? log : nothing, STDERR_FILENO);
  dup2(answer, kAnswerFile);
  close_range(kAnswerFile + 1, ~0U, 0);
}

[[noreturn]] void Work(const ChildLimits& limits, const std::function<std::string()>& work) {
  constexpr int kAnswerFile = 3;
  SetLimits(limits);
  std::string answer;
  try {
    answer = kAnswer + work();
  } catch (const std::bad_alloc&) {
    answer = kOutOfMemory;
  } catch (const std::exception& exception) {
    answer = std::string(1, kException) + exception.what();
  } catch (...) {
    answer = std::string(1, kException) + "something that is no std::exception";
  }
  std::fflush(nullptr);
  WriteAll(kAnswerFile, answer + "\n");
  _exit(0);  // no destructors: they are the parent's
}

std::string SignalText(int number) {
  return std::string("signal ") + std::to_string(number) + " (" + strsignal(number) + ")";
}

}  // namespace

const char* ToString(ChildEnd::How how) {
  switch (how) {
    case ChildEnd::How::kAnswered:
      return "answered";
    case ChildEnd::How::kCrashed:
      return "crashed";
    case ChildEnd::How::kOutOfMemory:
      return "out_of_memory";
    case ChildEnd::How::kWallLimit:
      return "wall_limit";
    case ChildEnd::How::kCpuLimit:
      return "cpu_limit";
  }
  return "crashed";
}

std::string LastLineOfLog(const std::string& path) {
  constexpr std::size_t kLongest = 300;
  std::ifstream file(path, std::ios::binary);
  std::string last;
  for (std::string line; std::getline(file, line);) {
    if (!line.empty()) last = line.substr(0, kLongest);
  }
  std::replace_if(
      last.begin(), last.end(), [](unsigned char c) { return c < 32 || c > 126; }, '?');
  return last;
}

std::unique_ptr<ChildProcess> ChildProcess::Start(const ChildLimits& limits,
                                                  const std::string& log_file,
                                                  const std::function<std::string()>& work,
                                                  std::string* error) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) {
    *error = std::string("cannot make a pipe: ") + std::strerror(errno);
    return nullptr;
  }
  std::unique_ptr<ChildProcess> child(new ChildProcess);
  child->limits_ = limits;
  child->start_ = Clock::now();
  std::fflush(nullptr);  // else the child prints it too
  const pid_t parent = getpid();
  child->pid_ = fork();
  if (child->pid_ == 0) {
    LeaveParent(parent, ends[1], log_file);
    Work(limits, work);
  }
  close(ends[1]);
  child->file_ = ends[0];
  fcntl(ends[0], F_SETFL, O_NONBLOCK);
  if (child->pid_ > 0) return child;
  *error = std::string("cannot make a process: ") + std::strerror(errno);
  return nullptr;
}

ChildProcess::~ChildProcess() {
  if (file_ >= 0) close(file_);
  if (pid_ <= 0) return;
  kill(-pid_, SIGKILL);
  kill(pid_, SIGKILL);  // before it has its own group
  waitpid(pid_, nullptr, 0);
}

double ChildProcess::seconds() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

double ChildProcess::seconds_left() const { return limits_.wall_seconds - seconds(); }

bool ChildProcess::Attend() {
  char bytes[1 << 16];
  for (;;) {
    const ssize_t count = read(file_, bytes, sizeof(bytes));
    if (count > 0) {
      answer_.append(bytes, static_cast<std::size_t>(count));
    } else if (count == 0) {
      return true;
    } else if (errno != EINTR) {
      break;
    }
  }
  is_late_ = seconds_left() <= 0.0;
  return is_late_;
}

ChildEnd ChildProcess::Finish() {
  kill(-pid_, SIGKILL);  // nothing that it has started stays; its own status is made by now
  if (is_late_) kill(pid_, SIGKILL);
  int status = 0;
  rusage usage = {};
  while (wait4(pid_, &status, 0, &usage) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  ChildEnd end;
  end.wait_status = status;
  end.wall_seconds = seconds();
  const auto Seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  end.cpu_seconds = Seconds(usage.ru_utime) + Seconds(usage.ru_stime);
  end.peak_memory_kb = usage.ru_maxrss;
  const bool is_whole = answer_.size() >= 2 && answer_.back() == '\n';
  const char kind = is_whole ? answer_.front() : '\0';
  if (kind == kAnswer) {
    end.how = ChildEnd::How::kAnswered;
    end.answer = answer_.substr(1, answer_.size() - 2);
  } else if (kind == kOutOfMemory) {
    end.how = ChildEnd::How::kOutOfMemory;
    end.message = "needs more than " + std::to_string(limits_.memory_mb) + " MB of memory";
  } else if (kind == kException) {
    end.thrown = answer_.substr(1, answer_.size() - 2);
    end.message = "threw an exception: " + end.thrown;
  } else if (is_late_) {
    end.how = ChildEnd::How::kWallLimit;
    end.message = "killed after " + std::to_string(static_cast<long>(limits_.wall_seconds)) +
                  " s of wall time";
  } else if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) {
    end.how = ChildEnd::How::kCpuLimit;
    end.message = "killed after " +
                  std::to_string(static_cast<long>(std::ceil(limits_.cpu_seconds))) +
                  " s of processor time";
  } else if (WIFSIGNALED(status)) {
    end.message = "ended by " + SignalText(WTERMSIG(status));
  } else {
    end.message = "ended with status " + std::to_string(WEXITSTATUS(status)) + " and no result";
  }
  return end;
}

void AllowLargeFiles() {
  rlimit limit = {};
  getrlimit(RLIMIT_FSIZE, &limit);
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_FSIZE, &limit);
}

std::optional<ChildEnd> RunInChild(const ChildLimits& limits,
                                   const std::function<std::string()>& work) {
  std::string error;
  const auto process = ChildProcess::Start(limits, "/dev/null", work, &error);
  if (process == nullptr) return std::nullopt;
  constexpr int kInterval = 100;  // milliseconds
  while (!process->Attend()) {
    pollfd file = {process->file(), POLLIN, 0};
    poll(&file, 1, kInterval);
  }
  return process->Finish();
}

}  // namespace batten
