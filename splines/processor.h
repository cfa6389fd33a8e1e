#ifndef BATTEN_SPLINES_PROCESSOR_H_
#define BATTEN_SPLINES_PROCESSOR_H_

/// Whether kernels are compiled for AVX2 beside those for any processor: GCC alone inlines generic
/// code into a function for one processor as we ask it to.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define BATTEN_HAS_AVX2_KERNELS 1
#else
#define BATTEN_HAS_AVX2_KERNELS 0
#endif

namespace batten {

/// Whether the processor at hand has AVX2 and FMA, and kernels for it are compiled.
inline bool HasAvx2() {
#if BATTEN_HAS_AVX2_KERNELS
  static const bool has = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return has;
#else
  return false;
#endif
}

}  // namespace batten

#endif  // BATTEN_SPLINES_PROCESSOR_H_
