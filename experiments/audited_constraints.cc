#include "experiments/audited_constraints.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "cost_functions/bessel_tangents.h"
#include "cost_functions/end_options.h"
#include "problems/curve_constraints.h"
#include "problems/fit_problem.h"

namespace batten {
namespace {

constexpr double kAny = std::numeric_limits<double>::quiet_NaN();

class ConstraintWriter {
 public:
  ConstraintWriter(const Problem& problem, const Eigen::VectorXd& x, AuditedFit* plain)
      : problem_(problem), fit_(*problem.curve_fit()), x_(x), plain_(plain) {
    const auto degree = static_cast<std::size_t>(plain->degree);
    const auto last = plain->knots.size() - degree - 1;
    distinct_.assign(plain->knots.begin() + static_cast<std::ptrdiff_t>(degree),
                     plain->knots.begin() + static_cast<std::ptrdiff_t>(last) + 1);
    distinct_.erase(std::unique(distinct_.begin(), distinct_.end()), distinct_.end());
    for (const NameSpec& spec : fit_.spec().constraints) {
      const OptionValues options = OptionsOf(spec);
      if (IsFree(spec, options)) numbers_.insert(options.Integer("free"));
    }
  }

  void Add(const NameSpec& spec) {
    const OptionValues options = OptionsOf(spec);
    if (spec.name == "curvature" || spec.name == "tangent" || IsFree(spec, options)) {
      AddCondition(spec, options);
      return;
    }
    const std::string name = spec.ToString();
    if (spec.name == "point") AddAt(name, options.Real("t"), 0, Given(options));
    if (spec.name == "derivative") {
      AddAt(name, options.Real("t"), options.Integer("order"), Given(options));
    }
    if (spec.name == "periodic") AddPeriodic(name);
    for (const bool at_end : {false, true}) {
      if (spec.name == "point" || spec.name == "derivative" || spec.name == "periodic") break;
      if (options.Word("end") == (at_end ? "begin" : "end")) continue;
      if (spec.name == "not-a-knot") {
        AddNotAKnot(name, at_end);
      } else {
        AddAtEnd(spec, options, at_end);
      }
    }
  }

 private:
  using Part = AuditedEquation::Part;

  static OptionValues OptionsOf(const NameSpec& spec) {
    OptionValues options;
    std::string error;
    CHECK(ResolveConstraint(spec, &options, &error)) << error;
    return options;
  }
  static bool IsFree(const NameSpec& spec, const OptionValues& options) {
    return IsAtAParameter(spec.name) && options.Integer("free") > 0;
  }

  std::size_t dimension() const { return static_cast<std::size_t>(plain_->dimension); }
  double begin() const { return distinct_.front(); }
  double end() const { return distinct_.back(); }

  /// NaN where a coordinate is not given.
  std::vector<double> Given(const OptionValues& options) const {
    Eigen::RowVectorXd given;
    std::string beyond;
    GivenCoordinates(options, plain_->dimension, &given, &beyond);
    std::vector<double> value;
    for (const double coordinate : given) {
      value.push_back(coordinate == kNotGiven ? kAny : coordinate);
    }
    return value;
  }

  /// One equation per coordinate that has a value.
  void AddCoordinates(const std::string& name, const std::vector<Part>& parts,
                      const std::vector<double>& value) {
    for (std::size_t c = 0; c < dimension(); ++c) {
      if (std::isnan(value[c])) continue;
      std::vector<double> direction(dimension(), 0.0);
      direction[c] = 1.0;
      plain_->equations.push_back({name, parts, std::move(direction), value[c]});
    }
  }

  void AddAt(const std::string& name, double t, int derivative, const std::vector<double>& value) {
    AddCoordinates(name, {{t, derivative, 1.0}}, value);
  }

  void AddAtEnd(const NameSpec& spec, const OptionValues& options, bool at_end) {
    std::vector<double> value(dimension(), 0.0);
    const double t = at_end ? end() : begin();
    if (spec.name == "natural") return AddAt(spec.ToString(), t, 2, value);
    if (spec.name == "ends") {
      const std::size_t first = at_end ? plain_->points.size() - dimension() : 0;
      for (std::size_t c = 0; c < dimension(); ++c) value[c] = plain_->points[first + c];
      return AddAt(spec.ToString(), t, 0, value);
    }
    CHECK_EQ(spec.name, "clamped");
    const auto bessel = BesselTangent(fit_.setting(), at_end);
    const std::vector<double> given = Given(options);
    for (std::size_t c = 0; c < dimension(); ++c) {
      value[c] = !std::isnan(given[c])
                     ? given[c]
                     : (bessel.has_value() ? (*bessel)[static_cast<Eigen::Index>(c)] : kAny);
    }
    AddAt(spec.ToString(), t, 1, value);
  }

