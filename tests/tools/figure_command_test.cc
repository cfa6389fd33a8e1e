// Figures that the program draws: whole or not at all, and never of other data.
#include <gmock/gmock.h>

#include "tests/tools/program.h"

namespace batten {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// A gnuplot that says where it runs, and does not end.
std::string Endless(const std::string& mark) {
  return "echo $$ > " + mark + "\nexec /bin/sleep 60\n";
}

void WaitForFile(const std::string& path) {
  for (int i = 0; i < 3000 && ReadFile(path).empty(); ++i) usleep(20000);
  EXPECT_NE(ReadFile(path), "") << path << " never came";
}

/// One that has ended may still wait for its parent to ask.
bool HasEnded(const std::string& process) {
  for (int i = 0; i < 250; ++i) {
    const std::string stat = ReadFile("/proc/" + process + "/stat");
    if (stat.empty() || stat.find(") Z ") != std::string::npos) return true;
    usleep(20000);
  }
  return false;
}

class Figures : public ::testing::Test {
 protected:
  std::vector<std::string> FitArguments() const {
    return {"fit", "--problem=rhino", "--figure=" + svg_, "--out=" + (folder_ / "fit.json")};
  }
  std::vector<std::string> CompareArguments() const {
    return {"compare", "--problems=rhino", "--solvers=banded_qr,cg", "--repetitions=1",
            "--out=" + out_};
  }
  Ended Compare(const std::string& flag = "--quiet") const {
    std::vector<std::string> arguments = CompareArguments();
    arguments.push_back(flag);
    return RunBatten(arguments);
  }
  std::vector<std::string> NamesInOut() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(out_)) {
      names.push_back(entry.path().filename());
    }
    return names;
  }

  TemporaryFolder folder_;
  std::string svg_ = folder_ / "rhino.svg";
  std::string out_ = folder_ / "out";
};

TEST_F(Figures, HaveNoNamesThatWouldBeCommands) {
  std::filesystem::create_directory(folder_ / "w");
  ExpectRefused(RunBatten({"fit", "--problem=rhino",
                           "--figure=" + (folder_ / "w/x\nset print 'mark'\nprint 1\n#.svg")}),
                {"--figure: found", "\\x0a", "without control characters"});
  EXPECT_TRUE(std::filesystem::is_empty(folder_ / "w"));
  ExpectRefused(RunBatten({"fit", "--problem=rhino", "--figure=" + (folder_ / ".svg")}),
                {"--figure: found", "NAME.svg", "before the ending"});
}

TEST_F(Figures, AreXmlWhateverTheDataAreCalled) {
  const std::string data = folder_ / "a\xFF\x01<&.csv";
  std::filesystem::copy_file(DataFile("animals/rhino_100.csv"), data);
  ASSERT_EQ(RunBatten({"fit", data, "--closed", "--control_points=40", "--figure=" + svg_}).status,
            0);
  const std::string picture = ReadFile(svg_);
  EXPECT_THAT(picture, HasSubstr("a\xEF\xBF\xBD\xEF\xBF\xBD&lt;&amp;: 100 points"));
  EXPECT_NO_THROW(nlohmann::json(picture).dump()) << "not UTF-8";
}

TEST_F(Figures, WithoutGnuplotAreAnErrorOfBothCommandsThatLeavesTheRest) {
  const OtherGnuplot none;
  const Ended fit = RunBatten(FitArguments());
  EXPECT_EQ(fit.status, 2);
  EXPECT_THAT(fit.err, HasSubstr("--figure: gnuplot is not on PATH"));
  EXPECT_EQ(Lines(fit.err).size(), 1u);
  EXPECT_THAT(fit.out, HasSubstr("verified"));
  EXPECT_THAT(folder_.Names(), ElementsAre("fit.json", "rhino.dat", "rhino.gp"));
  const Ended compare = Compare();
  EXPECT_EQ(compare.status, 2);
  EXPECT_THAT(compare.err, HasSubstr("--figures: gnuplot is not on PATH"));
  EXPECT_THAT(compare.err, HasSubstr("--nofigures"));
  EXPECT_EQ(Lines(compare.err).size(), 1u);
  EXPECT_THAT(compare.out, HasSubstr("table.csv"));
  EXPECT_EQ(Lines(ReadFile(out_ + "/cells.jsonl")).size(), 2u);
  EXPECT_TRUE(std::filesystem::exists(out_ + "/rhino_fit.gp"));
  EXPECT_EQ(Compare("--nofigures").status, 0);
}

