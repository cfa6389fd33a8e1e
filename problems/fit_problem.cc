#include "problems/fit_problem.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "problems/constraint_projection.h"
#include "problems/curve_constraints.h"
#include "problems/curve_speeds.h"
#include "problems/fit_guard.h"
#include "problems/robust_start.h"

namespace batten {

Points CurveFit::ControlPoints(const Eigen::VectorXd& x) const {
  const int n = basis_->num_control_points();
  Points points(n, dimension());
  for (int j = 0; j < n; ++j) {
    for (int c = 0; c < dimension(); ++c) {
      points(j, c) =
          x[static_cast<Eigen::Index>(j) * dimension() + c] / setting_.scale + setting_.center[c];
    }
  }
  return points;
}

Eigen::VectorXd CurveFit::Variables(const Points& control_points) const {
  Eigen::VectorXd x(control_points.size());
  for (Eigen::Index j = 0; j < control_points.rows(); ++j) {
    for (int c = 0; c < dimension(); ++c) {
      x[j * dimension() + c] = (control_points(j, c) - setting_.center[c]) * setting_.scale;
    }
  }
  return x;
}

Eigen::VectorXd CurveFit::Variables(const Points& control_points, const Eigen::VectorXd& t) const {
  Eigen::VectorXd points = Variables(control_points);
  if (!has_free_parameters()) return points;
  Eigen::VectorXd x(points.size() + t.size());
  x << points, t;
  return x;
}

BsplineCurve CurveFit::Curve(const Eigen::VectorXd& x) const {
  return BsplineCurve(*basis_, ControlPoints(x));
}

bool CurveFit::ChooseParameters(std::string* error) {
  const auto m = data_.points.rows();
  if (m < 2) {
    *error = "found " + std::to_string(m) + " data point; a fit needs at least 2";
    return false;
  }
  if (spec_.parameters.has_value()) {
    const auto parameters = Parameterize(*spec_.parameters, spec_.closed, data_.points, error);
    if (!parameters.has_value()) return false;
    parameters_ = *parameters;
    return true;
  }
  if (!data_.parameters.has_value()) {
    *error = "parameters are to be given, but the data have no column t";
    return false;
  }
  parameters_ = std::move(*data_.parameters);
  data_.parameters.reset();
  if (spec_.domain.has_value()) {
    domain_ = *spec_.domain;
  } else if (!spec_.closed && IsNondecreasing(parameters_.data(), parameters_.size())) {
    domain_ = {parameters_[0], parameters_[m - 1]};
  } else if (!spec_.closed) {
    const auto [low, high] =
        std::minmax_element(parameters_.data(), parameters_.data() + parameters_.size());
    domain_ = {*low, *high};
  }
  if (!(domain_.first < domain_.second) || !std::isfinite(domain_.second - domain_.first)) {
    *error = "the parameters' domain is empty: it goes from " + NumberText(domain_.first) + " to " +
             NumberText(domain_.second);
    return false;
  }
  return true;
}

bool CurveFit::ChooseKnots(std::string* error) {
  const int lowest = spec_.closed ? 1 : spec_.degree + 1;
  if (spec_.degree < 1 || spec_.degree > kMaxDegree) {
    *error = "degree is " + std::to_string(spec_.degree) + "; allowed: 1 to " +
             std::to_string(kMaxDegree);
    return false;
  }
  std::vector<double> knots = spec_.given_knots;
  if (knots.empty()) {
    if (spec_.control_points < lowest || spec_.control_points > kMaxControlPoints) {
      *error = "control_points is " + std::to_string(spec_.control_points) +
               "; allowed: " + std::to_string(lowest) + " to " + std::to_string(kMaxControlPoints) +
               (spec_.closed ? "" : " (degree + 1 or more for an open curve)");
      return false;
    }
    const EndKnots ends = spec_.closed ? EndKnots::kPeriodic : spec_.ends;
    if (spec_.knots == KnotRule::kUniform) {
      knots = UniformKnots(spec_.degree, spec_.control_points, ends, domain_.first, domain_.second);
    } else {
      Eigen::VectorXd sorted = parameters_;
      std::sort(sorted.data(), sorted.data() + sorted.size());
      knots = AveragedKnots(spec_.degree, spec_.control_points, ends, domain_.first, domain_.second,
                            sorted, error);
      if (knots.empty()) return false;
    }
  }
  basis_ = BsplineBasis::Make(spec_.degree, spec_.closed, std::move(knots), error);
  if (!basis_.has_value()) return false;
  if (spec_.control_points != 0 && spec_.control_points != basis_->num_control_points()) {
    *error = "control_points is " + std::to_string(spec_.control_points) +
             ", but the given knots make " + std::to_string(basis_->num_control_points());
    return false;
  }
  spec_.control_points = basis_->num_control_points();
  return true;
}

bool CurveFit::PlaceParameters(std::string* error) {
  const double begin = basis_->domain_begin();
  const double end = basis_->domain_end();
  if (spec_.parameters.has_value() && !spec_.given_knots.empty()) {
    // A rule's parameters go from 0 to 1, whatever domain the given knots have.
    for (double& t : parameters_) t = std::min(begin + t * (end - begin), end);
  }
  sorted_ = IsNondecreasing(parameters_.data(), parameters_.size());
  const double last = parameters_[parameters_.size() - 1];
  if (sorted_ && parameters_[0] >= begin && (spec_.closed ? last < end : last <= end)) return true;
  for (Eigen::Index i = 0; i < parameters_.size(); ++i) {
    const double t = parameters_[i];
    if (t >= begin && (spec_.closed ? t < end : t <= end)) continue;
    const std::string place =
        "parameter " + NumberText(t) + " of data point " + std::to_string(i + 1);
    if (!spec_.closed) {
      *error = place + " is outside the domain; allowed: " + NumberText(begin) + " to " +
               NumberText(end);
      return false;
    }
    const bool period_is_known = spec_.domain.has_value() || !spec_.given_knots.empty();
    if (!period_is_known && !(t >= domain_.first && t <= domain_.second)) {
      *error = place +
               " is outside [0, 1]; parameters of a closed curve wrap around only if the "
               "domain, one period, is stated";
      return false;
    }
    parameters_[i] = basis_->Wrap(t);
    sorted_ = false;
  }
  return true;
}

bool CurveFit::Scale(std::string* error) {
  // Points without weight say nothing of the size of the fit.
  const Eigen::VectorXd* const weights = data_.weights.has_value() ? &*data_.weights : nullptr;
  Eigen::RowVectorXd low;
  Eigen::RowVectorXd high;
  if (weights == nullptr) {
    FindBoundingBox(data_.points, &low, &high);
  } else {
    low.setConstant(dimension(), std::numeric_limits<double>::infinity());
    high = -low;
    for (Eigen::Index i = 0; i < data_.points.rows(); ++i) {
      if ((*weights)[i] == 0.0) continue;
      low = low.cwiseMin(data_.points.row(i));
      high = high.cwiseMax(data_.points.row(i));
    }
  }
  const double side = (high - low).maxCoeff();
  if (side > 0.0 && side < kSmallestSpread) {
    *error = "the data points spread over " + NumberText(side) + "; allowed: 0 or at least " +
             NumberText(kSmallestSpread) + ", so that squares of residuals do not underflow";
    return false;
  }
  if (weights != nullptr) {
    const double unit = weights->maxCoeff() * side * side;
    if (side > 0.0 && !(unit >= kSmallestUnit && unit <= 1.0 / kSmallestUnit)) {
      *error = "the largest weight times the squared spread of the points is " + NumberText(unit) +
               "; allowed: " + NumberText(kSmallestUnit) + " to " +
               NumberText(1.0 / kSmallestUnit) + ", so that E can be computed";
      return false;
    }
  }
  setting_.dimension = dimension();
  size_ = side > 0.0 ? side : 1.0;
  const Eigen::RowVectorXd center = low + 0.5 * (high - low);
  for (int c = 0; c < dimension(); ++c) setting_.center[c] = center[c];
  // A power of two: dividing by it rounds nothing. It goes by distances, not by the box, whose
  // sides change as the data are turned: steps along gradients depend on it where parameters move.
  // Of most outlines the box's longest side has the same one.
  constexpr double kRadii = 1.5;
  const double extent = side > 0.0 ? kRadii * LargestDistanceFromMean(center, side) : 1.0;
  setting_.scale = std::exp2(-std::ceil(std::log2(extent)));
  setting_.size = size_ * setting_.scale;
  return true;
}

double CurveFit::LargestDistanceFromMean(const Eigen::RowVectorXd& center, double side) const {
  const auto has_weight = [this](Eigen::Index i) {
    return !data_.weights.has_value() || (*data_.weights)[i] != 0.0;
  };
  // In sides of the box around its center: nothing overflows or cancels.
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(dimension());
  int count = 0;
  for (Eigen::Index i = 0; i < data_.points.rows(); ++i) {
    if (!has_weight(i)) continue;
    sum += (data_.points.row(i) - center) / side;
    ++count;
  }
  const Eigen::RowVectorXd mean = sum / count;
  double largest = 0.0;
  for (Eigen::Index i = 0; i < data_.points.rows(); ++i) {
    if (!has_weight(i)) continue;
    largest = std::max(largest, ((data_.points.row(i) - center) / side - mean).squaredNorm());
  }
  return std::sqrt(largest) * side;
}

bool CurveFit::CheckSpanWeights(std::string* error) const {
  if (spec_.span_weights.empty()) return true;
  const std::vector<double>& u = basis_->knots();
  std::size_t num_spans = 0;
  for (int span = basis_->first_span(); span <= basis_->last_span(); ++span) {
    const auto k = static_cast<std::size_t>(span);
    if (u[k] < u[k + 1]) ++num_spans;
  }
  if (spec_.span_weights.size() != num_spans) {
    *error = "found " + std::to_string(spec_.span_weights.size()) +
             " weights of spans; the curve has " + std::to_string(num_spans) +
             " spans that are not empty";
    return false;
  }
  for (const double weight : spec_.span_weights) {
    if (weight >= 0.0 && std::isfinite(weight)) continue;
    *error = "a weight of a span is " + NumberText(weight) + "; allowed: at least 0";
    return false;
  }
  return true;
}

namespace {

/// Constraints that are not linear, and variables for the parameters that they find.
bool AddConditions(const CurveFit& fit, const std::vector<LinearConstraint>& linear,
                   Problem* problem, std::string* error) {
  CurveConditions made;
  if (!MakeCurveConditions(fit.spec().constraints, fit, problem->num_variables(), problem->start(),
                           &made, error)) {
    return false;
  }
  if (made.conditions.empty()) return true;
  if (made.start.size() > 0) {
    problem->AddVariables(kConstraintParameters, made.start);
    if (!problem->SetLinearConstraints(linear, error)) return false;
  }
  if (!CheckSpeeds(fit.setting(), made.conditions, *problem, linear, error)) return false;
  problem->SetNonlinearConstraints(
      std::make_shared<CurveConditionFamily>(fit.setting(), std::move(made.conditions)));
  return CheckForContradictions(*problem, linear, error);
}

}  // namespace

std::unique_ptr<Problem> MakeFitProblem(DataSet data, FitSpec spec, std::string* error) {
  std::unique_ptr<CurveFit> fit(new CurveFit(std::move(data), std::move(spec)));
  if (!fit->ChooseParameters(error) || !fit->ChooseKnots(error) || !fit->PlaceParameters(error)) {
    return nullptr;
  }
  const bool is_free = fit->spec_.parameter_kind == ParameterKind::kFree;
  if (fit->spec_.terms.empty()) {
    fit->spec_.terms.push_back({DistanceTermOf(fit->spec_.parameter_kind), {}, nullptr});
  }
  const bool guard_is_said = fit->spec_.guard.has_value();
  if (guard_is_said) {
    const auto m = static_cast<int>(fit->data_.points.rows());
    if (!ApplyGuard(*fit->spec_.guard, m, &fit->spec_.terms, error)) return nullptr;
    fit->spec_.guard.reset();
  }
  if (!fit->CheckStart(error) || !fit->CheckEnds(error) || !fit->CheckSpanWeights(error) ||
      !fit->Scale(error)) {
    return nullptr;
  }
  const Points start = fit->StartPoints();
  if (is_free) fit->StartParameters(start);
  fit->sites_.size = static_cast<int>(fit->parameters_.size());
  fit->sites_.parameters = fit->parameters_.data();
  fit->sites_.points = fit->data_.points.data();
  fit->sites_.weights = fit->data_.weights.has_value() ? fit->data_.weights->data() : nullptr;
  GroupBySpan(*fit->basis_, fit->sorted_, &fit->sites_);
  fit->setting_.basis = &*fit->basis_;
  fit->setting_.data = &fit->sites_;
  if (!fit->spec_.span_weights.empty()) fit->setting_.span_weights = &fit->spec_.span_weights;

  auto problem =
      std::make_unique<Problem>(fit->spec_.name.empty() ? fit->data_.name : fit->spec_.name);
  problem->AddVariables("control_points", fit->Variables(start));
  std::vector<LinearConstraint> constraints;
  if (is_free) fit->AddParameters(problem.get(), &constraints);
  if (!AppendCurveConstraints(fit->spec_.constraints, *fit, &constraints, error) ||
      !problem->SetLinearConstraints(constraints, error)) {
    return nullptr;
  }
  if (AsksForRobustStart(fit->spec_.terms)) {
    std::optional<Eigen::VectorXd> robust;
    if (!StartRobustly(*problem, constraints, fit->setting_, !guard_is_said, &fit->spec_.terms,
                       &robust, error)) {
      return nullptr;
    }
    const bool is_asked_for = fit->spec_.start != "data" || fit->spec_.start_points.size() > 0;
    fit->starts_robustly_ = robust.has_value() && !is_asked_for;
    if (fit->starts_robustly_) problem->SetStart(*robust);
  }
  if (!AddConditions(*fit, constraints, problem.get(), error)) return nullptr;
  bool has_parameters = !is_free;
  double largest_weight = 0.0;
  std::set<std::pair<const Term*, std::map<std::string, std::string>>> meanings;
  for (const NameSpec& name : fit->spec_.terms) {
    const Term* term = nullptr;
    OptionValues options;
    if (!TermRegistry::Global().Resolve(name, &term, &options, error)) return nullptr;
    if (!fit->CheckKind(name, *term, error)) return nullptr;
    has_parameters = has_parameters || term->Info().free_parameters;
    if (!meanings.emplace(term, options.ToText()).second) {
      *error = "term " + name.ToString() + " is given twice; give it once, with twice the weight";
      return nullptr;
    }
    auto family = MakeFamilyOf(*term, fit->setting_, options, error);
    if (family == nullptr) return nullptr;
    largest_weight = std::max(largest_weight, family->weight());
    problem->AddTerm(name.ToString(), std::move(family));
  }
  if (!has_parameters) {
    *error = "parameters are free, but no term has them; add free_parameter";
    return nullptr;
  }
  if (largest_weight < kSmallestTermWeight) {
    *error = "the largest weight of a term is " + NumberText(largest_weight) +
             "; allowed: at least " + NumberText(kSmallestTermWeight);
    return nullptr;
  }
  const double scale = fit->setting_.scale;
  problem->SetUnits({1.0 / scale, 1.0 / (scale * scale), 1.0 / scale});
  problem->SetCurveFit(std::move(fit));
  return problem;
}

}  // namespace batten
