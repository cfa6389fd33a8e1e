#ifndef BATTEN_SOLVERS_PAIRED_ITERATION_H_
#define BATTEN_SOLVERS_PAIRED_ITERATION_H_

#include <functional>
#include <string>
#include <vector>

#include "solvers/further_terms.h"
#include "solvers/own_limit.h"
#include "solvers/paired_rows.h"
#include "solvers/stall_guard.h"
#include "solvers/stepper.h"
#include "splines/bspline_basis.h"

namespace batten {

/// Geometric iterations that move control points by residuals paired with them, as many as points:
/// P += M D (Q + f - (B + F) P), B the square collocation matrix and Q the data, their rows in the
/// order of the pairs, F and f of FurtherTerms, D diagonal, D_jj = 1 / (1 + sum_k |F_jk|), so that
/// no row sum of |D (B + F)| is above 1. Without further terms F and f are 0 and D is 1: P_j moves
/// by Q - C at the parameter paired with j. A below is D (B + F).
class PairedIteration : public FixedPoint {
 public:
  std::string WhyUnsupported(const Objective& objective) const override;
  Status Map(const Eigen::VectorXd& x, Eigen::VectorXd* g_of_x) final;
  std::vector<double> State() const override;
  void Restore(const std::vector<double>& state) override;

 protected:
  using SparseRowMajor = Eigen::SparseMatrix<double, Eigen::RowMajor>;

  /// Set-up on the clock, after pairing; may note what it found.
  virtual std::optional<Outcome> Prepare() { return std::nullopt; }
  /// R = D (Q + f - (B + F) P), n x d, becomes the moves M R.
  virtual void TurnIntoMoves(Points* residuals) const = 0;
  /// What of TurnIntoMoves is linear, for the spectral radius of I - M A.
  virtual void TurnIntoMovesLinearly(Points* residuals) const { TurnIntoMoves(residuals); }
  /// How the note of the spectral radius names the iteration matrix.
  virtual std::string MatrixName() const = 0;

  std::optional<Outcome> Inspect(const Eigen::VectorXd& x, const Eigen::VectorXd& g_of_x) override;

  /// A.
  SparseRowMajor Matrix() const;
  bool has_further_terms() const { return !terms_.empty(); }

 private:
  std::optional<Outcome> DoStart(Eigen::VectorXd* x) final;
  double SpectralRadius() const;

  PairedRows rows_;  // B, Q
  FurtherTerms terms_;
  Eigen::ArrayXd scale_;  // diagonal of D; none without further terms
  Points moves_;
  Points pull_;
  OwnLimit own_limit_;  // of those with further terms
  StallGuard guard_;
};

/// Pairs data points with control points: in the order of the parameters, and of the Greville
/// abscissae; on closed curves with the rotation that brings them closest. result[row] = j; rows
/// are numbered in the order of their parameters' spans.
std::vector<int> PairWithControlPoints(const BsplineBasis& basis,
                                       const std::vector<double>& parameters_by_row);

/// SolverInfo::limit of these methods.
inline constexpr char kPairedLimit[] =
    "(Q - B P)_j = (F P - f)_j for every control point j, F and f of the terms beside "
    "interpolation; without these that is the minimum";

/// Parameters in the order of the rows.
std::vector<double> ParametersByRow(const Problem& problem);

/// Growth of v -> matrix v per application: the spectral radius by the eigenvalues of the dense
/// matrix up to 300 points, beyond by a power iteration, whose growth is a lower estimate.
/// `apply` is linear and alike for all coordinates.
double SpectralRadiusOf(const std::function<Points(const Points&)>& apply, int num_points,
                        std::uint64_t seed);

}  // namespace batten

#endif  // BATTEN_SOLVERS_PAIRED_ITERATION_H_
