#ifndef BATTEN_SPLINES_LARGE_ARRAY_H_
#define BATTEN_SPLINES_LARGE_ARRAY_H_

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace batten {

constexpr std::size_t kCacheLine = 64;  // bytes

/// Memory aligned to a cache line, not initialised; throws std::bad_alloc. Large blocks ask for
/// huge pages: the first touch of small ones takes longer than a pass of arithmetic over them.
void* AllocateLarge(std::size_t bytes);
void FreeLarge(void* data) noexcept;

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
  void deallocate(T* data, std::size_t /*n*/) noexcept { FreeLarge(data); }
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

}  // namespace batten

#endif  // BATTEN_SPLINES_LARGE_ARRAY_H_
