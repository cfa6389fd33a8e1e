#include "tools/interrupts.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <string>
#include <thread>

#include "experiments/atomic_file.h"
#include "experiments/run.h"
#include "tools/command.h"

namespace batten {
namespace {

std::atomic<bool> run_watches{false};
int interrupt_pipe[2] = {-1, -1};

// Only what a signal handler may do: the rest happens in the thread at the pipe's other end.
void OnInterrupt(int /*signal*/) {
  const int error_number = errno;
  const char kind = run_watches && !InterruptRequested() ? 'r' : 'x';
  RequestInterrupt();
  const ssize_t ignored = write(interrupt_pipe[1], &kind, 1);
  static_cast<void>(ignored);
  errno = error_number;
}

void WaitForInterrupts() {
  for (char kind = 0; kind != 'x';) {
    const ssize_t count = read(interrupt_pipe[0], &kind, 1);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return;
  }
  RemovePendingTemporaryFiles();
  // Where a bar of progress may stand, its line is cleared first.
  const std::string message =
      std::string(isatty(STDERR_FILENO) == 1 ? "\r\033[K" : "") + "interrupted\n";
  const ssize_t ignored = write(STDERR_FILENO, message.data(), message.size());
  static_cast<void>(ignored);
  _exit(kInterruptedStatus);
}

void Handle(int signal_number) {
  struct sigaction action {};
  sigaction(signal_number, nullptr, &action);
  if (action.sa_handler == SIG_IGN) return;
  action = {};
  action.sa_handler = &OnInterrupt;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(signal_number, &action, nullptr);
}

}  // namespace

void HandleInterrupts() {
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
  if (pipe2(interrupt_pipe, O_CLOEXEC) != 0) return;  // then a signal ends the program as ever
  std::thread(&WaitForInterrupts).detach();
  Handle(SIGINT);
  Handle(SIGTERM);
  Handle(SIGHUP);
}

InterruptibleRun::InterruptibleRun() { run_watches = true; }
InterruptibleRun::~InterruptibleRun() { run_watches = false; }

}  // namespace batten
