#include "problems/huber_fit.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "cost_functions/term.h"
#include "problems/curve_view.h"
#include "splines/nearest_solution.h"
#include "splines/scaled_rows.h"

namespace batten {
namespace {

constexpr double kHuberConstant = 1.345;

/// Of |e|, e normal with standard deviation 1 in each of so many coordinates: the root of the
/// median of chi-squared. Residuals of curve_fairing have 6 in four dimensions.
double MedianOfNorm(int coordinates) {
  constexpr double kMedians[] = {0.6744897502, 1.1774100225, 1.5381722545,
                                 1.8321282652, 2.0860153861, 2.3126004038};
  return kMedians[coordinates - 1];
}

NameSpec WithoutLoss(NameSpec spec) {
  const auto of_loss = [](const auto& option) {
    return option.first == "loss" || option.first == kLossScale;
  };
  spec.options.erase(std::remove_if(spec.options.begin(), spec.options.end(), of_loss),
                     spec.options.end());
  return spec;
}

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Of the control polygon, closed where the curve is: a little more than the curve's.
double PolygonLength(const BsplineBasis& basis, int dimension, const Eigen::VectorXd& x) {
  const int n = basis.num_control_points();
  const Eigen::Map<const Points> points(x.data(), n, dimension);
  double length = 0.0;
  for (int j = basis.periodic() ? 0 : 1; j < n; ++j) {
    length += (points.row(j) - points.row((j + n - 1) % n)).norm();
  }
  return length;
}

}  // namespace

double TuningConstant(const std::string& loss) {
  if (loss == "cauchy") return 2.385;
  if (loss == "tukey") return 4.685;
  return kHuberConstant;
}

std::string OptionText(const NameSpec& spec, const std::string& name) {
  for (const auto& [option, value] : spec.options) {
    if (option == name) return value;
  }
  return "";
}

bool HuberFit::AddRows(const NameSpec& spec, HuberTerm* made, std::string* error) {
  const Term* term = nullptr;
  OptionValues options;
  if (!TermRegistry::Global().Resolve(WithoutLoss(spec), &term, &options, error)) return false;
  made->family = MakeFamilyOf(*term, setting_, options, error);
  if (made->family == nullptr) return false;
  if (spec.name == "curve_fairing") {
    made->curved = std::move(made->family);
    made->coordinates = made->curved->num_residuals();
    made->stand_in = FairingOfConstantSpeed(setting_, options);
    return AddRows(made->stand_in.fairing, made, error);
  }
  return made->family->rows() != nullptr;
}

bool HuberFit::AddTerm(const NameSpec& spec, std::string* error) {
  const Term* term = nullptr;
  OptionValues options;
  if (!TermRegistry::Global().Resolve(spec, &term, &options, error)) return false;
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
  HuberTerm made;
  if (options.Word("loss") != "none") made.loss = options.Word("loss");
  made.coordinates = setting_.dimension;
  made.estimated = OptionText(spec, kLossScale) == kEstimatedScale;
  made.scale =
      options.Real(kLossScale) * setting_.size * kHuberConstant / TuningConstant(made.loss);
  if (!AddRows(spec, &made, error)) return false;
  terms_.push_back(std::move(made));
  return true;
}

bool HuberFit::Solve(bool from_nothing, Eigen::VectorXd* x) {
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

double HuberFit::Sigma(const HuberTerm& term, const Eigen::VectorXd& x) const {
  return Median(PlainNorms(term, x)) / MedianOfNorm(term.coordinates);
}

void HuberFit::EstimateScales(const Eigen::VectorXd& x) {
  for (HuberTerm& term : terms_) {
    if (term.estimated) term.scale = kHuberConstant * Sigma(term, x);
  }
}

std::vector<double> HuberFit::PlainNorms(const HuberTerm& term, const Eigen::VectorXd& x) const {
  if (term.curved == nullptr) {
    std::vector<double> norms = ResidualNorms(*term.family->rows(), x.data());
    for (double& norm : norms) norm /= std::sqrt(term.family->weight());
    return norms;
  }
  std::vector<double> norms(static_cast<std::size_t>(term.curved->size()), NAN);
  Eigen::VectorXd residuals;
  if (term.curved->Residuals(x, &residuals) != Status::kOk) return norms;
  const int r = term.curved->num_residuals();
  for (std::size_t b = 0; b < norms.size(); ++b) {
    norms[b] = residuals.segment(static_cast<Eigen::Index>(b) * r, r).norm();
  }
  return norms;
}

/// One per row; none where all are 1. `first`: x is no fit.
std::vector<double> HuberFit::RootWeights(const HuberTerm& term, bool first,
                                          const Eigen::VectorXd& x) const {
  if (term.curved != nullptr) {
    // A closed curve that fairing shrinks would be faired the more for it, down to a point.
    const double length =
        std::max(PolygonLength(*setting_.basis, setting_.dimension, x), setting_.size);
    const double factor = std::pow(term.stand_in.unit / length, 0.5 * term.stand_in.power);
    return std::vector<double>(static_cast<std::size_t>(term.family->size()), factor);
  }
  if (first || term.loss.empty() || !(term.family->weight() > 0.0)) return {};
  std::vector<double> factors = PlainNorms(term, x);
  for (double& factor : factors) {
    factor = factor > term.scale ? std::sqrt(term.scale / factor) : 1.0;
  }
  return factors;
}

bool HuberFit::SolveOnce(bool first, Eigen::VectorXd* x) const {
  std::deque<ScaledRows> weighted;
  std::vector<const RowSource*> sources;
  for (const HuberTerm& term : terms_) {
    sources.push_back(term.family->rows());
    std::vector<double> factors = RootWeights(term, first, *x);
    if (factors.empty()) continue;
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

}  // namespace batten
