#include "problems/robust_start.h"

#include <algorithm>
#include <cmath>

#include "cost_functions/foot_feet.h"
#include "cost_functions/term.h"
#include "problems/fit_guard.h"
#include "problems/huber_fit.h"

namespace batten {
namespace {

bool IsConvex(const std::string& loss) { return loss != "cauchy" && loss != "tukey"; }

bool IsFair(const std::vector<NameSpec>& terms) {
  return std::any_of(terms.begin(), terms.end(),
                     [](const NameSpec& spec) { return spec.name == "fairing"; });
}

bool Freeze(const HuberFit& fit, const Eigen::VectorXd& x, const FitSetting& setting,
            bool may_guard, std::vector<NameSpec>* terms, std::string* error) {
  constexpr double kLeast = 1e-6;  // least that loss_scale may be
  double guard = 0.0;
  for (std::size_t i = 0; i < terms->size(); ++i) {
    const HuberTerm& term = fit.terms()[i];
    if (!term.estimated) continue;
    const double sigma = fit.Sigma(term, x) / setting.size;
    const double scale = TuningConstant(term.loss) * sigma;
    if (!(scale >= kLeast)) {
      *error = "term " + (*terms)[i].ToString() + ": the median residual is " + NumberText(sigma) +
               " of the data's size, too small for a scale; give a number "
               "instead of mad";
      return false;
    }
    for (auto& [option, value] : (*terms)[i].options) {
      if (option == kLossScale) value = NumberText(scale);
    }
    if (term.moves) guard += term.family->weight() * setting.data->size * sigma * sigma;
  }
  if (may_guard && guard > 0.0 && !IsFair(*terms)) terms->push_back(LengthGuard(guard));
  return true;
}

/// The data at parameters that move to the feet on a curve.
class MovingSites {
 public:
  explicit MovingSites(const FitSetting& asked)
      : asked_(asked),
        sites_(*asked.data),
        parameters_(Eigen::Map<const Eigen::VectorXd>(sites_.parameters, sites_.size)) {
    setting_ = asked;
    setting_.data = &sites_;
    setting_.parameter_offset = -1;
    setting_.keep_order = setting_.ends_held = false;
  }
  MovingSites(const MovingSites&) = delete;
  MovingSites& operator=(const MovingSites&) = delete;

  const FitSetting& setting() const { return setting_; }  ///< With the parameters fixed.

  /// Those that are held stay.
  void MoveToFeet(const Eigen::VectorXd& control_points) {
    const int m = sites_.size, d = setting_.dimension;
    Points points = Eigen::Map<const Points>(sites_.points, m, d);
    for (int c = 0; c < d; ++c) {
      points.col(c) = (points.col(c).array() - setting_.center[c]) * setting_.scale;
    }
    Eigen::VectorXd all(control_points.size() + m);
    all << control_points, parameters_;
    FindFeet(*setting_.basis, d, setting_.control_point_offset, points, &all);
    for (int i = 0; i < m; ++i) {
      if (asked_.ends_held && (i == 0 || i == m - 1)) continue;
      parameters_[i] = setting_.basis->Wrap(all[control_points.size() + i]);
    }
    sites_.parameters = parameters_.data();
    sites_.order.clear();
    sites_.groups.clear();
    GroupBySpan(*setting_.basis, false, &sites_);
  }

  /// All variables of the problem.
  Eigen::VectorXd WithParameters(const Eigen::VectorXd& control_points) const {
    if (asked_.parameter_offset < 0) return control_points;
    Eigen::VectorXd all(control_points.size() + parameters_.size());
    all << control_points, parameters_;
    return all;
  }

 private:
  const FitSetting& asked_;
  FitSetting setting_;
  Sites sites_;
  Eigen::VectorXd parameters_;
};

/// The problem's control points alone, under what constrains them.
std::unique_ptr<Problem> OnControlPoints(const Problem& problem,
                                         const std::vector<LinearConstraint>& constraints,
                                         const FitSetting& setting, std::string* error) {
  const auto size =
      static_cast<Eigen::Index>(setting.basis->num_control_points()) * setting.dimension;
  auto made = std::make_unique<Problem>(problem.name());
  made->AddVariables("control_points", problem.start().head(size));
  std::vector<LinearConstraint> kept;
  for (const LinearConstraint& constraint : constraints) {
    const bool is_on_points =
        std::all_of(constraint.coefficients.begin(), constraint.coefficients.end(),
                    [size](const auto& entry) { return entry.first < size; });
    if (is_on_points) kept.push_back(constraint);
  }
  return made->SetLinearConstraints(kept, error) ? std::move(made) : nullptr;
}

bool HaveParametersOfTheirOwn(const std::vector<NameSpec>& terms) {
  return std::any_of(terms.begin(), terms.end(), [](const NameSpec& spec) {
    const Term* term = TermRegistry::Global().Find(spec.name);
    return term != nullptr && (term->Info().free_parameters || term->Info().foot_points);
  });
}

}  // namespace

bool AsksForRobustStart(const std::vector<NameSpec>& terms) {
  return std::any_of(terms.begin(), terms.end(), [](const NameSpec& spec) {
    return OptionText(spec, kLossScale) == kEstimatedScale || !IsConvex(OptionText(spec, "loss"));
  });
}

bool StartRobustly(const Problem& problem, const std::vector<LinearConstraint>& constraints,
                   const FitSetting& setting, bool may_guard, std::vector<NameSpec>* terms,
                   std::optional<Eigen::VectorXd>* start, std::string* error) {
  const auto is_estimated = [](const NameSpec& spec) {
    return OptionText(spec, kLossScale) == kEstimatedScale;
  };
  const auto estimated = std::find_if(terms->begin(), terms->end(), is_estimated);
  MovingSites sites(setting);
  const std::unique_ptr<Problem> fixed = OnControlPoints(problem, constraints, setting, error);
  if (fixed == nullptr) return false;
  Eigen::VectorXd x = fixed->start();
  const bool moves = HaveParametersOfTheirOwn(*terms);
  // A curve nears its points' feet to the digits that a scale needs within some rounds.
  constexpr int kMostRounds = 20;
  constexpr double kSettled = 1e-3;
  bool settled = false;
  for (int round = 0;; ++round) {
    HuberFit fit(*fixed, sites.setting());
    std::string why;
    const bool made = std::all_of(terms->begin(), terms->end(),
                                  [&](const NameSpec& spec) { return fit.AddTerm(spec, &why); });
    const bool is_last = made && moves && (settled || round == kMostRounds);
    if (is_last) {
      *start = sites.WithParameters(x);
      return Freeze(fit, x, setting, may_guard, terms, error);
    }
    const Eigen::VectorXd before = x;
    if (!made || !fit.Solve(round == 0, &x)) {
      start->reset();
      if (estimated == terms->end()) return true;
      *error = "term " + estimated->ToString() +
               ": mad needs terms that are compiled rows, and points that determine the curve; "
               "give a number instead";
      return false;
    }
    if (!moves) {
      *start = x;
      return Freeze(fit, x, setting, may_guard, terms, error);
    }
    settled = round > 0 && (x - before).cwiseAbs().maxCoeff() <= kSettled * setting.size;
    sites.MoveToFeet(x);
  }
}

}  // namespace batten
