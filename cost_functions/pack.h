#ifndef BATTEN_COST_FUNCTIONS_PACK_H_
#define BATTEN_COST_FUNCTIONS_PACK_H_

#include <cstddef>

#include "splines/row_block.h"

namespace batten {

typedef double FourDoubles __attribute__((vector_size(32)));

/// kRowPack doubles that are computed with as one, in vectors of kWidth: the scalar in which affine
/// residuals are evaluated for several sites at a time. The same bits for any width.
template <int kWidth>
struct PackOf {
  static constexpr int kLaneSize = kWidth;
  static constexpr int kLanes = kRowPack / kLaneSize;
  typedef double Lane __attribute__((vector_size(kLaneSize * sizeof(double))));

  PackOf() = default;
  explicit PackOf(double value) {
    for (Lane& lane : lanes) lane = value - Lane{};
  }
  // Copied vector by vector: as so many bytes GCC copies it in halves, and what is read whole then
  // waits for them. It also keeps packs out of registers where a call is left, which code for
  // another processor would not read.
  PackOf(const PackOf& other) {
    for (int l = 0; l < kLanes; ++l) lanes[l] = other.lanes[l];
  }
  // NOLINTNEXTLINE(bugprone-unhandled-self-assignment): lanes copied onto themselves stay.
  PackOf& operator=(const PackOf& other) {
    for (int l = 0; l < kLanes; ++l) lanes[l] = other.lanes[l];
    return *this;
  }
  /// Entries that follow each other, at any place.
  static PackOf Load(const double* source) {
    PackOf pack;
    for (int l = 0; l < kLanes; ++l) {
      // Into a vector, which is a register: into the pack's bytes GCC copies it in halves.
      Lane lane;
      __builtin_memcpy(&lane, source + l * kLaneSize, sizeof lane);
      pack.lanes[l] = lane;
    }
    return pack;
  }
  /// Entry i from source[i * step].
  static PackOf Gather(const double* source, std::ptrdiff_t step) {
    PackOf pack;
    if constexpr (kWidth == 4) {
      // Points in the plane: whole vectors are read and put together again.
      if (step == 2) {
        FourDoubles first;
        FourDoubles second;
        __builtin_memcpy(&first, source, sizeof first);
        // Ends with the last entry asked for: what follows it need not be there.
        __builtin_memcpy(&second, source + 3, sizeof second);
        pack.lanes[0] = __builtin_shufflevector(first, second, 0, 2, 5, 7);
        return pack;
      }
    }
    for (int l = 0; l < kLanes; ++l) {
      for (int i = 0; i < kLaneSize; ++i) pack.lanes[l][i] = source[(l * kLaneSize + i) * step];
    }
    return pack;
  }
  /// Entry i from source[items[i] * step].
  static PackOf Gather(const double* source, const std::ptrdiff_t* items, std::ptrdiff_t step) {
    PackOf pack;
    for (int l = 0; l < kLanes; ++l) {
      for (int i = 0; i < kLaneSize; ++i) {
        pack.lanes[l][i] = source[items[l * kLaneSize + i] * step];
      }
    }
    return pack;
  }
  void Store(double* aligned_target) const {
    for (int l = 0; l < kLanes; ++l) reinterpret_cast<Lane*>(aligned_target)[l] = lanes[l];
  }
  /// At any place.
  void StoreAll(double* target) const {
    for (int l = 0; l < kLanes; ++l) {
      const Lane lane = lanes[l];
      __builtin_memcpy(target + l * kLaneSize, &lane, sizeof lane);
    }
  }
  void Set(int i, double value) { lanes[i / kLaneSize][i % kLaneSize] = value; }
  /// Of all entries, in one order for any width.
  double Sum() const {
    double sum = 0.0;
    for (int i = 0; i < kRowPack; ++i) sum += lanes[i / kLaneSize][i % kLaneSize];
    return sum;
  }
  template <typename Function>
  PackOf Map(Function function) const {
    PackOf result;
    for (int l = 0; l < kLanes; ++l) {
      for (int i = 0; i < kLaneSize; ++i) result.lanes[l][i] = function(lanes[l][i]);
    }
    return result;
  }

