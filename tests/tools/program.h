#ifndef BATTEN_TESTS_TOOLS_PROGRAM_H_
#define BATTEN_TESTS_TOOLS_PROGRAM_H_

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/capability.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace batten {

/// Of an open curve, as a file.
inline constexpr char kSixPoints[] = "x,y\n0,0\n1,3\n2,-1\n3,4\n5,2\n6,0\n";

inline std::string ReadFile(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

inline std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

inline std::string DataFile(const std::string& name) {
  return std::string(BATTEN_SOURCE_DIR) + "/data/" + name;
}

/// An empty folder that is gone at the end of the test.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = ::testing::TempDir() + "/batten_XXXXXX";
    path_ = mkdtemp(name.data());
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string operator/(const std::string& name) const { return path_ + "/" + name; }
  std::string Write(const std::string& name, const std::string& text) const {
    std::ofstream(*this / name, std::ios::binary) << text;
    return *this / name;
  }
  std::vector<std::string> Names() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_)) {
      names.push_back(entry.path().filename());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

 private:
  std::string path_;
};

/// Sanitizers need terabytes of addresses.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kCanLimitMemory = false;
#else
inline constexpr bool kCanLimitMemory = true;
#endif

/// How a run of the program ended.
struct Ended {
  int status = -1;
  int signal = 0;  // that killed it; 0: none
  std::string out;
  std::string err;

  nlohmann::json Json() const { return nlohmann::json::parse(out); }
};

/// The program as a process, from its start to Wait().
class Program {
 public:
  /// Where its standard output goes instead of to a file that Wait() reads; "" closes it.
  struct Streams {
    std::string input;  // text on standard input
    int input_file = -1;
    int output_file = -1;
    rlim_t file_size = RLIM_INFINITY;  // of the largest file it may write, in bytes
    rlim_t memory = RLIM_INFINITY;     // of its addresses, in bytes
    bool obeys_permissions = false;    // of files and folders, though root runs the tests
  };

  explicit Program(std::vector<std::string> arguments) : Program(std::move(arguments), Streams()) {}
  Program(std::vector<std::string> arguments, const Streams& streams) {
    arguments.insert(arguments.begin(), BATTEN_BINARY);
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    const std::string input = folder_.Write("input", streams.input);
    pid_ = fork();
    if (pid_ != 0) return;
    // A background job of a shell ignores interrupts, which the program would inherit.
    signal(SIGINT, SIG_DFL);
    signal(SIGTERM, SIG_DFL);
    signal(SIGHUP, SIG_DFL);
    dup2(streams.input_file >= 0 ? streams.input_file : open(input.c_str(), O_RDONLY), 0);
    dup2(streams.output_file >= 0 ? streams.output_file : Create("output"), 1);
    dup2(Create("error"), 2);
    Limit(RLIMIT_FSIZE, streams.file_size);
    Limit(RLIMIT_AS, streams.memory);
    if (streams.obeys_permissions) {
      prctl(PR_CAPBSET_DROP, CAP_DAC_OVERRIDE);
      prctl(PR_CAPBSET_DROP, CAP_DAC_READ_SEARCH);
    }
    // Benchmarks of tests that run at once are not to see each other.
    setenv("TMPDIR", (folder_ / "").c_str(), 1);
    execv(BATTEN_BINARY, pointers.data());
    _exit(126);
  }
  ~Program() {
    if (pid_ > 0) {
      kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void Send(int signal_number) const { kill(pid_, signal_number); }

  /// Waits until it has used so much processor time: then it works.
  void WaitUntilBusy(double seconds) const {
    for (int attempt = 0; attempt < 3000; ++attempt) {
      std::istringstream stat(ReadFile("/proc/" + std::to_string(pid_) + "/stat"));
      std::string field;
      constexpr int kFieldsBeforeUserTime = 13;
      for (int i = 0; i < kFieldsBeforeUserTime; ++i) stat >> field;
      double ticks = 0.0;
      if (stat >> ticks && ticks >= seconds * static_cast<double>(sysconf(_SC_CLK_TCK))) return;
      usleep(20000);
    }
    ADD_FAILURE() << "the program never became busy";
  }

  Ended Wait() {
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    Ended ended;
    if (WIFEXITED(status)) ended.status = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) ended.signal = WTERMSIG(status);
    ended.out = ReadFile(folder_ / "output");
    ended.err = ReadFile(folder_ / "error");
    return ended;
  }

 private:
  static void Limit(int resource, rlim_t most) {
    if (most == RLIM_INFINITY) return;
    const rlimit limit = {most, most};
    setrlimit(static_cast<__rlimit_resource>(resource), &limit);
  }
  int Create(const std::string& name) const {
    return open((folder_ / name).c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  }

  TemporaryFolder folder_;
  pid_t pid_ = -1;
};

inline Ended RunBatten(std::vector<std::string> arguments, const std::string& input = "") {
  Program::Streams streams;
  streams.input = input;
  return Program(std::move(arguments), streams).Wait();
}

/// While it lives, programs are looked for in a folder that holds nothing but, if given, a gnuplot
/// of the test's own: a script of /bin/sh.
class OtherGnuplot {
 public:
  explicit OtherGnuplot(const std::string& script = "") : path_(std::getenv("PATH")) {
    if (!script.empty()) chmod(folder_.Write("gnuplot", "#!/bin/sh\n" + script).c_str(), 0755);
    setenv("PATH", (folder_ / "").c_str(), 1);
  }
  ~OtherGnuplot() { setenv("PATH", path_.c_str(), 1); }
  OtherGnuplot(const OtherGnuplot&) = delete;
  OtherGnuplot& operator=(const OtherGnuplot&) = delete;

 private:
  TemporaryFolder folder_;
  std::string path_;
};

/// One line on standard error that contains all of `parts`, nothing on standard output, status 2.
inline void ExpectRefused(const Ended& ended, const std::vector<std::string>& parts) {
  EXPECT_EQ(ended.status, 2) << ended.err;
  EXPECT_EQ(ended.signal, 0);
  EXPECT_EQ(ended.out, "");
  EXPECT_EQ(Lines(ended.err).size(), 1u) << ended.err;
  EXPECT_FALSE(ended.err.empty() || ended.err.back() != '\n');
  for (const std::string& part : parts) {
    EXPECT_NE(ended.err.find(part), std::string::npos) << "no \"" << part << "\" in " << ended.err;
  }
}

}  // namespace batten

#endif  // BATTEN_TESTS_TOOLS_PROGRAM_H_
