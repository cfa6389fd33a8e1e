#include "problems/curve_constraints.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "cost_functions/bessel_tangents.h"
#include "cost_functions/end_options.h"
#include "problems/curve_directions.h"
#include "problems/fit_problem.h"
#include "splines/basis_functions.h"

namespace batten {
namespace {

constexpr double kLargest = 1e150;

OptionInfo ParameterOption() {
  return OptionInfo::Real("t", kNotGiven, -kLargest, kNotGiven, "parameter, in the domain");
}

OptionInfo FreeOption() {
  return OptionInfo::Integer("free", 0, 0, 99,
                             "number of a parameter that is found, the same for all constraints "
                             "with this number; 0: t is given");
}

std::vector<OptionInfo> WithCoordinates(std::vector<OptionInfo> options) {
  AddCoordinateOptions("", &options);
  return options;
}

/// One linear functional of the curve: sum of factor * C^(order)(parameter).
struct Functional {
  struct Part {
    double factor;
    double parameter;
    int order;
    int span;
  };
  std::string name;
  std::vector<Part> parts;
  /// Not empty: one equation, of the sum of the coordinates with these factors, to be 0.
  Eigen::RowVectorXd across;
  Eigen::RowVectorXd value;       ///< Infinite: that coordinate stays free.
  bool value_is_a_point = false;  ///< Else a derivative, which moving the origin does not change.
};

class Builder {
 public:
  Builder(const CurveFit& fit, const NameSpec& spec, OptionValues options, std::string* error)
      : fit_(fit), basis_(fit.basis()), spec_(spec), options_(std::move(options)), error_(error) {}

  bool Build() {
    if (IsAtAParameter(spec_.name) && options_.Integer("free") > 0) return true;  // not linear
    if (spec_.name == "curvature") return true;
    if (spec_.name == "tangent") return AddTangent();
    if (spec_.name == "point") return AddAt(0);
    if (spec_.name == "derivative") return AddAt(options_.Integer("order"));
    if (basis_.periodic()) {
      return Refuse("needs an open curve; a closed one has no ends");
    }
    if (spec_.name == "ends") return AddEnds(0);
    if (spec_.name == "natural") return AddEnds(2);
    if (spec_.name == "clamped") return AddEnds(1);
    if (spec_.name == "not-a-knot") return AddNotAKnot();
    return AddPeriodic();
  }

  void Append(std::vector<LinearConstraint>* constraints) const {
    for (const Functional& functional : functionals_) {
      if (functional.across.size() > 0) {
        constraints->push_back(Across(functional));
        continue;
      }
      for (int c = 0; c < fit_.dimension(); ++c) {
        if (functional.value[c] == kNotGiven) continue;
        constraints->push_back(Constraint(functional, c));
      }
    }
  }

 private:
  bool Refuse(const std::string& why) const {
    *error_ = "constraint " + spec_.ToString() + " " + why;
    return false;
  }

  /// Overwrites what the options x, y, ... give; false if one is not a coordinate of the data.
  bool TakeCoordinates(Eigen::RowVectorXd* value) const {
    Eigen::RowVectorXd given;
    std::string beyond;
    if (!GivenCoordinates(options_, fit_.dimension(), &given, &beyond)) {
      return Refuse("gives " + beyond + ", but the data have dimension " +
                    std::to_string(fit_.dimension()));
    }
    for (int c = 0; c < fit_.dimension(); ++c) {
      if (given[c] != kNotGiven) (*value)[c] = given[c];
    }
    return true;
  }

  bool CheckOrder(int order) const {
    if (order <= basis_.degree()) return true;
    return Refuse("needs degree " + std::to_string(order) + " or more; found " +
                  std::to_string(basis_.degree()));
  }

  bool AddAt(int order) {
    double t = options_.Real("t");
    const double begin = basis_.domain_begin();
    const double end = basis_.domain_end();
    if (!(t >= begin && t <= end)) {
      const std::string found = t == kNotGiven ? "has no t" : "has t = " + NumberText(t);
      return Refuse(found + "; allowed: " + NumberText(begin) + " to " + NumberText(end));
    }
    t = basis_.Wrap(t);
    Functional functional;
    functional.value.setConstant(fit_.dimension(), kNotGiven);
    if (!CheckOrder(order) || !TakeCoordinates(&functional.value)) return false;
    if ((functional.value.array() == kNotGiven).all()) {
      return Refuse("holds nothing; give at least one of x, y, z, w");
    }
    functional.name = spec_.ToString();
    functional.parts = {{1.0, t, order, basis_.FindSpan(t)}};
    functional.value_is_a_point = order == 0;
    functionals_.push_back(std::move(functional));
    return true;
  }

