// The mark of the commit in results, by the script that each build runs.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace batten {
namespace {

namespace fs = std::filesystem;

bool Does(const std::string& command) {
  return std::system((command + " > /dev/null 2>&1").c_str()) == 0;
}

class BuildCommit : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!Does("cmake --version") || !Does("git --version")) GTEST_SKIP() << "no cmake, no git";
    std::string name = fs::temp_directory_path() / "batten_commit_XXXXXX";
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
    fs::create_directory(tree());
    std::ofstream(folder_ / "template") << "@BATTEN_GIT_COMMIT@";
  }
  void TearDown() override {
    if (!folder_.empty()) fs::remove_all(folder_);
  }
  fs::path tree() const { return folder_ / "tree"; }
  fs::path output() const { return folder_ / "output"; }
  bool Git(const std::string& arguments) const {
    return Does("git -C " + tree().string() + " -c user.name=N -c user.email=e@example.org " +
                arguments);
  }
  std::string Mark() const {
    EXPECT_TRUE(Does("cmake -DGIT=git -DSOURCE=" + tree().string() + " -DTEMPLATE=" +
                     (folder_ / "template").string() + " -DOUTPUT=" + output().string() +
                     " -P " BATTEN_SOURCE_DIR "/experiments/build_commit.cmake"));
    std::ifstream file(output());
    std::string mark;
    std::getline(file, mark);
    return mark;
  }

  fs::path folder_;
};

TEST_F(BuildCommit, SaysWhereTheTreeHasChanges) {
  EXPECT_EQ(Mark(), "unknown");
  std::ofstream(tree() / "a.cc") << "1";
  ASSERT_TRUE(Git("init -q") && Git("add a.cc") && Git("commit -q -m first"));
  const std::string clean = Mark();
  EXPECT_EQ(clean.find_first_not_of("0123456789abcdef"), std::string::npos) << clean;
  EXPECT_GE(clean.size(), 7u);
  std::ofstream(tree() / "a.cc") << "2";
  EXPECT_EQ(Mark(), clean + "-dirty");
  ASSERT_TRUE(Git("checkout -q a.cc"));
  EXPECT_EQ(Mark(), clean);
  std::ofstream(tree() / "new.cc") << "3";  // it is compiled, too
  EXPECT_EQ(Mark(), clean + "-dirty");
}

TEST_F(BuildCommit, LeavesTheFileAloneThatSaysItAlready) {
  ASSERT_EQ(Mark(), "unknown");
  const auto before = fs::last_write_time(output()) - std::chrono::hours(1);
  fs::last_write_time(output(), before);
  ASSERT_EQ(Mark(), "unknown");
  EXPECT_EQ(fs::last_write_time(output()), before);
}

}  // namespace
}  // namespace batten
