#ifndef BATTEN_SOLVERS_EXTENDED_PIA_H_
#define BATTEN_SOLVERS_EXTENDED_PIA_H_

#include "solvers/further_terms.h"
#include "solvers/own_limit.h"
#include "solvers/stall_guard.h"
#include "solvers/stepper.h"

namespace batten {

/// Extended PIA: each data point belongs to the control point whose basis function is largest
/// there, which moves by the weighted mean of its group's residuals, less what further terms pull.
/// Its limit is not the least-squares curve. docs/solvers/extended_pia.md.
class ExtendedPiaSolver final : public FixedPoint {
 public:
  static SolverInfo ClassInfo();
  explicit ExtendedPiaSolver(const OptionValues& /*options*/) {}
  SolverInfo Info() const override { return ClassInfo(); }
  std::string WhyUnsupported(const Objective& objective) const override;
  Status Map(const Eigen::VectorXd& x, Eigen::VectorXd* g_of_x) override;
  std::vector<double> State() const override;
  void Restore(const std::vector<double>& state) override;

 private:
  std::optional<Outcome> DoStart(Eigen::VectorXd* x) override;
  std::optional<Outcome> Inspect(const Eigen::VectorXd& x, const Eigen::VectorXd& g_of_x) override;
  void Group();
  double SpectralRadius() const;

  struct Member {
    int control_point = 0;
    double share = 0.0;  // B_j(t_i) over the sum of its group's and, with further terms, of |F_jk|
  };
  const BandedRows& rows() const { return *rows_; }
  std::optional<BandedRows> own_rows_;
  const BandedRows* rows_ = nullptr;  // of the interpolation term: own_rows_, or those of the view
  FurtherTerms terms_;
  std::vector<Member> member_of_row_;
  Eigen::ArrayXd scale_;  // of further terms' pull: 1 over the same sums, 0 where these are
  Points residuals_;
  Points pull_;
  OwnLimit own_limit_;
  StallGuard guard_;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_EXTENDED_PIA_H_