  /// C'(t) has no part across the direction; along it an inequality holds it.
  bool AddTangent() {
    CurveConditions along;
    if (!MakeCurveConditions({spec_}, fit_, 0, Eigen::VectorXd(), &along, error_)) return false;
    Eigen::VectorXd direction(fit_.dimension());
    for (int c = 0; c < fit_.dimension(); ++c) {
      direction[c] = along.conditions.front().direction[c];
    }
    const double t = along.conditions.front().t;
    for (const Eigen::VectorXd& normal : NormalsOf(direction)) {
      Functional functional;
      functional.name = spec_.ToString();
      functional.parts = {{1.0, t, 1, basis_.FindSpan(t)}};
      functional.across = normal.transpose();
      functionals_.push_back(std::move(functional));
    }
    return true;
  }

  bool AddEnds(int order) {
    if (!CheckOrder(order)) return false;
    for (const bool at_end : {false, true}) {
      if (options_.Word("end") == (at_end ? "begin" : "end")) continue;
      Functional functional;
      functional.name = spec_.ToString() + (at_end ? " at the end" : " at the begin");
      functional.value_is_a_point = order == 0;
      if (!EndValue(order, at_end, &functional.value)) return false;
      const double t = at_end ? basis_.domain_end() : basis_.domain_begin();
      functional.parts = {{1.0, t, order, basis_.FindSpan(t)}};
      functionals_.push_back(std::move(functional));
    }
    return true;
  }

  bool EndValue(int order, bool at_end, Eigen::RowVectorXd* value) const {
    const auto last = fit_.data().points.rows() - 1;
    *value = Eigen::RowVectorXd::Zero(fit_.dimension());
    if (order == 0) *value = fit_.data().points.row(at_end ? last : 0);
    if (order != 1) return true;
    const std::optional<Eigen::RowVectorXd> bessel = BesselTangent(fit_.setting(), at_end);
    if (bessel.has_value()) {
      *value = *bessel;
    } else {
      value->setConstant(kNotGiven);
    }
    if (!TakeCoordinates(value)) return false;
    return (value->array() != kNotGiven).all() ||
           Refuse("finds no Bessel tangent: all parameters are equal; give x, y, ... instead");
  }

  bool AddNotAKnot() {
    const std::vector<double>& u = basis_.knots();
    const int first = basis_.FindSpan(basis_.domain_begin());
    const int last = basis_.FindSpan(basis_.domain_end());
    if (first == last) return Refuse("needs a knot inside the domain; found none");
    const int p = basis_.degree();
    for (const bool at_end : {false, true}) {
      if (options_.Word("end") == (at_end ? "begin" : "end")) continue;
      // The knot between the first two spans, or the last two.
      const double knot = u[static_cast<std::size_t>(at_end ? last : first + 1)];
      Functional functional;
      functional.name = spec_.ToString() + (at_end ? " at the end" : " at the begin");
      functional.value.setZero(fit_.dimension());
      const int right = basis_.FindSpan(knot);
      int left = right - 1;
      while (!(u[static_cast<std::size_t>(left)] < knot)) --left;
      functional.parts = {{1.0, knot, p, right}, {-1.0, knot, p, left}};
      functionals_.push_back(std::move(functional));
    }
    return true;
  }

  bool AddPeriodic() {
    for (int order = 0; order < basis_.degree(); ++order) {
      Functional functional;
      functional.name = spec_.ToString() + " in derivative " + std::to_string(order);
      functional.value.setZero(fit_.dimension());
      const double begin = basis_.domain_begin();
      const double end = basis_.domain_end();
      functional.parts = {{1.0, begin, order, basis_.FindSpan(begin)},
                          {-1.0, end, order, basis_.FindSpan(end)}};
      functionals_.push_back(std::move(functional));
    }
    return true;
  }