  friend PackOf operator+(const PackOf& a, const PackOf& b) {
    PackOf result;
    for (int l = 0; l < kLanes; ++l) result.lanes[l] = a.lanes[l] + b.lanes[l];
    return result;
  }
  friend PackOf operator-(const PackOf& a, const PackOf& b) {
    PackOf result;
    for (int l = 0; l < kLanes; ++l) result.lanes[l] = a.lanes[l] - b.lanes[l];
    return result;
  }
  friend PackOf operator*(const PackOf& a, const PackOf& b) {
    PackOf result;
    for (int l = 0; l < kLanes; ++l) result.lanes[l] = a.lanes[l] * b.lanes[l];
    return result;
  }
  friend PackOf operator/(const PackOf& a, const PackOf& b) {
    PackOf result;
    for (int l = 0; l < kLanes; ++l) result.lanes[l] = a.lanes[l] / b.lanes[l];
    return result;
  }
  friend PackOf operator-(const PackOf& a) { return PackOf(0.0) - a; }
  friend PackOf operator+(const PackOf& a, double b) { return a + PackOf(b); }
  friend PackOf operator-(const PackOf& a, double b) { return a - PackOf(b); }
  friend PackOf operator*(const PackOf& a, double b) { return a * PackOf(b); }
  friend PackOf operator/(const PackOf& a, double b) { return a / PackOf(b); }
  friend PackOf operator+(double a, const PackOf& b) { return PackOf(a) + b; }
  friend PackOf operator-(double a, const PackOf& b) { return PackOf(a) - b; }
  friend PackOf operator*(double a, const PackOf& b) { return PackOf(a) * b; }
  friend PackOf operator/(double a, const PackOf& b) { return PackOf(a) / b; }

  /// What a comparison finds, entry by entry.
  struct Mask {
    typedef long long Lane __attribute__((vector_size(kLaneSize * sizeof(double))));
    Lane lanes[kLanes];

    friend Mask operator&(const Mask& a, const Mask& b) {
      Mask result;
      for (int l = 0; l < kLanes; ++l) result.lanes[l] = a.lanes[l] & b.lanes[l];
      return result;
    }
    friend Mask operator|(const Mask& a, const Mask& b) {
      Mask result;
      for (int l = 0; l < kLanes; ++l) result.lanes[l] = a.lanes[l] | b.lanes[l];
      return result;
    }
    friend Mask operator!(const Mask& a) {
      Mask result;
      for (int l = 0; l < kLanes; ++l) result.lanes[l] = ~a.lanes[l];
      return result;
    }
    friend bool Any(const Mask& a) {
      long long any = 0;
      for (int l = 0; l < kLanes; ++l) {
        for (int i = 0; i < kLaneSize; ++i) any |= a.lanes[l][i];
      }
      return any != 0;
    }
  };
  friend Mask operator<(const PackOf& a, const PackOf& b) {
    Mask result;
    for (int l = 0; l < kLanes; ++l) result.lanes[l] = a.lanes[l] < b.lanes[l];
    return result;
  }
  friend Mask operator<=(const PackOf& a, const PackOf& b) {
    Mask result;
    for (int l = 0; l < kLanes; ++l) result.lanes[l] = a.lanes[l] <= b.lanes[l];
    return result;
  }
  /// a where the mask is set, else b.
  friend PackOf Choose(const Mask& mask, const PackOf& a, const PackOf& b) {
    PackOf result;
    for (int l = 0; l < kLanes; ++l) {
      result.lanes[l] = mask.lanes[l] ? a.lanes[l] : b.lanes[l];
    }
    return result;
  }

  Lane lanes[kLanes];
};

/// Of the widest vectors every x86-64 has.
using Pack = PackOf<2>;
/// Of AVX2's, for functions that are compiled for it.
using WidePack = PackOf<4>;

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_PACK_H_
