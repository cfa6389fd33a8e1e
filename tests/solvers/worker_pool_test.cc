#include "solvers/worker_pool.h"

#include <gtest/gtest.h>

#include <set>
#include <thread>

namespace batten {
namespace {

TEST(WorkerPool, CallsEachNumberOnceInEveryRound) {
  for (const int threads : {1, 2, 5}) {
    WorkerPool pool(threads);
    ASSERT_EQ(pool.num_threads(), threads);
    std::vector<int> calls(static_cast<std::size_t>(threads), 0);
    constexpr int kRounds = 1000;
    for (int round = 0; round < kRounds; ++round) {
      pool.Run([&calls](int k) { ++calls[static_cast<std::size_t>(k)]; });
      for (const int count : calls) ASSERT_EQ(count, round + 1);
    }
  }
}

TEST(WorkerPool, GivesTheCallerNumberZeroAndTheOthersTheirOwnThreads) {
  WorkerPool pool(3);
  std::vector<std::thread::id> ids(3);
  pool.Run([&ids](int k) { ids[static_cast<std::size_t>(k)] = std::this_thread::get_id(); });
  EXPECT_EQ(ids[0], std::this_thread::get_id());
  EXPECT_EQ(std::set<std::thread::id>(ids.begin(), ids.end()).size(), 3U);
  const std::vector<std::thread::id> first = ids;
  pool.Run([&ids](int k) { ids[static_cast<std::size_t>(k)] = std::this_thread::get_id(); });
  EXPECT_EQ(ids, first);
}

TEST(WorkerPool, EndsWithoutWork) { const WorkerPool pool(4); }

}  // namespace
}  // namespace batten