  /// In the fit's own variables, which are scaled; divided by the largest coefficient, so that
  /// derivatives on short spans count like points.
  LinearConstraint Constraint(const Functional& functional, int c) const {
    LinearConstraint constraint;
    constraint.name = functional.name + " (" + kCoordinateNames[c] + ")";
    std::map<int, double> coefficients;
    double values[(kMaxDegree + 1) * kMaxOrder];
    for (const Functional::Part& part : functional.parts) {
      EvaluateBasisDerivatives(basis_.degree(), basis_.knots().data(), part.span, part.parameter,
                               part.order, values);
      for (int j = 0; j <= basis_.degree(); ++j) {
        const int point = basis_.ControlPointIndex(part.span - basis_.degree() + j);
        coefficients[point] += part.factor * values[part.order * basis_.order() + j];
      }
    }
    double largest = 0.0;
    for (const auto& entry : coefficients) largest = std::max(largest, std::abs(entry.second));
    const FitSetting& setting = fit_.setting();
    const double origin = functional.value_is_a_point ? setting.center[c] : 0.0;
    constraint.value = (functional.value[c] - origin) * setting.scale / largest;
    for (const auto& [point, coefficient] : coefficients) {
      if (coefficient == 0.0) continue;
      constraint.coefficients.emplace_back(
          setting.control_point_offset + point * fit_.dimension() + c, coefficient / largest);
    }
    return constraint;
  }

  LinearConstraint Across(const Functional& functional) const {
    LinearConstraint sum;
    sum.name = functional.name;
    Functional of_coordinate = functional;
    of_coordinate.value.setZero(fit_.dimension());
    for (int c = 0; c < fit_.dimension(); ++c) {
      if (functional.across[c] == 0.0) continue;
      for (const auto& [variable, factor] : Constraint(of_coordinate, c).coefficients) {
        sum.coefficients.emplace_back(variable, functional.across[c] * factor);
      }
    }
    return sum;
  }

  const CurveFit& fit_;
  const BsplineBasis& basis_;
  const NameSpec& spec_;
  OptionValues options_;
  std::string* error_;
  std::vector<Functional> functionals_;
};

}  // namespace

bool IsAtAParameter(const std::string& name) {
  return name == "point" || name == "derivative" || name == "tangent" || name == "curvature";
}

bool ResolveConstraint(const NameSpec& spec, OptionValues* options, std::string* error) {
  std::vector<std::string> names;
  for (const ConstraintInfo& info : KnownConstraints()) {
    names.push_back(info.name);
    if (info.name != spec.name) continue;
    if (spec.wrapped != nullptr) {
      *error = "constraint " + spec.name + " wraps nothing; found :" + spec.wrapped->ToString();
      return false;
    }
    return ResolveOptions(info.options, spec, options, error);
  }
  *error = UnknownNameMessage("constraint", spec.name, names);
  return false;
}

std::vector<ConstraintInfo> KnownConstraints() {
  return {
      {"point", "the curve passes a point at a parameter",
       WithCoordinates({ParameterOption(), FreeOption()})},
      {"derivative", "a derivative at a parameter",
       WithCoordinates({ParameterOption(), FreeOption(),
                        OptionInfo::Integer("order", 1, 1, kMaxDegree,
                                            "order of the derivative; with free at most 2")})},
      {"tangent", "the direction of the curve at a parameter",
       WithCoordinates({ParameterOption(), FreeOption(),
                        OptionInfo::Real("least", 1e-3, 1e-9, 1e9,
                                         "least |C'|, in parts of the data's size over the "
                                         "length of the domain")})},
      {"curvature",
       "the curvature at a parameter, signed in the plane",
       {ParameterOption(), FreeOption(),
        OptionInfo::Real("kappa", kNotGiven, -kLargest, kNotGiven,
                         "one over the radius, in the unit of the data; inf: not given")}},
      {"ends", "the curve begins and ends in the first and last data point", {EndOption()}},
      {"natural", "no second derivative at the ends", {EndOption()}},
      {"clamped", "Bessel's or a given derivative at the ends", WithCoordinates({EndOption()})},
      {"not-a-knot", "no jump at the first and last inner knot", {EndOption()}},
      {"periodic", "the same value and derivatives at both ends", {}},
  };
}

bool CheckConstraint(const NameSpec& spec, std::string* error) {
  OptionValues options;
  return ResolveConstraint(spec, &options, error);
}

bool AppendCurveConstraints(const std::vector<NameSpec>& specs, const CurveFit& fit,
                            std::vector<LinearConstraint>* constraints, std::string* error) {
  for (const NameSpec& spec : specs) {
    OptionValues options;
    if (!ResolveConstraint(spec, &options, error)) return false;
    Builder builder(fit, spec, options, error);
    if (!builder.Build()) return false;
    builder.Append(constraints);
  }
  return true;
}

}  // namespace batten
