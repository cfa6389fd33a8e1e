#ifndef BATTEN_PROBLEMS_HUBER_FIT_H_
#define BATTEN_PROBLEMS_HUBER_FIT_H_

#include <memory>
#include <string>
#include <vector>

#include "cost_functions/curve_fairing.h"
#include "cost_functions/fit_setting.h"
#include "cost_functions/options.h"
#include "problems/problem.h"

namespace batten {

inline constexpr char kLossScale[] = "loss_scale";
inline constexpr char kEstimatedScale[] = "mad";

/// Of a loss, for 95% efficiency at normal errors (Holland & Welsch 1977).
double TuningConstant(const std::string& loss);
/// "" where `spec` does not say.
std::string OptionText(const NameSpec& spec, const std::string& name);

/// One term, its loss replaced by Huber's.
struct HuberTerm {
  std::unique_ptr<BlockFamily> family;  ///< Without loss, with rows.
  int coordinates = 0;                  ///< In which residuals are errors.
  bool moves = false;                   ///< Parameters are not fixed.
  std::string loss;                     ///< Empty: none.
  bool estimated = false;               ///< The scale.
  double scale = 0.0;                   ///< Of Huber's loss, in the units of residuals.
  /// Where the term is curve_fairing: itself, without loss, and what `family` stands in with.
  std::unique_ptr<BlockFamily> curved;
  ConstantSpeedFairing stand_in;
};

/// Huber's fit, by reweighted least squares in the band, of a problem's terms at fixed parameters
/// under its linear constraints. Instead of curve_fairing it has the term fairing that is the same
/// on curves whose speed is everywhere the mean of the last step's; without its loss.
class HuberFit {
 public:
  /// Both must outlive this; `problem` has control points alone.
  HuberFit(const Problem& problem, const FitSetting& setting)
      : problem_(problem), setting_(setting) {}

  /// False where a term cannot be formed or is no compiled row.
  bool AddTerm(const NameSpec& spec, std::string* error);
  /// Control points; false where there is no finite answer. `from_nothing`: *x is no fit.
  bool Solve(bool from_nothing, Eigen::VectorXd* x);

  const std::vector<HuberTerm>& terms() const { return terms_; }
  /// Estimated standard deviation of the plain residuals in each coordinate.
  double Sigma(const HuberTerm& term, const Eigen::VectorXd& x) const;

 private:
  bool AddRows(const NameSpec& spec, HuberTerm* made, std::string* error);
  void EstimateScales(const Eigen::VectorXd& x);
  std::vector<double> PlainNorms(const HuberTerm& term, const Eigen::VectorXd& x) const;
  std::vector<double> RootWeights(const HuberTerm& term, bool first,
                                  const Eigen::VectorXd& x) const;
  bool SolveOnce(bool first, Eigen::VectorXd* x) const;

  const Problem& problem_;
  const FitSetting& setting_;
  std::vector<HuberTerm> terms_;
};

}  // namespace batten

#endif  // BATTEN_PROBLEMS_HUBER_FIT_H_
