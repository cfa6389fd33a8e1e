#include "splines/large_array.h"

#include <sys/mman.h>

#include <algorithm>
#include <new>

namespace batten {
namespace {

constexpr std::size_t kHugePageSize = 2 << 20;

/// Whole huge pages: what follows a block's end in its last one would be small pages.
std::size_t MappedBytes(std::size_t bytes) {
  return (bytes + kHugePageSize - 1) / kHugePageSize * kHugePageSize;
}

}  // namespace

void* AllocateLarge(std::size_t bytes) {
  if (bytes < kLargeBytes) {
    return ::operator new[](std::max<std::size_t>(bytes, 1), std::align_val_t(kCacheLine));
  }
  void* const data =
      mmap(nullptr, MappedBytes(bytes), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (data == MAP_FAILED) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
  madvise(data, MappedBytes(bytes), MADV_HUGEPAGE);
#endif
  return data;
}

void FreeLarge(void* data, std::size_t bytes) noexcept {
  if (bytes < kLargeBytes) return ::operator delete[](data, std::align_val_t(kCacheLine));
  munmap(data, MappedBytes(bytes));
}

}  // namespace batten
