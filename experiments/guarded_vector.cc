#include "experiments/guarded_vector.h"

#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstring>
#include <utility>
#include <vector>

namespace batten {
namespace {

/// Between the end of such a vector and that of its pages.
constexpr std::size_t kBehind = sizeof(double);

char* EndOf(const Eigen::VectorXd& vector) {
  return reinterpret_cast<char*>(const_cast<double*>(vector.data() + vector.size())) + kBehind;
}

void* MapForbiddenPage(std::size_t page) {
  void* const place = mmap(nullptr, page, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  return place == MAP_FAILED ? nullptr : place;
}

}  // namespace

GuardedVector::GuardedVector(const Eigen::VectorXd& values) {
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  mallopt(M_MMAP_THRESHOLD, 1);  // every block gets pages of its own
  // New pages lie below the ones mapped last, unless there is a gap that they fit in: which is
  // filled in the end.
  constexpr int kMostAttempts = 10000;
  std::vector<Eigen::VectorXd> misses;
  std::vector<void*> unused;
  for (int attempt = 0; attempt < kMostAttempts && guard_ == nullptr; ++attempt) {
    void* const forbidden = MapForbiddenPage(page);
    if (forbidden == nullptr) break;
    Eigen::VectorXd candidate = values;
    if (EndOf(candidate) == forbidden) {
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

void GuardedVector::SetNumberBehind(double value) {
  if (works()) std::memcpy(static_cast<char*>(guard_) - kBehind, &value, kBehind);
}

}  // namespace batten