TEST_F(Figures, OfOlderDataGoWhereTheNewOnesCannotBeDrawn) {
  ASSERT_EQ(RunBatten(FitArguments()).status, 0);
  ASSERT_EQ(Compare().status, 0);
  ASSERT_TRUE(std::filesystem::exists(out_ + "/rhino_fit.svg"));
  {
    const OtherGnuplot broken("echo no luck >&2\nexit 1\n");
    const Ended fit = RunBatten(FitArguments());
    EXPECT_EQ(fit.status, 2);
    EXPECT_THAT(fit.err, HasSubstr("gnuplot failed: no luck"));
    EXPECT_EQ(Compare().status, 2);
  }
  EXPECT_FALSE(std::filesystem::exists(svg_));
  EXPECT_FALSE(std::filesystem::exists(out_ + "/rhino_fit.svg"));
  EXPECT_FALSE(std::filesystem::exists(out_ + "/rhino_convergence.svg"));
  EXPECT_EQ(Compare("--resume").status, 0);
  EXPECT_TRUE(std::filesystem::exists(out_ + "/rhino_fit.svg")) << "not finished without it";
}

TEST_F(Figures, OfAnotherRuleAreNotTakenOver) {
  ASSERT_EQ(Compare().status, 0);
  const std::string script = ReadFile(out_ + "/rhino_convergence.dat");
  std::vector<std::string> other = CompareArguments();
  other.insert(other.end(), {"--max_iterations=3", "--resume"});
  ASSERT_EQ(RunBatten(other).status, 0);
  ASSERT_NE(Lines(ReadFile(out_ + "/rhino_convergence.dat")).size(), Lines(script).size());
  ASSERT_EQ(Compare("--resume").status, 0);
  EXPECT_EQ(Lines(ReadFile(out_ + "/rhino_convergence.dat")).size(), Lines(script).size());
  ASSERT_EQ(Compare("--nofigures").status, 0);
  EXPECT_FALSE(std::filesystem::exists(out_ + "/rhino_fit.svg")) << "it shows older rows";
}

TEST_F(Figures, AndAllBesideThemAreNotLeftBehindByAFullDisk) {
  // Few control points: the picture is the largest file then.
  std::vector<std::string> arguments = FitArguments();
  arguments.push_back("--control_points=4");
  ASSERT_EQ(RunBatten(arguments).status, 0);
  const auto size = std::filesystem::file_size(svg_);
  for (const std::string& name : folder_.Names()) {
    const bool is_smaller = std::filesystem::file_size(folder_ / name) < size - 1;
    ASSERT_TRUE(is_smaller || folder_ / name == svg_) << name;
    std::filesystem::remove(folder_ / name);
  }
  Program::Streams streams;
  streams.file_size = size - 1;
  ExpectRefused(Program(arguments, streams).Wait(), {"cannot write " + svg_, "File too large"});
  EXPECT_THAT(folder_.Names(), IsEmpty());
}

TEST_F(Figures, AndGnuplotGoWithAFitThatIsInterrupted) {
  const TemporaryFolder marks;
  const OtherGnuplot endless(Endless(marks / "pid"));
  folder_.Write("rhino.dat", "old");
  Program program(FitArguments());
  WaitForFile(marks / "pid");
  program.Send(SIGTERM);
  EXPECT_EQ(program.Wait().status, 130);
  EXPECT_TRUE(HasEnded(Lines(ReadFile(marks / "pid")).at(0)));
  EXPECT_THAT(folder_.Names(), ElementsAre("rhino.dat"));
  EXPECT_EQ(ReadFile(folder_ / "rhino.dat"), "old");
}

TEST_F(Figures, AndGnuplotGoWithAComparisonThatIsInterrupted) {
  const TemporaryFolder marks;
  const OtherGnuplot endless(Endless(marks / "pid"));
  Program program(CompareArguments());
  WaitForFile(marks / "pid");
  program.Send(SIGINT);
  EXPECT_EQ(program.Wait().status, 130);
  EXPECT_TRUE(HasEnded(Lines(ReadFile(marks / "pid")).at(0)));
  EXPECT_THAT(NamesInOut(), IsEmpty());
}

}  // namespace
}  // namespace batten
