#include "problems/robust_start.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include "cost_functions/foot_feet.h"
#include "cost_functions/term.h"
#include "problems/curve_view.h"
#include "problems/fit_guard.h"
#include "splines/nearest_solution.h"
#include "splines/scaled_rows.h"

namespace batten {
namespace {

constexpr const char* kScaleOption = "loss_scale";
constexpr const char* kEstimated = "mad";
constexpr double kHuberConstant = 1.345;

double TuningConstant(const std::string& loss) {
  if (loss == "cauchy") return 2.385;
  if (loss == "tukey") return 4.685;
  return kHuberConstant;
}

bool IsConvex(const std::string& loss) { return loss != "cauchy" && loss != "tukey"; }

/// Of |e|, e normal with standard deviation 1 in each of d coordinates.
double MedianOfNorm(int dimension) {
  constexpr double kMedians[] = {0.6744897502, 1.1774100226, 1.5381722545, 1.8321346115};
  return kMedians[dimension - 1];
}

std::string OptionText(const NameSpec& spec, const std::string& name) {
  for (const auto& [option, value] : spec.options) {
    if (option == name) return value;
  }
  return "";
}

NameSpec WithoutLoss(NameSpec spec) {
  const auto of_loss = [](const auto& option) {
    return option.first == "loss" || option.first == kScaleOption;
  };
  spec.options.erase(std::remove_if(spec.options.begin(), spec.options.end(), of_loss),
                     spec.options.end());
  return spec;
}

/// One term, its loss replaced by Huber's.
struct HuberTerm {
  std::unique_ptr<BlockFamily> family;  // without loss
  int coordinates = 0;                  // in which residuals are errors
  bool moves = false;                   // parameters are not fixed
  std::string loss;                     // empty: none
  bool estimated = false;               // the scale
  double scale = 0.0;                   // of Huber's loss, in the units of residuals
};

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

class HuberFit {
 public:
  HuberFit(const Problem& problem, const FitSetting& setting)
      : problem_(problem), setting_(setting) {}

  /// False where a term cannot be formed or is no compiled row.
  bool AddTerm(const NameSpec& spec, std::string* error) {
    const Term* term = nullptr;
    OptionValues options;
    HuberTerm made;
    if (!TermRegistry::Global().Resolve(spec, &term, &options, error)) return false;
    if (options.Word("loss") != "none") made.loss = options.Word("loss");
    made.coordinates = setting_.dimension;
    const TermInfo info = term->Info();
    if (info.free_parameters || info.foot_points) {
      // At the feet so far it is this.
      NameSpec at_feet = spec;
      at_feet.name = "interpolation";
      if (!AddTerm(at_feet, error)) return false;
      // In one dimension every point lies on the curve, and the residuals are zero.
      terms_.back().moves = true;
      terms_.back().coordinates = std::max(setting_.dimension - 1, 1);
      return true;
    }
    made.estimated = OptionText(spec, kScaleOption) == kEstimated;
    made.scale =
        options.Real(kScaleOption) * setting_.size * kHuberConstant / TuningConstant(made.loss);
    if (!TermRegistry::Global().Resolve(WithoutLoss(spec), &term, &options, error)) return false;
    made.family = MakeFamilyOf(*term, setting_, options, error);
    if (made.family == nullptr || made.family->rows() == nullptr) return false;
    terms_.push_back(std::move(made));
    return true;
  }

  /// Control points; false where there is no finite answer. `from_nothing`: *x is no fit.
  bool Solve(bool from_nothing, Eigen::VectorXd* x) {
    // Weights settle to some digits within 20 steps; nothing here needs more of them.
    constexpr int kMaxSteps = 30;
    constexpr double kSettled = 1e-6;
    if (!from_nothing) EstimateScales(*x);
    for (int step = 0; step < kMaxSteps; ++step) {
      const Eigen::VectorXd before = *x;
      if (!SolveOnce(from_nothing && step == 0, x)) return false;
      if (step > 0 && (*x - before).cwiseAbs().maxCoeff() <= kSettled * setting_.size) break;
      EstimateScales(*x);
    }
    return true;
  }

  const std::vector<HuberTerm>& terms() const { return terms_; }
  /// Estimated standard deviation of the plain residuals in each coordinate.
  double Sigma(const HuberTerm& term, const Eigen::VectorXd& x) const {
    return Median(PlainNorms(term, x)) / MedianOfNorm(term.coordinates);
  }

 private:
  void EstimateScales(const Eigen::VectorXd& x) {
    for (HuberTerm& term : terms_) {
      if (term.estimated) term.scale = kHuberConstant * Sigma(term, x);
    }
  }
  std::vector<double> PlainNorms(const HuberTerm& term, const Eigen::VectorXd& x) const {
    std::vector<double> norms = ResidualNorms(*term.family->rows(), x.data());
    for (double& norm : norms) norm /= std::sqrt(term.family->weight());
    return norms;
  }

  bool SolveOnce(bool first, Eigen::VectorXd* x) const {
    std::deque<ScaledRows> weighted;
    std::vector<const RowSource*> sources;
    for (const HuberTerm& term : terms_) {
      sources.push_back(term.family->rows());
      if (first || term.loss.empty() || !(term.family->weight() > 0.0)) continue;
      std::vector<double> factors = PlainNorms(term, *x);
      for (double& factor : factors) {
        factor = factor > term.scale ? std::sqrt(term.scale / factor) : 1.0;
      }
      weighted.emplace_back(sources.back(), std::move(factors));
      sources.back() = &weighted.back();
    }
    const auto view = CurveView::Make(problem_, std::move(sources), nullptr);
    if (view == nullptr) return false;
    const Eigen::VectorXd free = problem_.elimination().FreeVariables(*x);
    const NearestSolution solution =
        SolveNearest(view->row_source(),
                     Eigen::Map<const Points>(free.data(), view->num_points(), view->dimension()));
    if (!solution.found) return false;
    *x = problem_.elimination().Expand(Eigen::Map<const Eigen::VectorXd>(
        solution.control_points.data(), solution.control_points.size()));
    return x->allFinite();
  }

  const Problem& problem_;
  const FitSetting& setting_;
  std::vector<HuberTerm> terms_;
};

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
      if (option == kScaleOption) value = NumberText(scale);
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
    return OptionText(spec, kScaleOption) == kEstimated || !IsConvex(OptionText(spec, "loss"));
  });
}

bool StartRobustly(const Problem& problem, const std::vector<LinearConstraint>& constraints,
                   const FitSetting& setting, bool may_guard, std::vector<NameSpec>* terms,
                   std::optional<Eigen::VectorXd>* start, std::string* error) {
  const auto is_estimated = [](const NameSpec& spec) {
    return OptionText(spec, kScaleOption) == kEstimated;
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
