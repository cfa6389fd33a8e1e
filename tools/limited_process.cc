#include "tools/limited_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <new>

#include "experiments/run.h"

namespace batten {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kCanLimitMemory = false;  // they need terabytes of addresses
#else
constexpr bool kCanLimitMemory = true;
#endif

// Statuses of the child that are none of the program's own.
constexpr int kThrewStatus = 101;
constexpr int kOutOfMemoryStatus = 102;

void Limit(int resource, double most) {
  const auto limit = static_cast<rlim_t>(most);
  const rlimit both = {limit, limit};
  setrlimit(static_cast<__rlimit_resource>(resource), &both);
}

double AddressesInBytes() {
  std::ifstream statm("/proc/self/statm");
  double pages = 0.0;
  statm >> pages;
  return pages * static_cast<double>(sysconf(_SC_PAGESIZE));
}

bool WriteAll(int file, const std::string& text) {
  for (std::size_t begin = 0; begin < text.size();) {
    const ssize_t written = write(file, text.data() + begin, text.size() - begin);
    if (written < 0 && errno != EINTR) return false;
    if (written > 0) begin += static_cast<std::size_t>(written);
  }
  return true;
}

/// The child, from fork to its end.
[[noreturn]] void RunChild(const std::function<std::string()>& work, const ProcessLimits& limits,
                           int output, int errors) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) signal(number, SIG_DFL);
  const int nowhere = open("/dev/null", O_RDWR);
  dup2(nowhere, STDIN_FILENO);
  dup2(nowhere, STDOUT_FILENO);
  dup2(errors, STDERR_FILENO);
  Limit(RLIMIT_CORE, 0.0);
  Limit(RLIMIT_CPU, std::ceil(limits.seconds) + 1.0);
  if (kCanLimitMemory) {
    constexpr double kMib = 1048576.0;
    Limit(RLIMIT_AS, AddressesInBytes() + limits.memory_in_mib * kMib);
  }
  int status = 0;
  try {
    if (!WriteAll(output, work())) status = 1;
  } catch (const std::bad_alloc&) {
    status = kOutOfMemoryStatus;
  } catch (const std::exception& exception) {
    WriteAll(STDERR_FILENO, std::string(exception.what()) + "\n");
    status = kThrewStatus;
  } catch (...) {
    WriteAll(STDERR_FILENO, "something that is no std::exception\n");
    status = kThrewStatus;
  }
  _exit(status);
}

/// Reads until the other end is closed. False: time is up, or the program was interrupted.
bool ReadUntil(int file, double seconds, std::string* text) {
  const auto begin = std::chrono::steady_clock::now();
  for (;;) {
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
    if (passed.count() >= seconds || InterruptRequested()) return false;
    constexpr int kMilliseconds = 50;  // to look at the clock and for interrupts
    pollfd wanted = {file, POLLIN, 0};
    if (poll(&wanted, 1, kMilliseconds) <= 0) continue;
    char bytes[4096];
    const ssize_t count = read(file, bytes, sizeof(bytes));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return true;
    text->append(bytes, static_cast<std::size_t>(count));
  }
}

std::string LastLine(int file) {
  constexpr off_t kMost = 4096;
  const off_t size = lseek(file, 0, SEEK_END);
  std::string text(static_cast<std::size_t>(std::min(std::max<off_t>(size, 0), kMost)), '\0');
  const ssize_t count =
      pread(file, text.data(), text.size(), size - static_cast<off_t>(text.size()));
  text.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  const std::size_t line = text.find_last_of('\n');
  return line == std::string::npos ? text : text.substr(line + 1);
}

std::string Seconds(double seconds) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.1f s", seconds);
  return text;
}

double CpuSeconds(const rusage& usage) {
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

void Explain(int status, const rusage& usage, const ProcessLimits& limits, int errors,
             ProcessEnd* end) {
  if (end->kind == ProcessEnd::Kind::kInterrupted) return;
  const std::string last = LastLine(errors);
  const std::string said = last.empty() ? "" : ": " + last;
  if (end->kind == ProcessEnd::Kind::kTimedOut) {
    end->reason = "does not end within " + Seconds(limits.seconds) + ", of which it works " +
                  Seconds(CpuSeconds(usage));
  } else if (WIFSIGNALED(status)) {
    end->kind = ProcessEnd::Kind::kKilled;
    end->reason = std::string("crashes: ") + strsignal(WTERMSIG(status)) + said;
  } else if (WEXITSTATUS(status) == kOutOfMemoryStatus) {
    end->kind = ProcessEnd::Kind::kOutOfMemory;
    end->reason =
        "needs more than " + std::to_string(std::lround(limits.memory_in_mib)) + " MiB of memory";
  } else if (WEXITSTATUS(status) == kThrewStatus) {
    end->kind = ProcessEnd::Kind::kThrew;
    end->reason = "throws" + said;
  } else if (WEXITSTATUS(status) != 0) {
    end->kind = ProcessEnd::Kind::kExited;
    end->reason = "ends the program with status " + std::to_string(WEXITSTATUS(status)) + said;
  }
}

}  // namespace

ProcessEnd RunLimited(const std::function<std::string()>& work, const ProcessLimits& limits) {
  ProcessEnd end;
  int ends[2] = {-1, -1};
  const int errors = memfd_create("errors", MFD_CLOEXEC);
  const pid_t child = errors >= 0 && pipe2(ends, O_CLOEXEC) == 0 ? fork() : -1;
  if (child == 0) RunChild(work, limits, ends[1], errors);
  if (child < 0) {
    end.kind = ProcessEnd::Kind::kExited;
    end.reason = std::string("cannot be started: ") + std::strerror(errno);
  } else {
    close(ends[1]);
    ends[1] = -1;
    if (!ReadUntil(ends[0], limits.seconds, &end.output)) {
      end.kind =
          InterruptRequested() ? ProcessEnd::Kind::kInterrupted : ProcessEnd::Kind::kTimedOut;
      if (kill(-child, SIGKILL) != 0) kill(child, SIGKILL);
    }
    int status = 0;
    rusage usage = {};
    while (wait4(child, &status, 0, &usage) < 0 && errno == EINTR) {
    }
    Explain(status, usage, limits, errors, &end);
  }
  for (const int file : {ends[0], ends[1], errors}) {
    if (file >= 0) close(file);
  }
  return end;
}

}  // namespace batten
