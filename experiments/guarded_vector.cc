#include "experiments/guarded_vector.h"

#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <utility>
#include <vector>

namespace batten {
namespace {

/// Of the pages in which the vector lies, which are its own. The allocator wants a number more.
char* EndOf(const Eigen::VectorXd& vector, std::size_t page) {
  char* const end = reinterpret_cast<char*>(const_cast<double*>(vector.data() + vector.size() + 1));
  return end + (page - reinterpret_cast<std::uintptr_t>(end) % page) % page;
}

/// Takes all memory that the allocator has at hand for blocks of this size, until it goes away:
/// what is asked for meanwhile gets pages of its own.
class MemoryAtHand {
 public:
  MemoryAtHand(std::size_t bytes, std::size_t page) {
    constexpr std::size_t kLargest = std::size_t{1} << 20;
    constexpr std::size_t kMost = std::size_t{1} << 26;
    std::size_t taken = 0;
    for (std::size_t size = kLargest; size > bytes; size /= 2) Take(size, page, kMost, &taken);
    Take(std::max(bytes, sizeof(Block)), page, kMost, &taken);
  }
  ~MemoryAtHand() {
    while (last_ != nullptr) std::free(std::exchange(last_, last_->before));
  }
  MemoryAtHand(const MemoryAtHand&) = delete;
  MemoryAtHand& operator=(const MemoryAtHand&) = delete;

 private:
  struct Block {
    Block* before;
  };

  /// Until blocks come with pages of their own, behind the allocator's header.
  void Take(std::size_t size, std::size_t page, std::size_t most, std::size_t* taken) {
    constexpr std::size_t kHeader = 16;
    constexpr int kInARow = 2;  // one may stand so by chance
    for (int own = 0; own < kInARow && *taken < most; *taken += size) {
      auto* const block = static_cast<Block*>(std::malloc(size));
      if (block == nullptr) return;
      block->before = std::exchange(last_, block);
      own = reinterpret_cast<std::uintptr_t>(block) % page == kHeader ? own + 1 : 0;
    }
  }

  Block* last_ = nullptr;
};

void* MapForbiddenPage(std::size_t page) {
  void* const place = mmap(nullptr, page, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  return place == MAP_FAILED ? nullptr : place;
}

}  // namespace

GuardedVector::GuardedVector(const Eigen::VectorXd& values) {
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  mallopt(M_MMAP_THRESHOLD, 1);  // every block gets pages of its own
  const MemoryAtHand at_hand(static_cast<std::size_t>(values.size()) * sizeof(double), page);
  // New pages lie below the ones mapped last, unless there is a gap that they fit in: which is
  // filled in the end.
  constexpr int kMostAttempts = 10000;
  std::vector<Eigen::VectorXd> misses;
  std::vector<void*> unused;
  for (int attempt = 0; attempt < kMostAttempts && guard_ == nullptr; ++attempt) {
    void* const forbidden = MapForbiddenPage(page);
    if (forbidden == nullptr) break;
    Eigen::VectorXd candidate = values;
    if (EndOf(candidate, page) == forbidden) {
      vector_ = std::move(candidate);
      guard_ = forbidden;
    } else {
      misses.push_back(std::move(candidate));
      unused.push_back(forbidden);
    }
  }
  for (void* const place : unused) munmap(place, page);
  if (guard_ == nullptr) vector_ = values;
}

GuardedVector::~GuardedVector() {
  if (guard_ != nullptr) munmap(guard_, static_cast<std::size_t>(sysconf(_SC_PAGESIZE)));
}

void GuardedVector::SetNumbersBehind(double value) {
  if (!works()) return;
  char* const end = static_cast<char*>(guard_);
  for (char* place = reinterpret_cast<char*>(vector_.data() + vector_.size()); place < end;
       place += sizeof(value)) {
    std::memcpy(place, &value, sizeof(value));
  }
}

}  // namespace batten
