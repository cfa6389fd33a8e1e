#ifndef BATTEN_SPLINES_INVERSE_BAND_H_
#define BATTEN_SPLINES_INVERSE_BAND_H_

#include "splines/banded_qr.h"
#include "splines/normal_band.h"

namespace batten {

/// tr((R'R)^-1 N) for the R of a finished QR and a normal band of the same columns, in time
/// proportional to n width^2: only those entries of the inverse that stand on places of R are
/// computed, from the last row up (Elden, BIT 24, 1984; Hutchinson & de Hoog, Numer. Math. 47,
/// 1985). With N that of the data rows and R that of data and fairing rows it is the trace of the
/// hat matrix, the curve's effective number of control points. Only with qr.full_rank() or rows
/// that are known to have full rank.
double TraceOfInverseTimes(const BandedQr& qr, const NormalBand& normal);

}  // namespace batten

#endif  // BATTEN_SPLINES_INVERSE_BAND_H_
