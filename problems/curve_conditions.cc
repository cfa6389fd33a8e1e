#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "cost_functions/end_options.h"
#include "problems/curve_constraints.h"
#include "problems/curve_directions.h"
#include "problems/fit_problem.h"

namespace batten {
namespace {

using Kind = CurveCondition::Kind;

/// One constraint text as conditions.
class ConditionBuilder {
 public:
  ConditionBuilder(const CurveFit& fit, const NameSpec& spec, OptionValues options,
                   std::string* error)
      : fit_(fit), spec_(spec), options_(std::move(options)), error_(error) {}

  int free_number() const { return options_.Integer("free"); }
  double given_t() const { return options_.Real("t"); }

  /// A point or a derivative at a given parameter is linear: no condition comes of it.
  bool Build(std::vector<CurveCondition>* conditions) const {
    CurveCondition condition;
    condition.name = spec_.ToString();
    if (!PlaceAt(&condition)) return false;
    if (spec_.name == "point" || spec_.name == "derivative") {
      return free_number() == 0 || AddCoordinates(condition, conditions);
    }
    if (spec_.name == "tangent") return AddTangent(condition, conditions);
    return AddCurvature(condition, conditions);
  }

 private:
  bool Refuse(const std::string& why) const {
    *error_ = "constraint " + spec_.ToString() + " " + why;
    return false;
  }

  bool PlaceAt(CurveCondition* condition) const {
    const BsplineBasis& basis = fit_.basis();
    const double t = given_t();
    if (t == kNotGiven && free_number() > 0) return true;
    if (!(t >= basis.domain_begin() && t <= basis.domain_end())) {
      return Refuse((t == kNotGiven ? std::string("has no t") : "has t = " + NumberText(t)) +
                    "; allowed: " + NumberText(basis.domain_begin()) + " to " +
                    NumberText(basis.domain_end()) +
                    (t == kNotGiven ? ", or free=1 to 99 for a parameter that is found" : ""));
    }
    condition->t = basis.Wrap(t);
    return true;
  }

  bool GiveCoordinates(Eigen::RowVectorXd* given) const {
    std::string beyond;
    if (GivenCoordinates(options_, fit_.dimension(), given, &beyond)) return true;
    return Refuse("gives " + beyond + ", but the data have dimension " +
                  std::to_string(fit_.dimension()));
  }

  /// Of C, or of a derivative, which counts by the parameter normalised to [0, 1].
  bool AddCoordinates(CurveCondition condition, std::vector<CurveCondition>* conditions) const {
    Eigen::RowVectorXd given;
    if (!GiveCoordinates(&given)) return false;
    if (spec_.name == "derivative" && !TakeOrder(&condition)) return false;
    bool any = false;
    const FitSetting& setting = fit_.setting();
    const double unit = std::pow(fit_.basis().domain_length(), condition.order);
    for (int c = 0; c < fit_.dimension(); ++c) {
      if (given[c] == kNotGiven) continue;
      any = true;
      CurveCondition of_coordinate = condition;
      of_coordinate.direction[c] = unit;
      const double origin = condition.order == 0 ? setting.center[c] : 0.0;
      of_coordinate.value = unit * (given[c] - origin) * setting.scale;
      conditions->push_back(std::move(of_coordinate));
    }
    return any || Refuse("holds nothing; give at least one of x, y, z, w");
  }

  /// A third derivative would need five of the basis functions, and has no use but its own.
  bool TakeOrder(CurveCondition* condition) const {
    condition->order = options_.Integer("order");
    constexpr int kMost = 2;
    if (condition->order > kMost) {
      return Refuse("has order " + std::to_string(condition->order) +
                    " at a parameter that is found; allowed: 1 or 2");
    }
    return condition->order <= fit_.basis().degree() ||
           Refuse("needs degree " + std::to_string(condition->order) + " or more; found " +
                  std::to_string(fit_.basis().degree()));
  }

  /// Derivatives count by the parameter normalised to [0, 1].
  bool AddTangent(CurveCondition condition, std::vector<CurveCondition>* conditions) const {
    const int d = fit_.dimension();
    Eigen::RowVectorXd given;
    if (!GiveCoordinates(&given)) return false;
    if (d < 2) return Refuse("needs data of dimension 2 or more");
    if ((given.array() == kNotGiven).any()) return Refuse("needs all coordinates of the direction");
    const double largest = given.cwiseAbs().maxCoeff();
    if (!(largest > 0.0)) return Refuse("has a direction of length 0");
    const Eigen::VectorXd direction = (given / largest).normalized().transpose();
    const double length = fit_.basis().domain_length();
    condition.order = 1;
    condition.is_inequality = true;
    condition.value = options_.Real("least") * fit_.setting().size;
    SetDirection(length * direction, &condition);
    conditions->push_back(condition);
    if (free_number() == 0) return true;  // across it the constraint is linear
    condition.is_inequality = false;
    condition.value = 0.0;
    for (const Eigen::VectorXd& normal : NormalsOf(direction)) {
      SetDirection(length * normal, &condition);
      conditions->push_back(condition);
    }
    return true;
  }

