#ifndef BATTEN_SPLINES_LARGE_ARRAY_H_
#define BATTEN_SPLINES_LARGE_ARRAY_H_

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace batten {

constexpr std::size_t kCacheLine = 64;  // bytes

/// Blocks of at least so many bytes are the system's own pages.
constexpr std::size_t kLargeBytes = 4 << 20;

/// Memory aligned to a cache line, not initialised; throws std::bad_alloc. Large blocks are all
/// zero and ask for huge pages: the first touch of small ones takes longer than a pass of
/// arithmetic over them.
void* AllocateLarge(std::size_t bytes);
/// `bytes` as they were asked for.
void FreeLarge(void* data, std::size_t bytes) noexcept;

/// Allocator over AllocateLarge() whose vectors leave new entries uninitialised unless a value is
/// given: `resize(n)` writes nothing, `assign(n, 0.0)` does.
template <typename T>
class LargeAllocator {
 public:
  using value_type = T;
  LargeAllocator() = default;
  template <typename U>
  LargeAllocator(const LargeAllocator<U>& /*other*/) {}  // NOLINT(google-explicit-constructor)
  T* allocate(std::size_t n) { return static_cast<T*>(AllocateLarge(n * sizeof(T))); }
  void deallocate(T* data, std::size_t n) noexcept { FreeLarge(data, n * sizeof(T)); }
  template <typename U, typename... Args>
  void construct(U* at, Args&&... args) {
    if constexpr (sizeof...(Args) == 0) {
      ::new (static_cast<void*>(at)) U;
    } else {
      ::new (static_cast<void*>(at)) U(std::forward<Args>(args)...);
    }
  }
  friend bool operator==(const LargeAllocator&, const LargeAllocator&) { return true; }
  friend bool operator!=(const LargeAllocator&, const LargeAllocator&) { return false; }
};

using LargeArray = std::vector<double, LargeAllocator<double>>;

/// `size` zeros; what the system has just cleared is not cleared again.
inline LargeArray LargeZeros(std::size_t size) {
  LargeArray zeros(size);
  if (size * sizeof(double) < kLargeBytes) std::fill(zeros.begin(), zeros.end(), 0.0);
  return zeros;
}

}  // namespace batten

#endif  // BATTEN_SPLINES_LARGE_ARRAY_H_
