#ifndef BATTEN_TESTS_TOOLS_BENCH_FIXTURE_H_
#define BATTEN_TESTS_TOOLS_BENCH_FIXTURE_H_

#include <gmock/gmock.h>

#include <map>
#include <set>

#include "tests/tools/program.h"

namespace batten {

inline nlohmann::json GoodSuite() {
  return {{"format", "batten.suite/1"},
          {"name", "good"},
          {"problems",
           {{{"synthetic", "star"}, {"name", "star"}, {"points", 60}, {"control_points", {8, 12}}},
            {{"synthetic", "wave"}, {"name", "wave"}, {"points", 40}, {"control_points", 9}}}},
          {"solvers",
           {"banded_cholesky",
            "cg",
            {{"solver", "lbfgs"}, {"options", {{"memory", {3, 10}}}}},
            "lspia"}},
          {"budgets", {{"seconds", 20}, {"iterations", 200}}},
          {"warm_up", 0},
          {"repetitions", 4}};
}

class Bench : public ::testing::Test {
 protected:
  std::string Suite(const nlohmann::json& suite) const {
    return folder_.Write("suite.json", suite.dump());
  }
  std::vector<std::string> Arguments(const std::string& suite, const std::string& out) const {
    return {"bench", suite, "--out=" + (folder_ / out), "--nofigures", "--quiet"};
  }
  Ended RunIn(const std::string& suite, const std::string& out,
              const std::string& flag = "") const {
    std::vector<std::string> arguments = Arguments(suite, out);
    if (!flag.empty()) arguments.push_back(flag);
    return RunBatten(arguments);
  }
  /// The table without the columns of time, which stand last.
  std::vector<std::string> TimelessTable(const std::string& out) const {
    std::vector<std::string> lines = Lines(ReadFile(folder_ / (out + "/table.csv")));
    constexpr int kTimes = 4;
    EXPECT_THAT(lines.at(0), ::testing::EndsWith(",seconds,seconds_low,seconds_high,work_units"));
    for (std::string& line : lines) {
      for (int k = 0; k < kTimes; ++k) line.resize(line.rfind(','));
    }
    return lines;
  }
  /// Keys of the rows, each of which is whole.
  std::multiset<std::string> Keys(const std::string& out) const {
    std::multiset<std::string> keys;
    for (const std::string& line : Lines(ReadFile(folder_ / (out + "/cells.jsonl")))) {
      keys.insert(nlohmann::json::parse(line)["key"].get<std::string>());
    }
    return keys;
  }

  /// Iterates by run: first repetitions alone have some, whose number the row says.
  std::map<std::string, std::string> Iterates(const std::string& out) const {
    std::map<std::string, std::string> iterates;
    for (const std::string& line : Lines(ReadFile(folder_ / (out + "/cells.jsonl")))) {
      const nlohmann::json row = nlohmann::json::parse(line);
      const std::string key = row["key"].get<std::string>();
      const std::string path = folder_ / (out + "/iterates/" + key + ".jsonl");
      EXPECT_EQ(std::filesystem::exists(path), row["iterate_rows"] > 0);
      if (row["iterate_rows"] == 0) continue;
      iterates[key] = ReadFile(path);
      EXPECT_EQ(Lines(iterates[key]).size(), row["iterate_rows"].get<std::size_t>());
      EXPECT_TRUE(std::filesystem::exists(
          folder_ / (out + "/curves/" + row["instance"].get<std::string>() + ".json")));
    }
    return iterates;
  }

  TemporaryFolder folder_;
};

}  // namespace batten

#endif  // BATTEN_TESTS_TOOLS_BENCH_FIXTURE_H_
