// Files that the program writes: checked before the work, whole or not at all.
#include <gmock/gmock.h>

#include "tests/tools/program.h"

namespace batten {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A fit that no stop rule but the time limit ends soon: of degree 9 through as many points as
/// control points, by the slowest method in small steps.
std::vector<std::string> LongFit(const std::string& points) {
  return {"fit",
          points,
          "--closed",
          "--degree=9",
          "--control_points=3697",
          "--solver=lspia/relaxation=0.01",
          "--gradient_tolerance=0",
          "--max_iterations=1000000000",
          "--max_seconds=60",
          "--quiet"};
}

class FitFiles : public ::testing::Test {
 protected:
  FitFiles() : points_(folder_.Write("points.csv", kSixPoints)) {}

  Ended Fit(std::vector<std::string> flags) {
    flags.insert(flags.begin(), {"fit", points_, "--control_points=5"});
    return RunBatten(std::move(flags));
  }

  TemporaryFolder folder_;
  std::string points_;
};

TEST_F(FitFiles, AreRefusedWhereTheyCannotBeWritten) {
  for (const std::string flag : {"out", "trace", "iterates"}) {
    ExpectRefused(Fit({"--" + flag + "=" + points_ + "/x.json"}),
                  {"--" + flag + ": cannot write", "Not a directory"});
    ExpectRefused(Fit({"--" + flag + "=" + (folder_ / "none/x.json")}), {"No such file"});
    ExpectRefused(Fit({"--" + flag + "=" + (folder_ / "")}), {"directory"});
    ExpectRefused(Fit({"--" + flag + "=-"}), {"--" + flag + ": found -"});
  }
  ExpectRefused(Fit({"--figure=" + points_ + "/x.svg"}), {"--figure: cannot write"});
  ExpectRefused(Fit({"--figure=" + (folder_ / "x.png")}), {"--figure: ", "x.png", ".svg"});
  EXPECT_THAT(folder_.Names(), ElementsAre("points.csv"));
}

TEST_F(FitFiles, AreCheckedBeforeTheDataAreRead) {
  ExpectRefused(RunBatten({"fit", folder_ / "none.csv", "--control_points=5",
                           "--out=" + (folder_ / "none/x.json")}),
                {"--out: cannot write"});
}

TEST_F(FitFiles, MustDifferFromEachOtherAndFromTheInput) {
  const std::string same = folder_ / "same";
  ExpectRefused(Fit({"--out=" + same, "--trace=" + (folder_ / "./same")}),
                {"--trace: found", "--out writes"});
  ExpectRefused(Fit({"--trace=" + (folder_ / "a.dat"), "--figure=" + (folder_ / "a.svg")}),
                {"--figure: found", "--trace writes"});
  ExpectRefused(Fit({"--out=" + points_}), {"--out: found", "is read"});
  std::filesystem::create_symlink(points_, folder_ / "link");
  ExpectRefused(Fit({"--out=" + (folder_ / "link")}), {"is read"});
  std::filesystem::create_hard_link(points_, folder_ / "twin");
  ExpectRefused(Fit({"--out=" + (folder_ / "twin")}), {"is read"});
  EXPECT_EQ(ReadFile(points_), kSixPoints);
}

TEST_F(FitFiles, MayBeDevices) {
  EXPECT_EQ(Fit({"--out=/dev/null", "--trace=/dev/null"}).status, 0);
}

TEST_F(FitFiles, MayBeStandardOutputMoreThanOnceWhateverIsBehindIt) {
  const Ended ended = Fit({"--out=/dev/stdout", "--trace=/dev/fd/1"});
  ASSERT_EQ(ended.status, 0) << ended.err;
  const size_t trace = ended.out.find("\niteration,");
  const size_t summary = ended.out.find("\nfitted ");
  ASSERT_LT(trace, summary) << ended.out;
  EXPECT_EQ(nlohmann::json::parse(ended.out.substr(0, trace))["format"], "batten.fit/1");
}

TEST_F(FitFiles, HaveNamesWithoutControlCharacters) {
  for (const std::string flag : {"out", "trace", "iterates"}) {
    ExpectRefused(Fit({"--" + flag + "=" + (folder_ / "a\nb")}), {"--" + flag + ": ", "a\\x0ab"});
  }
  ExpectRefused(RunBatten({"compare", "--out=" + (folder_ / "a\tb")}), {"--out: ", "a\\x09b"});
  EXPECT_THAT(folder_.Names(), ElementsAre("points.csv"));
}

TEST_F(FitFiles, AreNotLeftBehindByAFullDisk) {
  ExpectRefused(Fit({"--out=/dev/full"}), {"cannot write /dev/full", "No space left"});
  ExpectRefused(Fit({"--out=" + (folder_ / "fit.json"), "--trace=/dev/full"}), {"No space left"});
  EXPECT_THAT(folder_.Names(), ElementsAre("points.csv"));
}

TEST_F(FitFiles, AreNotLeftBehindWhereTheyMustNotGrow) {
  const std::string old = folder_.Write("trace.csv", "old");
  Program::Streams streams;
  streams.file_size = 200;
  const std::string out = folder_ / "fit.json";
  ExpectRefused(
      Program({"fit", points_, "--control_points=5", "--out=" + out, "--trace=" + old}, streams)
          .Wait(),
      {"cannot write " + out, "File too large"});
  EXPECT_THAT(folder_.Names(), ElementsAre("points.csv", "trace.csv"));
  EXPECT_EQ(ReadFile(old), "old");
}

TEST_F(FitFiles, StayAsTheyWereWhereTheNewOneFails) {
  const std::string old = folder_.Write("fit.json", "old");
  ExpectRefused(Fit({"--out=" + old, "--trace=/dev/full"}), {"No space left"});
  EXPECT_EQ(ReadFile(old), "old");
}

TEST(StandardOutput, ThatIsFullIsAnError) {
  Program::Streams streams;
  streams.output_file = open("/dev/full", O_WRONLY);
  const Ended ended = Program({"help"}, streams).Wait();
  close(streams.output_file);
  EXPECT_EQ(ended.status, 2);
  EXPECT_EQ(ended.err, "cannot write standard output: No space left on device\n");
}

TEST(StandardOutput, WhoseReaderHasGoneIsNone) {
  int ends[2];
  ASSERT_EQ(pipe2(ends, O_CLOEXEC), 0);
  close(ends[0]);
  Program::Streams streams;
  streams.output_file = ends[1];
  const Ended ended = Program({"list"}, streams).Wait();
  close(ends[1]);
  EXPECT_EQ(ended.status, 0);
  EXPECT_EQ(ended.signal, 0);
  EXPECT_EQ(ended.err, "");
}

class Interrupted : public ::testing::TestWithParam<int> {
 protected:
  Interrupted() { std::filesystem::copy_file(DataFile("coasts/great_britain_10m.csv"), points_); }
  std::vector<std::string> Arguments() const {
    std::vector<std::string> arguments = LongFit(points_);
    arguments.push_back("--out=" + (folder_ / "fit.json"));
    arguments.push_back("--trace=" + (folder_ / "trace.csv"));
    return arguments;
  }

