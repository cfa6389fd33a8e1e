// `regress` as a process, on folders of `bench` of which one is edited.
#include <functional>

#include "tests/tools/bench_fixture.h"

namespace batten {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class Regress : public Bench {
 protected:
  void CopyBeforeToNow() const {
    std::filesystem::copy(folder_ / "before", folder_ / "now",
                          std::filesystem::copy_options::recursive);
  }
  void EditNow(const std::function<void(json&)>& edit) {
    std::string edited;
    for (const std::string& line : Lines(ReadFile(folder_ / "now/cells.jsonl"))) {
      json row = json::parse(line);
      edit(row);
      edited += row.dump() + "\n";
    }
    folder_.Write("now/cells.jsonl", edited);
  }
};

TEST_F(Regress, FindsAWorseResult) {
  const std::string suite = Suite(GoodSuite());
  ASSERT_EQ(RunIn(suite, "before").status, 0);
  CopyBeforeToNow();
  const Ended same = RunBatten({"regress", folder_ / "before", folder_ / "now"});
  EXPECT_EQ(same.status, 0) << same.err;
  EXPECT_THAT(same.out, HasSubstr("15 runs in both"));
  const std::string cells = ReadFile(folder_ / "now/cells.jsonl");
  folder_.Write("now/cells.jsonl", cells + "no row\n");
  EXPECT_THAT(RunBatten({"regress", folder_ / "before", folder_ / "now"}).out,
              HasSubstr("now/cells.jsonl:61: found \"no row\"; allowed: "));
  folder_.Write("now/cells.jsonl", cells);
  EditNow([](json& row) {
    if (row["solver"] == "cg" && row["problem"] == "wave") row["stop"] = "diverged";
  });
  const Ended worse = RunBatten({"regress", folder_ / "before", folder_ / "now"});
  EXPECT_EQ(worse.status, 4);
  EXPECT_THAT(worse.err, HasSubstr("wave | own: cg: gradient_small before, diverged now"));
}

TEST_F(Regress, DoesNotTakeABeliedClaimInAnyRepetition) {
  ASSERT_EQ(RunIn(Suite(GoodSuite()), "before").status, 0);
  CopyBeforeToNow();
  EditNow([](json& row) {
    if (row["solver"] == "cg" && row["problem"] == "wave" && row["repetition"] == 3) {
      row["findings"] = {"claim_fails"};
    }
  });
  EXPECT_EQ(RunBatten({"regress", folder_ / "before", folder_ / "now"}).status, 4);
}

TEST_F(Regress, TestsTimesOfAllCells) {
  const std::string suite = Suite(GoodSuite());
  ASSERT_EQ(RunIn(suite, "before").status, 0);
  CopyBeforeToNow();
  EditNow([](json& row) { row["seconds"] = 1.2 * row["seconds"].get<double>(); });
  const Ended slower = RunBatten({"regress", folder_ / "before", folder_ / "now"});
  EXPECT_EQ(slower.status, 4) << slower.out;
  EXPECT_THAT(slower.err, HasSubstr("all solvers need 1.20 times the seconds"));
  EXPECT_EQ(RunBatten({"regress", folder_ / "before", folder_ / "now", "--slowdown=0.5"}).status,
            0);
}

TEST_F(Regress, RefusesFoldersWithoutResults) {
  ExpectRefused(RunBatten({"regress", folder_ / "a", folder_ / "b"}), {"manifest.json"});
}

}  // namespace
}  // namespace batten
