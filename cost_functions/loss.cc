#include "cost_functions/loss.h"

#include <cmath>

namespace batten {
namespace {

/// rho(s) = b log(1 + s / b), b the squared scale.
class Cauchy final : public ceres::LossFunction {
 public:
  explicit Cauchy(double scale) : b_(scale * scale) {}
  void Evaluate(double s, double rho[3]) const override {
    const double slope = 1.0 / (1.0 + s / b_);
    rho[0] = b_ * std::log1p(s / b_);
    rho[1] = slope;
    rho[2] = -slope * slope / b_;
  }

 private:
  double b_;
};

/// rho(s) = 2 b (sqrt(1 + s / b) - 1).
class SoftL1 final : public ceres::LossFunction {
 public:
  explicit SoftL1(double scale) : b_(scale * scale) {}
  void Evaluate(double s, double rho[3]) const override {
    const double root = std::sqrt(1.0 + s / b_);
    rho[0] = 2.0 * s / (1.0 + root);
    rho[1] = 1.0 / root;
    rho[2] = -0.5 * rho[1] / (b_ * (1.0 + s / b_));
  }

 private:
  double b_;
};

/// rho(s) = b / 3 (1 - (1 - s / b)^3) up to s = b, constant beyond.
class Tukey final : public ceres::LossFunction {
 public:
  explicit Tukey(double scale) : b_(scale * scale) {}
  void Evaluate(double s, double rho[3]) const override {
    if (s > b_) {
      rho[0] = b_ / 3.0;
      rho[1] = rho[2] = 0.0;
      return;
    }
    const double u = s / b_;
    rho[0] = s * (1.0 - u + u * u / 3.0);
    rho[1] = (1.0 - u) * (1.0 - u);
    rho[2] = -2.0 * (1.0 - u) / b_;
  }

 private:
  double b_;
};

}  // namespace

std::shared_ptr<const ceres::LossFunction> MakeLoss(const OptionValues& options, double size) {
  const std::string& loss = options.Word("loss");
  const double scale = options.Real("loss_scale") * size;
  if (loss == "huber") return std::make_shared<ceres::HuberLoss>(scale);
  if (loss == "cauchy") return std::make_shared<Cauchy>(scale);
  if (loss == "tukey") return std::make_shared<Tukey>(scale);
  if (loss == "soft_l1") return std::make_shared<SoftL1>(scale);
  return nullptr;
}

}  // namespace batten
