#ifndef BATTEN_SPLINES_ROW_PACK_H_
#define BATTEN_SPLINES_ROW_PACK_H_

#include <cstddef>
#include <type_traits>
#include <vector>

#include "splines/row_block.h"

namespace batten {

/// Two doubles computed with as one: the widest register every x86-64 has. A kRowPack of rows is
/// two of them; loops over 32-byte vectors are lowered through the stack and ran slower.
/// Internal to splines/: may alias the arrays of doubles it is read from.
typedef double RowPack __attribute__((vector_size(16), may_alias));
inline constexpr int kPackLanes = 2;
static_assert(kRowPack % kPackLanes == 0, "strides are whole packs");

inline const RowPack* AsPacks(const double* aligned) {
  return reinterpret_cast<const RowPack*>(aligned);
}
inline RowPack* AsPacks(double* aligned) { return reinterpret_cast<RowPack*>(aligned); }
inline RowPack Broadcast(double value) { return RowPack{value, value}; }
inline double SumOfLanes(RowPack pack) { return pack[0] + pack[1]; }

/// a'b over an even number of packs (any kRowPack has), in two sums: one alone would wait for
/// itself.
inline double DotPacks(const RowPack* a, const RowPack* b, int packs) {
  RowPack even = {};
  RowPack odd = {};
  for (int i = 0; i < packs; i += 2) {
    even += a[i] * b[i];
    odd += a[i + 1] * b[i + 1];
  }
  return SumOfLanes(even + odd);
}

/// Scratch space for a RowBlock's arrays, all zero, aligned as they have to be.
class RowStorage {
 public:
  explicit RowStorage(std::size_t size) : doubles_(size + kRowPack) {}
  double* data() {
    constexpr std::size_t kBytes = kRowPack * sizeof(double);
    const std::size_t address = reinterpret_cast<std::size_t>(doubles_.data());
    return doubles_.data() + (kBytes - address % kBytes) % kBytes / sizeof(double);
  }

 private:
  std::vector<double> doubles_;
};

/// A whole number of packs that holds `num_rows`.
inline int PaddedRows(int num_rows) { return (num_rows + kRowPack - 1) / kRowPack * kRowPack; }

/// Calls kernel(width, dimension) with both as std::integral_constant where loops of fixed length
/// pay, with -1 for both elsewhere: the kernel then takes them from the shape.
template <typename Kernel>
auto WithFixedShape(int width, int dimension, const Kernel& kernel) {
  using std::integral_constant;
  const auto with_width = [&](auto fixed_width) {
    if (dimension == 1) return kernel(fixed_width, integral_constant<int, 1>());
    if (dimension == 2) return kernel(fixed_width, integral_constant<int, 2>());
    if (dimension == 3) return kernel(fixed_width, integral_constant<int, 3>());
    return kernel(integral_constant<int, -1>(), integral_constant<int, -1>());
  };
  if (width == 2) return with_width(integral_constant<int, 2>());
  if (width == 3) return with_width(integral_constant<int, 3>());
  if (width == 4) return with_width(integral_constant<int, 4>());
  if (width == 5) return with_width(integral_constant<int, 5>());
  if (width == 6) return with_width(integral_constant<int, 6>());
  return kernel(integral_constant<int, -1>(), integral_constant<int, -1>());
}

}  // namespace batten

#endif  // BATTEN_SPLINES_ROW_PACK_H_
