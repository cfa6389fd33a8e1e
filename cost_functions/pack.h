#ifndef BATTEN_COST_FUNCTIONS_PACK_H_
#define BATTEN_COST_FUNCTIONS_PACK_H_

#include <cstddef>

#include "splines/row_block.h"

namespace batten {

/// kRowPack doubles that are computed with as one: the scalar in which affine residuals are
/// evaluated for several sites at a time. Made of the widest vectors every x86-64 has; with wider
/// ones, where the processor has them, putting them together costs twice what they save.
struct Pack {
  static constexpr int kLaneSize = 2;
  static constexpr int kLanes = kRowPack / kLaneSize;
  typedef double Lane __attribute__((vector_size(kLaneSize * sizeof(double))));

  Pack() = default;
  explicit Pack(double value) {
    for (Lane& lane : lanes) lane = value - Lane{};
  }
  /// Entry i from source[i * step].
  static Pack Gather(const double* source, std::ptrdiff_t step) {
    Pack pack;
    for (int l = 0; l < kLanes; ++l) {
      for (int i = 0; i < kLaneSize; ++i) pack.lanes[l][i] = source[(l * kLaneSize + i) * step];
    }
    return pack;
  }
  /// Entry i from source[items[i] * step].
  static Pack Gather(const double* source, const std::ptrdiff_t* items, std::ptrdiff_t step) {
    Pack pack;
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
  template <typename Function>
  Pack Map(Function function) const {
    Pack result;
    for (int l = 0; l < kLanes; ++l) {
      for (int i = 0; i < kLaneSize; ++i) result.lanes[l][i] = function(lanes[l][i]);
    }
    return result;
  }

  template <typename Operation>
  static Pack Combine(const Pack& a, const Pack& b, Operation operation) {
    Pack result;
    for (int l = 0; l < kLanes; ++l) result.lanes[l] = operation(a.lanes[l], b.lanes[l]);
    return result;
  }

  Lane lanes[kLanes];
};

inline Pack operator+(const Pack& a, const Pack& b) {
  return Pack::Combine(a, b, [](Pack::Lane x, Pack::Lane y) { return x + y; });
}
inline Pack operator-(const Pack& a, const Pack& b) {
  return Pack::Combine(a, b, [](Pack::Lane x, Pack::Lane y) { return x - y; });
}
inline Pack operator*(const Pack& a, const Pack& b) {
  return Pack::Combine(a, b, [](Pack::Lane x, Pack::Lane y) { return x * y; });
}
inline Pack operator/(const Pack& a, const Pack& b) {
  return Pack::Combine(a, b, [](Pack::Lane x, Pack::Lane y) { return x / y; });
}
inline Pack operator-(const Pack& a) { return Pack(0.0) - a; }
inline Pack operator+(const Pack& a, double b) { return a + Pack(b); }
inline Pack operator-(const Pack& a, double b) { return a - Pack(b); }
inline Pack operator*(const Pack& a, double b) { return a * Pack(b); }
inline Pack operator/(const Pack& a, double b) { return a / Pack(b); }
inline Pack operator+(double a, const Pack& b) { return Pack(a) + b; }
inline Pack operator-(double a, const Pack& b) { return Pack(a) - b; }
inline Pack operator*(double a, const Pack& b) { return Pack(a) * b; }

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_PACK_H_
