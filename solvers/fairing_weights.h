#ifndef BATTEN_SOLVERS_FAIRING_WEIGHTS_H_
#define BATTEN_SOLVERS_FAIRING_WEIGHTS_H_

#include <optional>
#include <string>
#include <vector>

#include "problems/objective.h"
#include "splines/normal_band.h"

namespace batten {

/// Fairing-PIA's weights, one per control point (Jiang & Lin, arXiv:2211.11416): the equations
///   sum_l (N_il + (f_i - 1) F_il) P_l = (A'Q)_i,   i = 0..n-1,
/// with F the part of N = A'A that comes from the terms `fairing` and f_i the factor of control
/// point i. In the paper's notation f_i w = w_i / (1 - w_i), w the weight of the term: its rows are
/// ours times 1 - w_i, which its steps divide by. Their solution is no minimum of E unless all f_i
/// are 1.
class FairingWeights {
 public:
  /// Empty, or what stands against weights per control point, as one sentence.
  static std::string WhyNot(const Objective& objective, const std::string& solver_name);
  /// `factors`: f, n of them, 0 or more. `objective` as WhyNot allows.
  FairingWeights(const Objective& objective, const NormalBand& all, std::vector<double> factors);

  /// Sums of the absolute values in each row of the equations' matrix.
  std::vector<double> RowSums() const;
  /// Adds -(f_i - 1) (F P)_i to the rows of A'(Q - A P).
  void AddTo(const Eigen::VectorXd& control_points, Eigen::VectorXd* residual);

 private:
  const NormalBand& all_;
  std::vector<double> factors_;
  NormalBand fairing_;
  Eigen::VectorXd product_;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_FAIRING_WEIGHTS_H_
