#ifndef BATTEN_COST_FUNCTIONS_CURVE_CONDITION_H_
#define BATTEN_COST_FUNCTIONS_CURVE_CONDITION_H_

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "cost_functions/constraint_family.h"
#include "cost_functions/fit_setting.h"

namespace batten {

/// One number h that is to be zero (or not negative) at one parameter t of the curve, which is
/// given or a variable.
struct CurveCondition {
  enum class Kind {
    kDirection,  ///< h = direction . C^(order)(t) - value
    /// h = kappa(t) - value of the plane curve, signed: positive where it turns from the first axis
    /// to the second. In space, where kappa has no sign and a kink at 0,
    /// h = (kappa^2 - value^2) / (2 value). All times `unit`.
    kCurvature
  };
  std::string name;
  Kind kind = Kind::kDirection;
  bool is_inequality = false;   ///< h >= 0 instead of h = 0.
  double t = 0.0;               ///< Where it is given.
  int parameter_variable = -1;  ///< Place of t in x; -1: it is given.
  int order = 0;                ///< 0 to 2.
  double direction[kMaxDimension] = {0.0, 0.0, 0.0, 0.0};
  double value = 0.0;
  double unit = 1.0;
};

/// The residual scale * h + shift at a site; as a penalty of an inequality 0 where it is positive.
struct CurveConditionResidual {
  static constexpr int kDerivatives = 2;
  static constexpr int NumResiduals(int /*dimension*/) { return 1; }

  template <typename SiteType, typename T>
  bool operator()(const SiteType& site, const T* const* control_points, T* residuals) const {
    T h(0.0);
    if (condition->kind == CurveCondition::Kind::kDirection) {
      for (int c = 0; c < site.dimension(); ++c) {
        h += condition->direction[c] * site.Derivative(condition->order, control_points, c);
      }
      h -= T(condition->value);
    } else if (!Curvature(site, control_points, &h)) {
      return false;
    }
    residuals[0] = scale * h + shift;
    if (clips && residuals[0] > T(0.0)) residuals[0] = T(0.0);
    return true;
  }

  const CurveCondition* condition;
  double scale = 1.0;
  double shift = 0.0;
  bool clips = false;

 private:
  /// False where the curve stands still.
  template <typename SiteType, typename T>
  bool Curvature(const SiteType& site, const T* const* control_points, T* h) const {
    using std::sqrt;
    T a[SiteType::kDimensionStorage], b[SiteType::kDimensionStorage];
    T squared_speed(0.0);
    const int d = site.dimension();
    for (int c = 0; c < d; ++c) {
      a[c] = site.Derivative(1, control_points, c);
      b[c] = site.Derivative(2, control_points, c);
      squared_speed += a[c] * a[c];
    }
    if (!(squared_speed > T(0.0))) return false;
    const double value = condition->value;
    if (d == 2) {
      const T bend = a[0] * b[1] - a[1] * b[0];
      *h = condition->unit * (bend / (squared_speed * sqrt(squared_speed)) - T(value));
      return true;
    }
    T squared(0.0);  // kappa^2, by minors: they are smooth, and 0 on straight lines
    for (int i = 0; i < d; ++i) {
      for (int j = i + 1; j < d; ++j) {
        const T bend = (a[i] * b[j] - a[j] * b[i]) / squared_speed;
        squared += bend * bend / squared_speed;
      }
    }
    *h = (0.5 * condition->unit / value) * (squared - T(value * value));
    return true;
  }
};

/// Conditions as the constraints of a fit. Derivatives by control points and parameters are exact
/// (automatic differentiation over the basis functions' own derivatives), second ones too. A t of
/// an open curve that is past an end is held there.
class CurveConditionFamily final : public ConstraintFamily {
 public:
  /// What `setting` points to must outlive the family.
  CurveConditionFamily(const FitSetting& setting, std::vector<CurveCondition> conditions);

  const std::vector<CurveCondition>& conditions() const { return *conditions_; }
  int size() const override { return static_cast<int>(conditions_->size()); }
  bool is_inequality(int k) const override { return condition(k).is_inequality; }
  std::string name(int k) const override { return condition(k).name; }
  std::unique_ptr<BlockFamily> MakePenalty(double weight, const Eigen::VectorXd& scales,
                                           const Eigen::VectorXd& shifts) const override;
  /// Control points of the span, or where t is a variable all of them and t.
  void Bind(const Eigen::VectorXd& x, int block, std::vector<int>* offsets,
            std::vector<int>* sizes) const override;
  std::unique_ptr<ceres::CostFunction> MakeCeresCostFunction(const Eigen::VectorXd& x,
                                                             int block) const override;

 private:
  CurveConditionFamily(const CurveConditionFamily& plain, double weight,
                       const Eigen::VectorXd& scales, const Eigen::VectorXd& shifts);
  const CurveCondition& condition(int k) const {
    return (*conditions_)[static_cast<std::size_t>(k)];
  }
  /// Residual `block` at x and, if they are not null, its derivative by each variable in places[v],
  /// and the second derivative along `direction`. False where it has no value.
  struct Local {
    double residual = 0.0;
    double slope = 0.0;  ///< Along `direction`.
    std::vector<int> places;
    std::vector<double> gradient;
    std::vector<double> product;  ///< Second derivative times `direction`.
  };
  bool EvaluateBlock(const Eigen::VectorXd& x, int block, bool with_gradient,
                     const Eigen::VectorXd* direction, Local* local) const;

  bool DoEvaluate(const Eigen::VectorXd& x, int begin, int end, double* energy,
                  Eigen::VectorXd* gradient) const override;
  bool DoResiduals(const Eigen::VectorXd& x, Eigen::VectorXd* residuals) const override;
  bool DoJacobian(const Eigen::VectorXd& x, int first_row,
                  std::vector<Eigen::Triplet<double>>* entries) const override;
  bool DoAddHessianTimes(const Eigen::VectorXd& x, const Eigen::VectorXd& direction,
                         Eigen::VectorXd* product) const override;

  class Cost;

  FitSetting setting_;
  std::shared_ptr<const std::vector<CurveCondition>> conditions_;
  Eigen::VectorXd scales_;
  Eigen::VectorXd shifts_;
  bool is_penalty_ = false;
};

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_CURVE_CONDITION_H_
