#ifndef BATTEN_SOLVERS_NORMAL_SPECTRUM_H_
#define BATTEN_SOLVERS_NORMAL_SPECTRUM_H_

#include <cstdint>

#include "problems/curve_view.h"

namespace batten {

/// Ends of the spectrum of N = A'A, or of another such matrix, to make steps from.
struct NormalSpectrum {
  /// l1, never below the largest eigenvalue: the largest Ritz value and its error where the
  /// recursion settled, else the largest row sum of |N| (Gershgorin).
  double largest = 0.0;
  /// ln, above 0: the smallest Ritz value, which may be above the smallest eigenvalue; without the
  /// null space, where nothing has to converge.
  double smallest = 0.0;
};

/// By Lanczos, to 1e-3, in at most 300 products, counted. All zero if N is.
/// Methods that are given `spectrum` converge for every eigenvalue in (0, largest], those below
/// `smallest` included; only their rate comes from `smallest`.
Status EstimateNormalSpectrum(CurveView* view, std::uint64_t seed, NormalSpectrum* spectrum);

/// The same of any such matrix, uncounted: for what only a report wants.
NormalSpectrum ReportSpectrum(const NormalBand& band, std::uint64_t seed);

/// diag(N)^(-1/2) N diag(N)^(-1/2), which has the eigenvalues of diag(N)^-1 N; rows of control
/// points without data are zero. Its row sums bound them (Gershgorin) by 2 w - 1 entries of at
/// most 1.
NormalBand ScaledToUnitDiagonal(const NormalBand& band);

}  // namespace batten

#endif  // BATTEN_SOLVERS_NORMAL_SPECTRUM_H_
