#include "solvers/chebyshev_lspia.h"

#include <cmath>

namespace batten {

SolverInfo ChebyshevLspiaSolver::ClassInfo() {
  SolverInfo info;
  info.name = "chebyshev_lspia";
  info.summary = "LSPIA with the steps of the Chebyshev iteration (ALSPIA)";
  info.source = "Wu & Liu, CAGD 2024; Golub & Varga, Numer. Math. 3, 1961";
  info.needs = {"compiled rows"};
  info.supports = {"linear constraints", "weights", "any rank (nearest to the start)"};
  info.native_rule = NativeRule::kStep;
  // In the published order, smallest step first, what belongs to large eigenvalues grows again in
  // the last steps of a cycle, and rounding with it: up to 6e3 times for 8 steps, 7e7 for 16.
  info.options = {OptionInfo::Integer("cycle", 8, 1, 1000000,
                                      "number K of steps after which they are repeated")};
  return info;
}

ChebyshevLspiaSolver::ChebyshevLspiaSolver(const OptionValues& options)
    : cycle_(options.Integer("cycle")) {}

double ChebyshevLspiaSolver::ChooseWeights(const NormalSpectrum& spectrum) {
  spectrum_ = spectrum;
  const double l1 = spectrum.largest;
  const double ln = spectrum.smallest;
  // After a cycle the largest error is 1 / T_K((l1 + ln) / (l1 - ln)).
  if (l1 == ln) return 0.0;
  const double s = std::sqrt(ln / l1);
  const double asymptotic = (1.0 - s) / (1.0 + s);
  const double power = std::pow(asymptotic, cycle_);
  return asymptotic * std::pow(2.0 / (1.0 + power * power), 1.0 / cycle_);
}

Status ChebyshevLspiaSolver::Begin(const Eigen::VectorXd& /*x*/) {
  constexpr int kLongCycle = 16;
  if (cycle_ > kLongCycle) {
    WarnOfDivergence("within a cycle of more than " + std::to_string(kLongCycle) +
                     " steps rounding grows to the size of what is left");
  }
  return Status::kOk;
}

Status ChebyshevLspiaSolver::Advance(Eigen::VectorXd* x) {
  const Status status = EvaluateResidual(*x);
  if (status != Status::kOk) return status;
  const double sum = spectrum_.largest + spectrum_.smallest;
  const double difference = spectrum_.largest - spectrum_.smallest;
  const double angle = (2.0 * (iteration() % cycle_) + 1.0) * M_PI / (2.0 * cycle_);
  *x += 2.0 / (sum + difference * std::cos(angle)) * residual();
  return Status::kOk;
}

}  // namespace batten
