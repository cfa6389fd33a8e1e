#include <fcntl.h>
#include <glog/logging.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "experiments/atomic_file.h"
#include "experiments/running_solver.h"
#include "tools/command.h"
#include "tools/interrupts.h"

namespace batten {
namespace {

// errno of the failure, or 0.
int WriteAll(int file, const std::string& text) {
  for (size_t begin = 0; begin < text.size();) {
    const ssize_t written = write(file, text.data() + begin, text.size() - begin);
    if (written >= 0) {
      begin += static_cast<size_t>(written);
    } else if (errno != EINTR) {
      return errno;
    }
  }
  return 0;
}

void PrintError(const std::string& message) { WriteAll(STDERR_FILENO, OneLine(message) + "\n"); }

// For faults after which nothing can be relied on: no destructors, no exit handlers.
[[noreturn]] void EndAfterFault(const std::string& what) {
  PrintError("batten: internal error: " + what);
  RemovePendingTemporaryFiles();
  _exit(kFault);
}

/// What runs, for last words: "newton: ", or nothing.
std::string RunningText() {
  const std::string name = RunningSolverName();
  return name.empty() ? name : name + ": ";
}

pid_t own_process = 0;
bool main_has_returned = false;

/// A plugin that calls exit() is not to look like a run that went well. In a child, whose end its
/// parent judges, nothing is said.
void OnExit() {
  if (main_has_returned || getpid() != own_process) return;
  PrintError("batten: " + RunningText() + "a plugin has ended the program with exit()");
  RemovePendingTemporaryFiles();
  _exit(kFault);
}

#if defined(__SANITIZE_ADDRESS__)
void HandleCrashes() {}  // the sanitizer does, and says more
#else
/// Says which solver it was, and dies as the signal has it.
void OnCrash(int number) {
  if (getpid() == own_process) {
    // No std::string: memory may be what is broken.
    const char* const name = RunningSolverName();
    for (const char* text : {"batten: ", name, *name == '\0' ? "" : ": ",
                             "ended by a signal: ", sigdescr_np(number), "\n"}) {
      if (write(STDERR_FILENO, text, std::strlen(text)) < 0) break;
    }
  }
  raise(number);  // the handler is gone by now
}

void HandleCrashes() {
  struct sigaction action = {};
  action.sa_handler = &OnCrash;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_NODEFER);
  for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) {
    sigaction(number, &action, nullptr);
  }
}
#endif

void HandlePlugins() {
  own_process = getpid();
  std::atexit(&OnExit);
  HandleCrashes();
}

/// Ends the program at a failed CHECK, ours or Ceres', before glog prints a stack trace and aborts.
class FatalSink : public google::LogSink {
 public:
  void send(google::LogSeverity severity, const char* /*path*/, const char* file, int line,
            const google::LogMessageTime& /*time*/, const char* message, size_t length) override {
    if (severity != google::GLOG_FATAL) return;
    EndAfterFault(std::string(file) + ":" + std::to_string(line) + ": " +
                  std::string(message, length));
  }
};

[[noreturn]] void OnTerminate() {
  std::string what = "an exception nobody caught";
  try {
    if (std::current_exception() != nullptr) std::rethrow_exception(std::current_exception());
  } catch (const std::exception& exception) {
    what = exception.what();
  } catch (...) {
    what = "an exception of unknown type";
  }
  EndAfterFault(what);
}

/// Ceres warns of what its summaries say anyway; only FatalSink hears anything, no file is written.
void SilenceLogs(const char* program) {
  FLAGS_minloglevel = google::GLOG_FATAL;
  FLAGS_stderrthreshold = google::NUM_SEVERITIES;
  FLAGS_logtostderr = false;
  FLAGS_alsologtostderr = false;
  for (int severity = google::GLOG_INFO; severity < google::NUM_SEVERITIES; ++severity) {
    google::SetLogDestination(severity, "");
  }
  google::InitGoogleLogging(program);
  static auto& sink = *new FatalSink;  // for as long as the process lives
  google::AddLogSink(&sink);
  std::set_terminate(&OnTerminate);
}

/// A closed standard stream would give its number to the first file that is opened, which would
/// then receive our messages.
void FillStandardStreams() {
  for (const int file : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    // Not for writing: results that go nowhere are to be an error.
    while (fcntl(file, F_GETFD) == -1 && open("/dev/null", O_RDONLY) >= 0) {
    }
  }
}

int Main(const std::vector<std::string>& arguments) {
  CommandOutput output;
  int status = kFault;
  try {
    status = RunCommandLine(arguments, &output);
  } catch (const std::bad_alloc&) {
    output = {"", "batten: out of memory: this problem needs more than the system gives"};
    status = kFault;
  } catch (const std::exception& exception) {
    output = {"", std::string("batten: internal error: ") + exception.what()};
    status = kFault;
  }
  const int error_number = WriteAll(STDOUT_FILENO, output.results);
  // Whoever closes a pipe has read enough.
  if (error_number != 0 && error_number != EPIPE) {
    if (output.error.empty()) {
      output.error = std::string("cannot write standard output: ") + std::strerror(error_number);
    }
    status = std::max(status, kBadInput);
  }
  if (!output.error.empty()) PrintError(output.error);
  return status;
}

}  // namespace
}  // namespace batten

int main(int argc, char** argv) {
  batten::FillStandardStreams();
  batten::SilenceLogs(argc > 0 ? argv[0] : "batten");
  batten::HandleInterrupts();
  batten::HandlePlugins();
  const int status = batten::Main(std::vector<std::string>(argv + (argc > 0 ? 1 : 0), argv + argc));
  batten::main_has_returned = true;
  return status;
}
