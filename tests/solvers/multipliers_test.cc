#include "solvers/multipliers.h"

#include <ceres/autodiff_cost_function.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "cost_functions/cost_function_family.h"

namespace batten {
namespace {

constexpr double kNormal[] = {0.6, -1.1, 2.3};
constexpr double kPlace = 0.7;
constexpr double kCentre[] = {1.5, 0.4, -0.9};

/// scale (n . x - b) + shift, where it is negative only if it `clips`.
struct PlaneResidual {
  template <typename T>
  bool operator()(const T* x, T* residual) const {
    residual[0] =
        scale * (kNormal[0] * x[0] + kNormal[1] * x[1] + kNormal[2] * x[2] - kPlace) + shift;
    if (clips && residual[0] > T(0.0)) residual[0] = T(0.0);
    return true;
  }
  double scale, shift;
  bool clips;
};

std::unique_ptr<CostFunctionFamily> MakePlane(double weight, double scale, double shift,
                                              bool clips) {
  auto family = std::make_unique<CostFunctionFamily>(weight);
  family->AddBlock(std::make_unique<ceres::AutoDiffCostFunction<PlaneResidual, 1, 3>>(
                       new PlaneResidual{scale, shift, clips}),
                   {0});
  return family;
}

/// n . x = b, or n . x >= b.
class PlaneConstraint final : public ConstraintFamily {
 public:
  explicit PlaneConstraint(bool is_inequality)
      : is_inequality_(is_inequality), plain_(MakePlane(1.0, 1.0, 0.0, false)) {}
  int size() const override { return 1; }
  bool is_inequality(int /*k*/) const override { return is_inequality_; }
  std::string name(int /*k*/) const override { return "plane"; }
  std::unique_ptr<BlockFamily> MakePenalty(double weight, const Eigen::VectorXd& scales,
                                           const Eigen::VectorXd& shifts) const override {
    return MakePlane(weight, scales[0], shifts[0], is_inequality_);
  }
  void Bind(const Eigen::VectorXd& x, int block, std::vector<int>* offsets,
            std::vector<int>* sizes) const override {
    plain_->Bind(x, block, offsets, sizes);
  }
  std::unique_ptr<ceres::CostFunction> MakeCeresCostFunction(const Eigen::VectorXd& x,
                                                             int block) const override {
    return plain_->MakeCeresCostFunction(x, block);
  }

 private:
  bool DoEvaluate(const Eigen::VectorXd& x, int begin, int end, double* energy,
                  Eigen::VectorXd* gradient) const override {
    return plain_->Evaluate(x, begin, end, energy, gradient) == Status::kOk;
  }
  bool DoResiduals(const Eigen::VectorXd& x, Eigen::VectorXd* residuals) const override {
    return plain_->Residuals(x, residuals) == Status::kOk;
  }
  bool DoJacobian(const Eigen::VectorXd& x, int first_row,
                  std::vector<Eigen::Triplet<double>>* entries) const override {
    return plain_->Jacobian(x, first_row, entries) == Status::kOk;
  }
  bool DoAddHessianTimes(const Eigen::VectorXd& x, const Eigen::VectorXd& direction,
                         Eigen::VectorXd* product) const override {
    return plain_->AddHessianTimes(x, direction, product) == Status::kOk;
  }
  bool is_inequality_;
  std::unique_ptr<CostFunctionFamily> plain_;
};

struct CentreResidual {
  template <typename T>
  bool operator()(const T* x, T* residuals) const {
    for (int i = 0; i < 3; ++i) residuals[i] = x[i] - kCentre[i];
    return true;
  }
};

/// |x - a|^2 under n . x = b or n . x >= b.
Problem PlaneProblem(bool is_inequality) {
  Problem problem("plane");
  problem.AddVariables("x", Eigen::Vector3d::Zero());
  auto family = std::make_unique<CostFunctionFamily>();
  family->AddBlock(
      std::make_unique<ceres::AutoDiffCostFunction<CentreResidual, 3, 3>>(new CentreResidual), {0});
  problem.AddTerm("centre", std::move(family));
  problem.SetNonlinearConstraints(std::make_shared<PlaneConstraint>(is_inequality));
  return problem;
}

/// The minimum of the augmented Lagrangian, a quadratic while the constraint holds, by Newton's
/// steps: the second mends what the differences behind Hessian products leave of the first.
Eigen::VectorXd Minimum(const Problem& problem, const Multipliers& multipliers) {
  const Problem augmented =
      problem.WithPenalty("plane", multipliers.MakePenalty(*problem.nonlinear_constraints()));
  Objective objective(&augmented, nullptr);
  // From the side where it holds.
  Eigen::Vector3d x = -10.0 * Eigen::Vector3d(kNormal[0], kNormal[1], kNormal[2]);
  for (int step = 0; step < 2; ++step) {
    double energy = 0.0;
    Eigen::VectorXd gradient, column;
    EXPECT_EQ(objective.EnergyAndGradient(x, &energy, &gradient), Status::kOk);
    Eigen::Matrix3d hessian;
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(objective.HessianTimes(x, Eigen::Vector3d::Unit(i), &column), Status::kOk);
      hessian.col(i) = column;
    }
    x -= hessian.ldlt().solve(Eigen::Vector3d(gradient));
  }
  return x;
}

TEST(Multipliers, ComeNearerByOneOverOnePlusTheWeight) {
  // By hand: x* = a - n (n . a - b) / |n|^2, lambda* = 2 (n . a - b) / |n|^2, and each update
  // leaves 1 / (1 + weight) of the error.
  const Eigen::Vector3d n(kNormal[0], kNormal[1], kNormal[2]);
  const Eigen::Vector3d a(kCentre[0], kCentre[1], kCentre[2]);
  const double expected = 2.0 * (n.dot(a) - kPlace) / n.squaredNorm();
  ASSERT_LT(expected, 0.0);
  for (const bool is_inequality : {false, true}) {
    const Problem problem = PlaneProblem(is_inequality);
    for (const double weight : {1.0, 10.0, 100.0}) {
      Objective objective(&problem, nullptr);
      Multipliers multipliers;
      ASSERT_EQ(Multipliers::Make(&objective, Eigen::Vector3d::Zero(), weight, &multipliers),
                Status::kOk);
      double error = std::abs(expected);
      for (int update = 0; update < 3; ++update) {
        const Eigen::VectorXd x = Minimum(problem, multipliers);
        multipliers.Update(*problem.nonlinear_constraints(),
                           Eigen::VectorXd::Constant(1, n.dot(x) - kPlace));
        const double next = std::abs(multipliers.values()[0] - expected);
        // Hessian products of plain cost functions are differences.
        EXPECT_NEAR(next / error, 1.0 / (1.0 + weight), 1e-4 / (1.0 + weight)) << weight << update;
        error = next;
        // A raise leaves the multipliers as they are.
        Multipliers raised = multipliers;
        raised.Raise(10.0);
        EXPECT_NEAR(raised.values()[0], multipliers.values()[0], 1e-12);
        EXPECT_EQ(raised.weight(), 10.0 * weight);
      }
    }
  }
}

}  // namespace
}  // namespace batten
