#include "solvers/plugin.h"

// x -= a g, with a the step that would have minimised E along the last g.
class BarzilaiBorwein final : public batten::SimpleStepper<BarzilaiBorwein> {
 public:
  static constexpr char kName[] = "barzilai_borwein";
  static constexpr char kSummary[] = "gradient steps of the length that was best one step ago";
  static constexpr char kSource[] = "Barzilai & Borwein, IMA J. Numer. Anal. 8, 1988";
  using SimpleStepper::SimpleStepper;
  std::string WhyUnsupported(const batten::Objective& objective) const override {
    return batten::WhyNoUnboundedCurveView(objective, kName);
  }

 private:
  std::optional<batten::Outcome> DoStep(Eigen::VectorXd* x) override {
    batten::Status status = objective()->Gradient(*x, &gradient_);
    if (status == batten::Status::kOk) status = objective()->HessianTimes(*x, gradient_, &product_);
    if (status != batten::Status::kOk) return Ended(status);
    if (gradient_.isZero(0.0)) return batten::Outcome{batten::StopReason::kSolved, "g is 0"};
    const double best = gradient_.squaredNorm() / gradient_.dot(product_);
    *x -= (step_ > 0.0 ? step_ : best) * gradient_;
    step_ = best;
    return std::nullopt;
  }
  Eigen::VectorXd gradient_, product_;
  double step_ = 0.0;
};
BATTEN_PLUGIN(registry) { registry->AddSolver<BarzilaiBorwein>(); }
