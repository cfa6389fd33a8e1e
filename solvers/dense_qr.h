#ifndef BATTEN_SOLVERS_DENSE_QR_H_
#define BATTEN_SOLVERS_DENSE_QR_H_

#include "solvers/direct_solver.h"

namespace batten {

/// The normal equations as a full matrix, solved by column-pivoted Householder QR: n^2 numbers and
/// some n^3 operations where the band has n p and n p^2. It is what the fairing papers of Luo and
/// Lan do, here to be compared with. docs/solvers/dense_qr.md.
class DenseQrSolver final : public DirectSolver {
 public:
  static SolverInfo ClassInfo();
  explicit DenseQrSolver(const OptionValues& /*options*/) {}
  SolverInfo Info() const override { return ClassInfo(); }
  std::string WhyUnsupported(const Objective& objective) const override;
  Outcome SolveRows(const CurveView& view, const Problem& problem, RunContext* context,
                    Eigen::VectorXd* x) const override;
  /// Most control points: a full matrix of 0.8 GB.
  static constexpr int kMostPoints = 10'000;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_DENSE_QR_H_
