#include "experiments/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

namespace batten {
namespace {

namespace fs = std::filesystem;
using Strings = std::vector<std::string>;

// The failures below are wrong kinds of path: missing permissions would not stop root.
class AtomicFileTest : public testing::Test {
 protected:
  AtomicFileTest() {
    const auto* const info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) /
              ("atomic_file_" + std::string(info->name()) + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  ~AtomicFileTest() override { fs::remove_all(folder_); }

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }

  Strings Names() const {
    Strings names;
    for (const auto& entry : fs::directory_iterator(folder_)) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  static std::string Contents(const std::string& path) {
    std::ostringstream contents;
    contents << std::ifstream(path, std::ios::binary).rdbuf();
    return contents.str();
  }

  static void Write(const std::string& path, const std::string& contents) {
    std::string error;
    ASSERT_TRUE(WriteFileAtomically(path, contents, &error)) << error;
    EXPECT_EQ(error, "");
  }

  static std::string WriteError(const std::string& path, const std::string& contents) {
    std::string error;
    EXPECT_FALSE(WriteFileAtomically(path, contents, &error)) << path;
    return error;
  }

  fs::path folder_;
};

TEST_F(AtomicFileTest, WritesAndReplacesWholeFiles) {
  const std::string long_text = std::string(1000000, 'a') + std::string("\0\r\n", 3);
  Write(Path("fit.json"), long_text);
  EXPECT_EQ(Contents(Path("fit.json")), long_text);
  Write(Path("fit.json"), "short");
  EXPECT_EQ(Contents(Path("fit.json")), "short");
  Write(Path("fit.json"), "");
  EXPECT_EQ(Contents(Path("fit.json")), "");
  EXPECT_EQ(Names(), (Strings{"fit.json"}));
}

TEST_F(AtomicFileTest, ShowsNothingBeforeTheCommit) {
  Write(Path("fit.json"), "old");
  AtomicFile file;
  std::string error;
  ASSERT_TRUE(file.Open(Path("fit.json"), &error)) << error;
  file.stream() << "new " << 1234567 << std::flush;
  EXPECT_EQ(Contents(Path("fit.json")), "old");
  EXPECT_EQ(Names().size(), 2u);
  ASSERT_TRUE(file.Commit(&error)) << error;
  EXPECT_EQ(Contents(Path("fit.json")), "new 1234567");
  EXPECT_EQ(Names().size(), 1u);
}

TEST_F(AtomicFileTest, LeavesNothingBehindWithoutACommit) {
  Write(Path("fit.json"), "old");
  {
    AtomicFile file;
    std::string error;
    ASSERT_TRUE(file.Open(Path("fit.json"), &error)) << error;
    file.stream() << std::string(200000, 'n');
    ASSERT_TRUE(file.Open(Path("other.json"), &error)) << error;
    file.stream() << "other";
  }
  EXPECT_EQ(Contents(Path("fit.json")), "old");
  EXPECT_EQ(Names(), (Strings{"fit.json"}));
}

TEST_F(AtomicFileTest, CanBeUsedAgainAfterACommitAndAFailure) {
  AtomicFile file;
  std::string error;
  ASSERT_TRUE(file.Open(Path("a"), &error));
  file.stream() << "1";
  ASSERT_TRUE(file.Commit(&error));
  EXPECT_FALSE(file.stream() << "lost");
  EXPECT_FALSE(file.Open(Path("a/b"), &error));
  EXPECT_FALSE(file.stream() << "lost");
  ASSERT_TRUE(file.Open(Path("b"), &error));
  EXPECT_TRUE(file.stream() << "2");
  ASSERT_TRUE(file.Commit(&error));
  EXPECT_EQ(Contents(Path("a")) + Contents(Path("b")), "12");
  EXPECT_DEATH(file.Commit(&error), "no open file");
}

TEST_F(AtomicFileTest, ReportsAFullDisk) {
  const std::string expected = "cannot write /dev/full: No space left on device";
  EXPECT_EQ(WriteError("/dev/full", "x"), expected);
  EXPECT_EQ(WriteError("/dev/full", std::string(1000000, 'x')), expected);
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(AtomicFileTest, ReportsAWriteErrorFromTheMiddleEvenIfTheStreamWasCleared) {
  AtomicFile file;
  std::string error;
  ASSERT_TRUE(file.Open("/dev/full", &error)) << error;
  EXPECT_FALSE(file.stream() << "x" << std::flush);
  file.stream().clear();
  file.stream() << "y";
  EXPECT_FALSE(file.Commit(&error));
  EXPECT_EQ(error, "cannot write /dev/full: No space left on device");
}

TEST_F(AtomicFileTest, KeepsTheOldFileWhenTheNewOneDoesNotFit) {
  Write(Path("fit.json"), "old");
  struct rlimit before;
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  struct rlimit small = before;
  small.rlim_cur = 1000;
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string error = WriteError(Path("fit.json"), std::string(100000, 'x'));
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(error, "cannot write " + Path("fit.json") + ": File too large");
  EXPECT_EQ(Contents(Path("fit.json")), "old");
  EXPECT_EQ(Names(), (Strings{"fit.json"}));
}

TEST_F(AtomicFileTest, ReportsAStreamThatFailedByItself) {
  AtomicFile file;
  std::string error;
  ASSERT_TRUE(file.Open(Path("fit.json"), &error)) << error;
  file.stream().setstate(std::ios::failbit);
  EXPECT_FALSE(file.Commit(&error));
  EXPECT_EQ(error, "cannot write " + Path("fit.json") + ": Input/output error");
  EXPECT_TRUE(Names().empty());
}

TEST_F(AtomicFileTest, WritesDevicesAndPipesDirectly) {
  Write("/dev/null", "x");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  Write("/dev/fd/" + std::to_string(ends[1]), "through");
  char received[8] = {};
  EXPECT_EQ(read(ends[0], received, 7), 7);
  EXPECT_STREQ(received, "through");
  close(ends[0]);
  close(ends[1]);
}

TEST_F(AtomicFileTest, RefusesPathsThatCannotBeFiles) {
  Write(Path("file"), "x");
  const std::string start = "cannot write ";
  EXPECT_EQ(WriteError(Path("file/fit.json"), "x"),
            start + Path("file/fit.json") + ": Not a directory");
  EXPECT_EQ(WriteError(Path(""), "x"), start + Path("") + ": Is a directory");
  EXPECT_EQ(WriteError(folder_.string(), "x"), start + folder_.string() + ": Is a directory");
  EXPECT_EQ(WriteError("", "x"), start + ": No such file or directory");
  const std::string name(300, 'n');
  EXPECT_EQ(WriteError(Path(name), "x"), start + Path(name) + ": File name too long");
  EXPECT_EQ(Names(), (Strings{"file"}));
}

TEST_F(AtomicFileTest, CreatesFoldersOnlyWhenAsked) {
  EXPECT_EQ(WriteError(Path("a/b/fit.json"), "x"),
            "cannot write " + Path("a/b/fit.json") + ": No such file or directory");
  EXPECT_TRUE(Names().empty());
  std::string error;
  ASSERT_TRUE(CreateDirectories(Path("a/b"), &error)) << error;
  ASSERT_TRUE(CreateDirectories(Path("a/b"), &error)) << error;
  ASSERT_TRUE(CreateDirectories(Path("a/c/d/"), &error)) << error;
  ASSERT_TRUE(CreateDirectories("", &error)) << error;
  EXPECT_TRUE(fs::is_directory(Path("a/c/d")));
  Write(Path("a/b/fit.json"), "x");
  for (const char* path : {"a/b/fit.json", "a/b/fit.json/c"}) {
    EXPECT_FALSE(CreateDirectories(Path(path), &error)) << path;
    EXPECT_EQ(error, "cannot create folder " + Path(path) + ": Not a directory");
  }
}

TEST_F(AtomicFileTest, TakesTheLongestNameAFileMayHave) {
  Write(Path(std::string(255, 'n')), "x");
  EXPECT_EQ(Names(), (Strings{std::string(255, 'n')}));
}

TEST_F(AtomicFileTest, WritesInTheCurrentFolder) {
  const fs::path before = fs::current_path();
  fs::current_path(folder_);
  Write("fit.json", "x");
  fs::current_path(before);
  EXPECT_EQ(Names(), (Strings{"fit.json"}));
}

TEST_F(AtomicFileTest, KeepsPermissionsAndSymbolicLinks) {
  fs::create_directory(Path("kept"));
  Write(Path("kept/fit.json"), "old");
  ASSERT_EQ(chmod(Path("kept/fit.json").c_str(), 0640), 0);
  fs::create_symlink("kept/fit.json", Path("link"));
  Write(Path("link"), "new");
  EXPECT_TRUE(fs::is_symlink(Path("link")));
  EXPECT_EQ(Contents(Path("kept/fit.json")), "new");
  EXPECT_EQ(static_cast<int>(fs::status(Path("kept/fit.json")).permissions()), 0640);
}

TEST_F(AtomicFileTest, LeavesThePermissionsOfANewFileToTheUmask) {
  const mode_t before = umask(027);
  Write(Path("fit.json"), "x");
  umask(before);
  EXPECT_EQ(static_cast<int>(fs::status(Path("fit.json")).permissions()), 0640);
}

TEST_F(AtomicFileTest, RemovesPendingTemporariesOnRequest) {
  AtomicFile first;
  AtomicFile second;
  std::string error;
  ASSERT_TRUE(first.Open(Path("first"), &error));
  ASSERT_TRUE(second.Open(Path("second"), &error));
  EXPECT_EQ(Names().size(), 2u);
  RemovePendingTemporaryFiles();
  EXPECT_TRUE(Names().empty());
  EXPECT_FALSE(first.Commit(&error));
  EXPECT_EQ(error, "cannot write " + Path("first") + ": No such file or directory");
  RemovePendingTemporaryFiles();
}

TEST_F(AtomicFileTest, KeepsTheParentsTemporariesInAForkedChild) {
  AtomicFile file;
  std::string error;
  ASSERT_TRUE(file.Open(Path("fit.json"), &error));
  const pid_t child = fork();
  if (child == 0) {
    RemovePendingTemporaryFiles();
    _exit(0);
  }
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_EQ(status, 0);
  file.stream() << "x";
  EXPECT_TRUE(file.Commit(&error)) << error;
  EXPECT_EQ(Contents(Path("fit.json")), "x");
}

}  // namespace
}  // namespace batten
