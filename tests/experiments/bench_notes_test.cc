// Solvers that are one method, and runs that failed, in results written down by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/experiments/hand_made_bench.h"

namespace batten {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

struct Stream {
  std::string stop;
  int points = 0;
  std::string hash;
  std::vector<std::string> prefixes;
};

std::vector<std::string> NotesOn(const Stream& first, const Stream& second) {
  HandMadeBench bench({0.1});
  bench.AddInstance("p", 1.0);
  for (const auto& [solver, stream] : {std::pair("one", first), std::pair("other", second)}) {
    nlohmann::json& row = bench.AddRun("p", solver, {{1, 0.1, 9.0}, {9, 0.2, 1.0}});
    row["stop"] = stream.stop;
    row["stream"] = stream.hash;
    row["stream_points"] = stream.points;
    row["stream_prefixes"] = stream.prefixes;
  }
  return bench.Results().notes;
}

const auto kOneMethod = Contains(HasSubstr("one and other evaluate at the same points"));
const Stream kWhole = {"gradient_small", 20, "end", {"a4", "a8", "a16"}};

TEST(Twins, HaveTheSamePointsToTheEnd) {
  EXPECT_THAT(NotesOn(kWhole, kWhole), kOneMethod);
  EXPECT_THAT(NotesOn(kWhole, {"gradient_small", 20, "other end", {"a4", "a8", "a16"}}),
              Not(kOneMethod));
}

TEST(Twins, AreSeenWhereALimitCutsOneOfThem) {
  for (const char* stop : {"time_limit", "iteration_limit"}) {
    EXPECT_THAT(NotesOn(kWhole, {stop, 11, "cut", {"a4", "a8"}}), kOneMethod);
    EXPECT_THAT(NotesOn({stop, 11, "cut", {"a4", "a8"}}, {stop, 30, "c", {"a4", "a8", "a16"}}),
                kOneMethod);
    EXPECT_THAT(NotesOn(kWhole, {stop, 11, "cut", {"a4", "b8"}}), Not(kOneMethod));
    EXPECT_THAT(NotesOn(kWhole, {stop, 3, "cut", {}}), Not(kOneMethod));
  }
}

TEST(Twins, AreNotWhatEndsByItselfBeforeTheOther) {
  EXPECT_THAT(NotesOn({"gradient_small", 9, "end", {"a4", "a8"}},
                      {"time_limit", 30, "cut", {"a4", "a8", "a16"}}),
              Not(kOneMethod));
}

TEST(Notes, NameRunsThatFailedWithTheirReason) {
  for (const char* stop : {"numerical_failure", "diverged", "infeasible"}) {
    HandMadeBench bench({0.1});
    bench.AddInstance("p", 1.0);
    nlohmann::json& row = bench.AddRun("p", "one", {{1, 0.1, 9.0}, {9, 0.2, 1.0}});
    row["stop"] = stop;
    row["message"] = "it went wrong";
    EXPECT_THAT(bench.Results().notes,
                Contains(HasSubstr("one: " + std::string(stop) + ": it went wrong")));
  }
}

}  // namespace
}  // namespace batten