  /// C^(p) is constant on a span: taken in the middle of both.
  void AddNotAKnot(const std::string& name, bool at_end) {
    const std::size_t k = at_end ? distinct_.size() - 2 : 1;
    const auto middle = [this](std::size_t from) {
      return distinct_[from] + 0.5 * (distinct_[from + 1] - distinct_[from]);
    };
    AddCoordinates(name, {{middle(k), plain_->degree, 1.0}, {middle(k - 1), plain_->degree, -1.0}},
                   std::vector<double>(dimension(), 0.0));
  }

  void AddPeriodic(const std::string& name) {
    for (int k = 0; k < plain_->degree; ++k) {
      AddCoordinates(name, {{begin(), k, 1.0}, {end(), k, -1.0}},
                     std::vector<double>(dimension(), 0.0));
    }
  }

  /// Where the parameter is given, C' across the direction is linear: u_c C'_m = u_m C'_c, u_m the
  /// largest part of the direction.
  void AddAcross(const AuditedCondition& tangent) {
    const std::vector<double>& u = tangent.value;
    const auto larger = [](double a, double b) { return std::abs(a) < std::abs(b); };
    const auto m =
        static_cast<std::size_t>(std::max_element(u.begin(), u.end(), larger) - u.begin());
    for (std::size_t c = 0; c < dimension(); ++c) {
      if (c == m) continue;
      std::vector<double> direction(dimension(), 0.0);
      direction[c] = 1.0;
      direction[m] = -u[c] / u[m];
      plain_->equations.push_back({tangent.name, {{tangent.t, 1, 1.0}}, direction, 0.0});
    }
  }

  double ParameterOf(const NameSpec& spec, const OptionValues& options) const {
    if (!IsFree(spec, options)) return options.Real("t");
    const auto place = std::distance(numbers_.begin(), numbers_.find(options.Integer("free")));
    for (const VariableRange& range : problem_.ranges()) {
      if (range.name == kConstraintParameters) return x_[range.begin + place];
    }
    LOG(FATAL) << "a free parameter is no variable";
    return kAny;
  }

  void AddCondition(const NameSpec& spec, const OptionValues& options) {
    AuditedCondition condition;
    condition.name = spec.ToString();
    condition.t = ParameterOf(spec, options);
    const double size = fit_.size();
    if (spec.name == "point" || spec.name == "derivative") {
      condition.value = Given(options);
      if (spec.name == "derivative") condition.order = options.Integer("order");
    } else if (spec.name == "tangent") {
      condition.kind = AuditedCondition::Kind::kTangent;
      condition.amount = options.Real("least") * size;
      condition.value = Given(options);
      double largest = 0.0;
      double squared = 0.0;
      for (const double v : condition.value) largest = std::max(largest, std::abs(v));
      for (double& v : condition.value) v /= largest;
      for (const double v : condition.value) squared += v * v;
      for (double& v : condition.value) v /= std::sqrt(squared);
      if (!IsFree(spec, options)) AddAcross(condition);
    } else {
      condition.kind = AuditedCondition::Kind::kCurvature;
      condition.amount = options.Real("kappa");
      condition.unit = size / std::max(1.0 / size, std::abs(condition.amount));
    }
    plain_->conditions.push_back(std::move(condition));
  }

  const Problem& problem_;
  const CurveFit& fit_;
  const Eigen::VectorXd& x_;
  AuditedFit* plain_;
  std::vector<double> distinct_;  // knots of the domain
  std::set<int> numbers_;         // of parameters that are found, in the order of their variables
};

}  // namespace

void AddConstraints(const Problem& problem, const Eigen::VectorXd& x, AuditedFit* plain) {
  ConstraintWriter writer(problem, x, plain);
  for (const NameSpec& spec : problem.curve_fit()->spec().constraints) writer.Add(spec);
  if (plain->equations.empty()) return;
  const auto num_entries = static_cast<int>(plain->control_points.size());
  std::vector<bool> stays(plain->control_points.size(), false);
  for (const int variable : problem.elimination().free()) {
    if (variable < num_entries) stays[static_cast<std::size_t>(variable)] = true;
  }
  for (int entry = 0; entry < num_entries; ++entry) {
    if (!stays[static_cast<std::size_t>(entry)]) plain->eliminated.push_back(entry);
  }
}

}  // namespace batten
