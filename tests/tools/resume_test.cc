// `compare --resume` on a cells.jsonl that somebody has edited.
#include <gmock/gmock.h>

#include <functional>

#include "tests/tools/program.h"

namespace batten {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

struct Edit {
  const char* name;
  std::function<void(json*)> make;
};

void PrintTo(const Edit& edit, std::ostream* stream) { *stream << edit.name; }

class ResumedRows : public ::testing::Test {
 protected:
  Ended Compare(const std::string& flag) const {
    return RunBatten({"compare", "--problems=rhino", "--solvers=cg", "--repetitions=1",
                      "--nofigures", "--out=" + out_, flag});
  }
  json Row() const { return json::parse(Lines(ReadFile(cells_)).at(0)); }
  void Write(const json& row) const { std::ofstream(cells_) << row.dump() << "\n"; }
  /// A row that was taken over has this time.
  void WriteMarked(json row) const {
    row["cpu_seconds"] = kMark;
    Write(row);
  }

  static constexpr double kMark = 12345.0;
  TemporaryFolder folder_;
  std::string out_ = folder_ / "out";
  std::string cells_ = out_ + "/cells.jsonl";
};

class EditedRow : public ResumedRows, public ::testing::WithParamInterface<Edit> {};

TEST_P(EditedRow, ThatNoRunWritesIsComputedAgain) {
  ASSERT_EQ(Compare("--quiet").status, 0);
  const json good = Row();
  json row = good;
  row["cpu_seconds"] = kMark;
  GetParam().make(&row);
  Write(row);
  const Ended ended = Compare("--resume");
  EXPECT_EQ(ended.status, 0) << ended.err;
  for (const char* field : {"problem", "solver", "stop", "iterations", "options", "disagreement"}) {
    EXPECT_EQ(Row()[field], good[field]) << field;
  }
  EXPECT_NE(Row()["cpu_seconds"], kMark);
}

INSTANTIATE_TEST_SUITE_P(
    CompareCommand, EditedRow,
    ::testing::Values(
        Edit{"StopWord", [](json* row) { (*row)["stop"] = "foo"; }},
        Edit{"Interrupted", [](json* row) { (*row)["stop"] = "interrupted"; }},
        Edit{"StopNumber", [](json* row) { (*row)["stop"] = 1; }},
        Edit{"Problem", [](json* row) { (*row)["problem"] = "zzz"; }},
        Edit{"ProblemOnTwoLines", [](json* row) { (*row)["problem"] = "rhino\n"; }},
        Edit{"Solver", [](json* row) { (*row)["solver"] = "lbfgs"; }},
        Edit{"HugeCount", [](json* row) { (*row)["iterations"] = 1e300; }},
        Edit{"LargeCount", [](json* row) { (*row)["iterations"] = 3000000000; }},
        Edit{"NegativeCount", [](json* row) { (*row)["products"] = -1; }},
        Edit{"BrokenCount", [](json* row) { (*row)["repetitions"] = 0.5; }},
        Edit{"MoreRepetitionsThanAskedFor", [](json* row) { (*row)["repetitions"] = 2; }},
        Edit{"NoCounts", [](json* row) { (*row)["iterations"] = nullptr; }},
        Edit{"TextForANumber", [](json* row) { (*row)["energy"] = "4"; }},
        Edit{"MissingField", [](json* row) { row->erase("gap"); }},
        Edit{"Options",
             [](json* row) {
               (*row)["options"] = {{"memory", "5"}};
             }},
        Edit{"Notes",
             [](json* row) {
               (*row)["notes"] = {{{"name", 3}, {"value", "x"}}};
             }},
        Edit{"Message", [](json* row) { (*row)["message"] = "two\nlines"; }},
        Edit{"Verdict", [](json* row) { (*row)["verified"] = false; }},
        Edit{"DisagreementThatIsNoSentence", [](json* row) { (*row)["disagreement"] = 3; }},
        Edit{"DisagreementOfAnother", [](json* row) { (*row)["disagreement"] = "cat: cg is"; }},
        Edit{"Format", [](json* row) { (*row)["format"] = "batten.cell/2"; }}),
    [](const auto& edit) { return std::string(edit.param.name); });

TEST_F(ResumedRows, AreTakenOverAsTheyStand) {
  ASSERT_EQ(Compare("--quiet").status, 0);
  WriteMarked(Row());
  ASSERT_EQ(Compare("--resume").status, 0);
  EXPECT_EQ(json::parse(ReadFile(out_ + "/table.json"))["rows"][0]["cpu_seconds"], kMark);
}

TEST_F(ResumedRows, OfFreeParametersKeepTheirBasinAndShape) {
  const std::vector<std::string> command = {
      "compare",         "--problems=rhino_free", "--solvers=newton,gim",
      "--repetitions=1", "--nofigures",           "--out=" + out_};
  ASSERT_EQ(RunBatten(command).status, 0);
  const std::string table = ReadFile(out_ + "/table.csv");
  EXPECT_EQ(Row()["basin"], 1);
  EXPECT_EQ(Row()["parameter_kind"], "free");
  EXPECT_GT(Row()["length"], 0.0);
  std::vector<std::string> again = command;
  again.push_back("--resume");
  ASSERT_EQ(RunBatten(again).status, 0);
  EXPECT_EQ(ReadFile(out_ + "/table.csv"), table);  // times included
}

TEST_F(ResumedRows, WithoutTheirTraceAreComputedAgain) {
  ASSERT_EQ(Compare("--quiet").status, 0);
  const std::string trace = out_ + "/traces/" + Row()["key"].get<std::string>() + ".csv";
  WriteMarked(Row());
  ASSERT_TRUE(std::filesystem::remove(trace));
  ASSERT_EQ(Compare("--resume").status, 0);
  EXPECT_NE(Row()["cpu_seconds"], kMark);
  EXPECT_TRUE(std::filesystem::exists(trace));
}

TEST_F(ResumedRows, ThatFailedTheirAuditGiveStatusThreeAgain) {
  ASSERT_EQ(Compare("--quiet").status, 0);
  json row = Row();
  row["verified"] = false;
  row["failure"] = "claimed E = 4, found 5";
  WriteMarked(row);
  const Ended ended = Compare("--resume");
  EXPECT_EQ(ended.status, 3);
  EXPECT_EQ(ended.err, "audit: rhino: cg claimed E = 4, found 5\n");
  EXPECT_THAT(ended.out, HasSubstr("NOT VERIFIED"));
}

TEST_F(ResumedRows, ThatDisagreeGiveStatusThreeAgain) {
  ASSERT_EQ(Compare("--quiet").status, 0);
  json row = Row();
  row["disagreement"] = "rhino: cg claims a minimum, but is away from the direct answer";
  WriteMarked(row);
  const Ended ended = Compare("--resume");
  EXPECT_EQ(ended.status, 3);
  EXPECT_THAT(ended.err, HasSubstr("solvers disagree: rhino: cg claims a minimum"));
  EXPECT_EQ(Lines(ended.err).size(), 1u);
}

TEST_F(ResumedRows, OfAFileWithoutAnEndAreNotWaitedFor) {
  std::filesystem::create_directory(out_);
  std::filesystem::create_symlink("/dev/zero", cells_);
  EXPECT_EQ(Compare("--resume").status, 0);
}

TEST_F(ResumedRows, WithFewerIteratesThanAskedForAreComputedAgain) {
  const auto compare = [this](const char* most) {
    const Ended ended =
        RunBatten({"compare", "--problems=rhino", "--solvers=cg", "--repetitions=1", "--nofigures",
                   "--out=" + out_, "--resume", std::string("--keep_iterates=") + most});
    EXPECT_EQ(ended.status, 0) << ended.err;
    return Lines(ReadFile(out_ + "/iterates/" + Row()["key"].get<std::string>() + ".jsonl")).size();
  };
  EXPECT_EQ(compare("5"), 5u);
  const std::size_t all = Row()["iterations"].get<std::size_t>() + 1;
  ASSERT_GT(all, 5u);
  EXPECT_EQ(compare("100000"), all);
  WriteMarked(Row());
  EXPECT_EQ(compare("6"), all);
  EXPECT_EQ(Row()["cpu_seconds"], kMark);
}

}  // namespace
}  // namespace batten
