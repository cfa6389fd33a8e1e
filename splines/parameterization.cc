#include "splines/parameterization.h"

#include <cmath>
#include <vector>

#include "splines/processor.h"

namespace batten {
namespace {

constexpr Parameterization kAllRules[] = {
    Parameterization::kUniform, Parameterization::kChordLength, Parameterization::kCentripetal};

/// Lengths of the m - 1 chords (closed: m), in units of a power of two near the largest coordinate
/// difference: squares then cannot overflow, and scaling the points by a power of two changes no
/// bit of the result, also of roots. Empty with a sentence in `error` if there is no length.
std::vector<double> ChordLengths(bool closed, const Points& points, std::string* error) {
  const Eigen::Index m = points.rows();
  if (points.cols() == 0) {
    *error = "the points have no coordinates, chords have no length; use uniform";
    return {};
  }
  for (Eigen::Index i = 0; i < m; ++i) {
    if (!points.row(i).allFinite()) {
      *error = "point " + std::to_string(i) + " is not finite, no chord can be measured to it";
      return {};
    }
  }
  Eigen::RowVectorXd low;
  Eigen::RowVectorXd high;
  FindBoundingBox(points, &low, &high);
  const double extent = (high - low).maxCoeff();
  if (extent == 0.0) {
    *error = "all " + std::to_string(m) + " points are equal, chords have no length; use uniform";
    return {};
  }
  if (!std::isfinite(extent)) {
    *error = "the points are farther apart than a double can hold; scale them down";
    return {};
  }
  const int exponent = std::ilogb(extent);
  std::vector<double> lengths(closed ? m : m - 1);
  for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(lengths.size()); ++i) {
    double sum = 0.0;
    for (Eigen::Index c = 0; c < points.cols(); ++c) {
      const double step = std::scalbn(points((i + 1) % m, c) - points(i, c), -exponent);
      sum += step * step;
    }
    lengths[i] = std::sqrt(sum);
  }
  return lengths;
}

}  // namespace

const char* ToString(Parameterization rule) {
  switch (rule) {
    case Parameterization::kUniform:
      return "uniform";
    case Parameterization::kChordLength:
      return "chord_length";
    case Parameterization::kCentripetal:
      return "centripetal";
  }
  return "unknown";
}

bool FromString(const std::string& text, Parameterization* rule) {
  for (const Parameterization known : kAllRules) {
    if (text == ToString(known)) {
      *rule = known;
      return true;
    }
  }
  return false;
}

std::optional<Eigen::VectorXd> Parameterize(Parameterization rule, bool closed,
                                            const Points& points, std::string* error) {
  std::string unread;
  if (error == nullptr) error = &unread;
  const Eigen::Index m = points.rows();
  const bool uniform = rule == Parameterization::kUniform;
  const int fewest = closed && uniform ? 1 : 2;
  if (m < fewest) {
    *error = "there are " + std::to_string(m) + " points, " + ToString(rule) +
             " parameters need at least " + std::to_string(fewest);
    return std::nullopt;
  }
  Eigen::VectorXd parameters(m);
  if (uniform) {
    const double num_steps = static_cast<double>(closed ? m : m - 1);
    for (Eigen::Index i = 0; i < m; ++i) parameters[i] = static_cast<double>(i) / num_steps;
    return parameters;
  }
  const std::vector<double> steps = ChordLengths(closed, points, error);
  if (steps.empty()) return std::nullopt;
  // Summed in long double: a million plain additions would cost up to six digits.
  std::vector<long double> sums(steps.size() + 1, 0.0L);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    sums[i + 1] =
        sums[i] + (rule == Parameterization::kCentripetal ? std::sqrt(steps[i]) : steps[i]);
  }
  for (Eigen::Index i = 0; i < m; ++i) {
    parameters[i] = static_cast<double>(sums[i] / sums.back());
  }
  return parameters;
}

namespace {

// Without a way out of the inner loop, so that the compiler compares in packs.
inline __attribute__((always_inline)) bool IsNondecreasingInBlocks(const double* values,
                                                                   std::ptrdiff_t size) {
  constexpr std::ptrdiff_t kBlock = 256;
  for (std::ptrdiff_t begin = 0; begin + 1 < size; begin += kBlock) {
    const std::ptrdiff_t end = std::min(begin + kBlock, size - 1);
    long in_order = 0;
    for (std::ptrdiff_t i = begin; i < end; ++i) in_order += values[i] <= values[i + 1] ? 1 : 0;
    if (in_order != end - begin) return false;
  }
  return size != 1 || !std::isnan(values[0]);
}

#if BATTEN_HAS_AVX2_KERNELS
__attribute__((target("avx2"))) bool IsNondecreasingWithAvx2(const double* values,
                                                             std::ptrdiff_t size) {
  return IsNondecreasingInBlocks(values, size);
}
#endif

}  // namespace

bool IsNondecreasing(const double* values, std::ptrdiff_t size) {
#if BATTEN_HAS_AVX2_KERNELS
  if (HasAvx2()) return IsNondecreasingWithAvx2(values, size);
#endif
  return IsNondecreasingInBlocks(values, size);
}

std::ptrdiff_t FirstNotBelow(const double* values, std::ptrdiff_t from, std::ptrdiff_t size,
                             double bound, std::ptrdiff_t guess) {
  if (from >= size) return size;
  std::ptrdiff_t at = std::min(guess, size - 1);
  std::ptrdiff_t step = 1;
  if (values[at] < bound) {
    while (at + step < size && values[at + step] < bound) {
      at += step;
      step *= 2;
    }
    return std::lower_bound(values + at + 1, values + std::min(at + step, size), bound) - values;
  }
  while (at - step >= from && !(values[at - step] < bound)) {
    at -= step;
    step *= 2;
  }
  return std::lower_bound(values + std::max(at - step + 1, from), values + at, bound) - values;
}

}  // namespace batten
