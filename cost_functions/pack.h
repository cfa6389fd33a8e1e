#ifndef BATTEN_COST_FUNCTIONS_PACK_H_
#define BATTEN_COST_FUNCTIONS_PACK_H_

#include <cstddef>

#include "splines/row_block.h"

namespace batten {

/// kRowPack doubles that are computed with as one: the scalar in which affine residuals are
/// evaluated for several sites at a time.
struct Pack {
  typedef double Vector __attribute__((vector_size(kRowPack * sizeof(double))));

  Pack() = default;
  explicit Pack(double value) : v(Vector{} + value) {}
  explicit Pack(Vector vector) : v(vector) {}
  /// Lane i from source[i * step].
  static Pack Gather(const double* source, std::ptrdiff_t step) {
    return Pack(Vector{source[0], source[step], source[2 * step], source[3 * step]});
  }
  /// Lane i from source[lanes[i] * step].
  static Pack Gather(const double* source, const std::ptrdiff_t* lanes, std::ptrdiff_t step) {
    return Pack(Vector{source[lanes[0] * step], source[lanes[1] * step], source[lanes[2] * step],
                       source[lanes[3] * step]});
  }
  void Store(double* aligned_target) const { *reinterpret_cast<Vector*>(aligned_target) = v; }

  Vector v;
};

inline Pack operator+(Pack a, Pack b) { return Pack(a.v + b.v); }
inline Pack operator-(Pack a, Pack b) { return Pack(a.v - b.v); }
inline Pack operator*(Pack a, Pack b) { return Pack(a.v * b.v); }
inline Pack operator/(Pack a, Pack b) { return Pack(a.v / b.v); }
inline Pack operator-(Pack a) { return Pack(-a.v); }
inline Pack operator+(Pack a, double b) { return Pack(a.v + b); }
inline Pack operator-(Pack a, double b) { return Pack(a.v - b); }
inline Pack operator*(Pack a, double b) { return Pack(a.v * b); }
inline Pack operator/(Pack a, double b) { return Pack(a.v / b); }
inline Pack operator+(double a, Pack b) { return Pack(a + b.v); }
inline Pack operator-(double a, Pack b) { return Pack(a - b.v); }
inline Pack operator*(double a, Pack b) { return Pack(a * b.v); }

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_PACK_H_