  TemporaryFolder folder_;
  std::string points_ = folder_ / "points.csv";
};

TEST_P(Interrupted, FitLeavesNothingHalfWritten) {
  Program program(Arguments());
  program.WaitUntilBusy(1.0);
  program.Send(GetParam());
  const Ended ended = program.Wait();
  EXPECT_EQ(ended.status, 130);
  EXPECT_EQ(ended.err, "interrupted; nothing was written\n");
  EXPECT_EQ(ended.out, "");
  EXPECT_THAT(folder_.Names(), ElementsAre("points.csv"));
}

TEST_P(Interrupted, TwiceEndsAtOnce) {
  Program program(Arguments());
  program.WaitUntilBusy(1.0);
  program.Send(GetParam());
  program.Send(GetParam());
  EXPECT_EQ(program.Wait().status, 130);
  EXPECT_THAT(folder_.Names(), ElementsAre("points.csv"));
}

TEST_P(Interrupted, ReadingOfStandardInputEndsAtOnce) {
  int ends[2];
  ASSERT_EQ(pipe2(ends, O_CLOEXEC), 0);
  Program::Streams streams;
  streams.input_file = ends[0];
  Program program({"fit", "-", "--control_points=5"}, streams);
  // Nothing tells when it waits for input; a signal before its handlers stand kills it, too.
  usleep(500000);
  program.Send(GetParam());
  const Ended ended = program.Wait();
  close(ends[0]);
  close(ends[1]);
  EXPECT_EQ(ended.status, 130);
}

INSTANTIATE_TEST_SUITE_P(Signals, Interrupted, ::testing::Values(SIGINT, SIGTERM, SIGHUP),
                         [](const auto& test) { return std::string(sigabbrev_np(test.param)); });

}  // namespace
}  // namespace batten