  static void SetDirection(const Eigen::VectorXd& direction, CurveCondition* condition) {
    std::copy_n(direction.data(), direction.size(), condition->direction);
  }

  bool AddCurvature(CurveCondition condition, std::vector<CurveCondition>* conditions) const {
    const double kappa = options_.Real("kappa");
    if (fit_.dimension() < 2) return Refuse("needs data of dimension 2 or more");
    if (fit_.basis().degree() < 2) {
      return Refuse("needs degree 2 or more; found " + std::to_string(fit_.basis().degree()));
    }
    if (kappa == kNotGiven) return Refuse("has no kappa");
    if (fit_.dimension() > 2 && !(kappa > 0.0)) {
      return Refuse("needs kappa above 0: in space curvature has no sign, and a kink at 0");
    }
    condition.kind = Kind::kCurvature;
    condition.value = kappa / fit_.setting().scale;
    // A length, as all conditions: of bends tighter than the data's size relative to themselves.
    const double size = fit_.setting().size;
    condition.unit = size / std::max(1.0 / size, std::abs(condition.value));
    conditions->push_back(std::move(condition));
    return true;
  }

  const CurveFit& fit_;
  const NameSpec& spec_;
  OptionValues options_;
  std::string* error_;
};

/// Where the curve misses the conditions at one free parameter least, tried at a few places of
/// every span. Conditions that have no value anywhere leave it in the middle of the domain.
double BestPlace(const CurveFit& fit, const std::vector<CurveCondition>& conditions,
                 const Eigen::VectorXd& control_points) {
  const BsplineBasis& basis = fit.basis();
  constexpr int kPerSpan = 16;
  const int samples = kPerSpan * basis.num_domain_spans();
  double best = basis.domain_begin() + 0.5 * basis.domain_length();
  double least = std::numeric_limits<double>::infinity();
  std::vector<CurveCondition> here = conditions;
  for (int s = 0; s < samples; ++s) {
    const double t = basis.domain_begin() + (s + 0.5) / samples * basis.domain_length();
    for (CurveCondition& condition : here) {
      condition.t = t;
      condition.parameter_variable = -1;
    }
    Eigen::VectorXd h;
    const CurveConditionFamily family(fit.setting(), here);
    if (family.Residuals(control_points, &h) != Status::kOk) continue;
    double missed = 0.0;
    for (int k = 0; k < family.size(); ++k) {
      const double of_one = family.is_inequality(k) ? std::min(h[k], 0.0) : h[k];
      missed += of_one * of_one;
    }
    if (!(missed < least)) continue;
    least = missed;
    best = t;
  }
  return best;
}

}  // namespace

bool MakeCurveConditions(const std::vector<NameSpec>& specs, const CurveFit& fit, int num_variables,
                         const Eigen::VectorXd& control_points, CurveConditions* made,
                         std::string* error) {
  struct FreeParameter {
    double start = kNotGiven;
    std::vector<std::size_t> conditions;
  };
  std::map<int, FreeParameter> free;
  for (const NameSpec& spec : specs) {
    if (!IsAtAParameter(spec.name)) continue;
    OptionValues options;
    if (!ResolveConstraint(spec, &options, error)) return false;
    const ConditionBuilder builder(fit, spec, options, error);
    const std::size_t first = made->conditions.size();
    if (!builder.Build(&made->conditions)) return false;
    if (builder.free_number() == 0) continue;
    FreeParameter& parameter = free[builder.free_number()];
    if (parameter.start == kNotGiven && builder.given_t() != kNotGiven) {
      parameter.start = fit.basis().Wrap(builder.given_t());
    }
    for (std::size_t k = first; k < made->conditions.size(); ++k) {
      parameter.conditions.push_back(k);
    }
  }
  made->start.resize(static_cast<Eigen::Index>(free.size()));
  Eigen::Index place = 0;
  for (auto& [number, parameter] : free) {
    std::vector<CurveCondition> own;
    for (const std::size_t k : parameter.conditions) {
      own.push_back(made->conditions[k]);
      made->conditions[k].parameter_variable = num_variables + static_cast<int>(place);
    }
    made->start[place++] =
        parameter.start != kNotGiven ? parameter.start : BestPlace(fit, own, control_points);
  }
  return true;
}

}  // namespace batten
