#ifndef BATTEN_BENCHMARKS_RACE_FUNCTIONS_H_
#define BATTEN_BENCHMARKS_RACE_FUNCTIONS_H_

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "benchmarks/noisy_loop.h"
#include "problems/curve_view.h"

namespace batten {

/// A function that our L-BFGS and libLBFGS both call, through the same virtual call.
class RaceFunction {
 public:
  virtual ~RaceFunction() = default;
  virtual Eigen::VectorXd start() const = 0;
  /// The energy at x; adds its gradient to `gradient`, which comes with zeros.
  virtual double AddGradient(const double* x, double* gradient) = 0;
};

/// E(P) - E(start) of the fit of 1e6 points by 1e4 control points, on its normal band: with r = B -
/// N P half the negative gradient, it is -(P - start)'(r + r(start)), and nothing cancels.
class NormalBandFunction final : public RaceFunction {
 public:
  explicit NormalBandFunction(const Problem& fit)
      : view_(CurveView::Make(fit, nullptr)),
        start_(fit.start()),
        start_residual_(start_.size()),
        residual_(start_.size()) {
    view_->normal_band().NormalResidual(start_.data(), start_residual_.data());
  }

  Eigen::VectorXd start() const override { return start_; }

  double AddGradient(const double* x, double* gradient) override {
    view_->normal_band().NormalResidual(x, residual_.data());
    double energy = 0.0;
    for (Eigen::Index i = 0; i < start_.size(); ++i) {
      energy -= (x[i] - start_[i]) * (residual_[i] + start_residual_[i]);
      gradient[i] -= 2.0 * residual_[i];
    }
    return energy;
  }

 private:
  std::unique_ptr<CurveView> view_;
  Eigen::VectorXd start_;
  Eigen::VectorXd start_residual_;
  Eigen::VectorXd residual_;
};

/// Extended Rosenbrock function, 20,000 variables in pairs (More, Garbow and Hillstrom, TOMS 7,
/// 1981, no. 21). Its pairs do not start alike, or it would be the function of two variables.
class RosenbrockFunction final : public RaceFunction {
 public:
  Eigen::VectorXd start() const override {
    Eigen::VectorXd x(kVariables);
    for (int i = 0; i < kVariables; i += 2) {
      x[i] = -1.2 + 0.5 * Noise(static_cast<std::uint64_t>(i));
      x[i + 1] = 1.0 + 0.5 * Noise(static_cast<std::uint64_t>(i) + 1);
    }
    return x;
  }

  double AddGradient(const double* x, double* gradient) override {
    double energy = 0.0;
    for (int i = 0; i < kVariables; i += 2) {
      const double away = 10.0 * (x[i + 1] - x[i] * x[i]);
      const double left = 1.0 - x[i];
      energy += away * away + left * left;
      gradient[i] -= 40.0 * away * x[i] + 2.0 * left;
      gradient[i + 1] += 20.0 * away;
    }
    return energy;
  }

 private:
  static constexpr int kVariables = 20000;
};

/// A RaceFunction as the one block of a term, so that our solvers can be given it. Only E and its
/// gradient are there.
class RaceFamily final : public BlockFamily {
 public:
  RaceFamily(RaceFunction* function, long* calls)
      : BlockFamily(1.0, nullptr), function_(function), calls_(calls) {}
  int size() const override { return 1; }
  int num_residuals() const override { return 1; }
  void Bind(const Eigen::VectorXd& x, int /*block*/, std::vector<int>* offsets,
            std::vector<int>* sizes) const override {
    offsets->assign(1, 0);
    sizes->assign(1, static_cast<int>(x.size()));
  }
  std::unique_ptr<ceres::CostFunction> MakeCeresCostFunction(const Eigen::VectorXd& /*x*/,
                                                             int /*block*/) const override {
    return nullptr;
  }

 private:
  bool DoEvaluate(const Eigen::VectorXd& x, int /*begin*/, int /*end*/, double* energy,
                  Eigen::VectorXd* gradient) const override {
    if (gradient == nullptr) return false;
    ++*calls_;
    *energy += function_->AddGradient(x.data(), gradient->data());
    return true;
  }
  bool DoResiduals(const Eigen::VectorXd& /*x*/, Eigen::VectorXd* /*residuals*/) const override {
    return false;
  }
  bool DoJacobian(const Eigen::VectorXd& /*x*/, int /*first_row*/,
                  std::vector<Eigen::Triplet<double>>* /*entries*/) const override {
    return false;
  }
  bool DoAddHessianTimes(const Eigen::VectorXd& /*x*/, const Eigen::VectorXd& /*direction*/,
                         Eigen::VectorXd* /*product*/) const override {
    return false;
  }

  RaceFunction* function_;
  long* calls_;
};

inline Problem MakeRaceProblem(RaceFunction* function, long* calls) {
  Problem problem("race");
  problem.AddVariables("x", function->start());
  problem.AddTerm("function", std::make_unique<RaceFamily>(function, calls));
  return problem;
}

}  // namespace batten

#endif  // BATTEN_BENCHMARKS_RACE_FUNCTIONS_H_
