#include "problems/robust_start.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include "cost_functions/term.h"
#include "problems/curve_view.h"
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
    made.estimated = OptionText(spec, kScaleOption) == kEstimated;
    made.scale =
        options.Real(kScaleOption) * setting_.size * kHuberConstant / TuningConstant(made.loss);
    if (!TermRegistry::Global().Resolve(WithoutLoss(spec), &term, &options, error)) return false;
    made.family = term->MakeFamily(setting_, options, error);
    if (made.family == nullptr || made.family->rows() == nullptr) return false;
    terms_.push_back(std::move(made));
    return true;
  }

  /// All variables; false where there is no finite answer.
  bool Solve(Eigen::VectorXd* x) {
    // Weights settle to some digits within 20 steps; nothing here needs more of them.
    constexpr int kMaxSteps = 30;
    constexpr double kSettled = 1e-6;
    for (int step = 0; step < kMaxSteps; ++step) {
      const Eigen::VectorXd before = *x;
      if (!SolveOnce(step == 0, x)) return false;
      if (step > 0 && (*x - before).cwiseAbs().maxCoeff() <= kSettled * setting_.size) break;
      for (HuberTerm& term : terms_) {
        if (term.estimated) term.scale = kHuberConstant * Sigma(term, *x);
      }
    }
    return true;
  }

  const std::vector<HuberTerm>& terms() const { return terms_; }
  /// Estimated standard deviation of the plain residuals in each coordinate.
  double Sigma(const HuberTerm& term, const Eigen::VectorXd& x) const {
    return Median(PlainNorms(term, x)) / MedianOfNorm(setting_.dimension);
  }

 private:
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

bool Freeze(const HuberFit& fit, const Eigen::VectorXd& x, const FitSetting& setting,
            std::vector<NameSpec>* terms, std::string* error) {
  constexpr double kLeast = 1e-6;  // least that loss_scale may be
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
  }
  return true;
}

}  // namespace

bool AsksForRobustStart(const std::vector<NameSpec>& terms) {
  return std::any_of(terms.begin(), terms.end(), [](const NameSpec& spec) {
    return OptionText(spec, kScaleOption) == kEstimated || !IsConvex(OptionText(spec, "loss"));
  });
}

bool StartRobustly(const Problem& problem, const FitSetting& setting, std::vector<NameSpec>* terms,
                   std::optional<Eigen::VectorXd>* start, std::string* error) {
  const auto is_estimated = [](const NameSpec& spec) {
    return OptionText(spec, kScaleOption) == kEstimated;
  };
  const auto estimated = std::find_if(terms->begin(), terms->end(), is_estimated);
  HuberFit fit(problem, setting);
  Eigen::VectorXd x = problem.start();
  std::string why;
  bool solved = setting.parameter_offset < 0;
  for (const NameSpec& spec : *terms) solved = solved && fit.AddTerm(spec, &why);
  solved = solved && fit.Solve(&x);
  if (!solved) {
    start->reset();
    if (estimated == terms->end()) return true;
    *error = "term " + estimated->ToString() +
             ": mad needs fixed parameters and terms that are compiled rows; give a number instead";
    return false;
  }
  *start = x;
  return Freeze(fit, x, setting, terms, error);
}

}  // namespace batten
