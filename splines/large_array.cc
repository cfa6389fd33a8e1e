#include "splines/large_array.h"

#include <sys/mman.h>

#include <algorithm>
#include <cstdint>
#include <new>

namespace batten {

void* AllocateLarge(std::size_t bytes) {
  bytes = std::max<std::size_t>(bytes, 1);
  void* const data = ::operator new[](bytes, std::align_val_t(kCacheLine));
#ifdef MADV_HUGEPAGE
  constexpr std::size_t kPageSize = 4096;
  constexpr std::size_t kHugePageSize = 2 << 20;
  if (bytes > 2 * kHugePageSize) {
    const std::size_t skipped = -reinterpret_cast<std::uintptr_t>(data) % kPageSize;
    madvise(static_cast<char*>(data) + skipped, bytes - skipped, MADV_HUGEPAGE);
  }
#endif
  return data;
}

void FreeLarge(void* data) noexcept { ::operator delete[](data, std::align_val_t(kCacheLine)); }

}  // namespace batten
