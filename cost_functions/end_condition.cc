#include "cost_functions/end_condition.h"

#include <cmath>
#include <optional>
#include <vector>

#include "cost_functions/bessel_tangents.h"
#include "cost_functions/end_options.h"
#include "cost_functions/functor_family.h"

namespace batten {
namespace {

/// What the sites at the ends point into.
struct Ends {
  std::vector<double> parameters;
  std::vector<double> points;
  std::vector<double> weights;
};

template <int kDerivative>
class EndTerm final : public Term {
 public:
  TermInfo Info() const override { return EndResidual<kDerivative>::Info(); }

  std::unique_ptr<BlockFamily> MakeFamily(const FitSetting& setting, const OptionValues& options,
                                          std::string* error) const override {
    const BsplineBasis& basis = *setting.basis;
    if (basis.periodic()) {
      *error = "term " + Info().name + " needs an open curve; a closed one has no ends";
      return nullptr;
    }
    if (kDerivative > basis.degree()) {
      *error = "term " + Info().name + " needs degree " + std::to_string(kDerivative) +
               " or more; found " + std::to_string(basis.degree());
      return nullptr;
    }
    auto ends = std::make_shared<Ends>();
    auto sites = std::make_shared<Sites>();
    for (const bool at_end : {false, true}) {
      if (options.Word("end") == (at_end ? "begin" : "end")) continue;
      if (!AddEnd(setting, options, at_end, ends.get(), error)) return nullptr;
      const int span = at_end ? basis.FindSpan(basis.domain_end()) : basis.first_span();
      sites->groups.push_back({span, sites->size, sites->size + 1});
      ++sites->size;
    }
    if (sites->groups.size() == 2 && sites->groups[0].span == sites->groups[1].span) {
      sites->groups = {{sites->groups[0].span, 0, 2}};
    }
    sites->parameters = ends->parameters.data();
    sites->points = ends->points.data();
    sites->weights = ends->weights.data();
    sites->points_are_displacements = kDerivative > 0;
    sites->storage = std::move(ends);
    return std::make_unique<FunctorFamily<EndResidual<kDerivative>>>(
        setting, EndResidual<kDerivative>(std::move(sites)), options.Real("weight"),
        MakeLoss(options, setting.size));
  }

 private:
  static bool AddEnd(const FitSetting& setting, const OptionValues& options, bool at_end,
                     Ends* ends, std::string* error) {
    std::optional<Eigen::RowVectorXd> value = Eigen::RowVectorXd::Zero(setting.dimension).eval();
    if (kDerivative == 0) value = EndDatum(setting, at_end);
    if (kDerivative == 1) value = BesselTangent(setting, at_end);
    Eigen::RowVectorXd given;
    std::string beyond;
    if (!GivenCoordinates(options, setting.dimension, &given, &beyond)) {
      *error = "term " + EndResidual<kDerivative>::Info().name + ": " + beyond +
               " is given, but the data have dimension " + std::to_string(setting.dimension);
      return false;
    }
    for (int c = 0; c < setting.dimension; ++c) {
      if (given[c] == kNotGiven) continue;
      if (!value.has_value()) value = Eigen::RowVectorXd::Zero(setting.dimension).eval();
      (*value)[c] = given[c];
    }
    if (!value.has_value()) {
      *error = "term " + EndResidual<kDerivative>::Info().name +
               " finds no Bessel tangent: all parameters are equal; give x, y, ... instead";
      return false;
    }
    ends->parameters.push_back(at_end ? setting.basis->domain_end()
                                      : setting.basis->domain_begin());
    ends->points.insert(ends->points.end(), value->data(), value->data() + value->size());
    const double unit = Unit(*setting.basis, options, at_end);
    ends->weights.push_back(unit * unit);
    return true;
  }

  static double Unit(const BsplineBasis& basis, const OptionValues& options, bool at_end) {
    if (kDerivative == 0) return 1.0;
    if (options.Word("units") == "scale_free") return std::pow(basis.domain_length(), kDerivative);
    if (kDerivative != 1) return 1.0;
    const std::vector<double>& u = basis.knots();
    const auto k = static_cast<std::size_t>(at_end ? basis.last_span() : basis.first_span());
    return (u[k + 1] - u[k]) / basis.degree();
  }
};

OptionInfo UnitsOption(const std::string& source) {
  return OptionInfo::Word("units", "scale_free", {"scale_free", "source"},
                          "residual times powers of the domain's length, or " + source);
}

}  // namespace

template <int kDerivative>
TermInfo EndResidual<kDerivative>::Info() {
  TermInfo info;
  info.affine = true;
  info.options = {EndOption()};
  if (kDerivative == 0) {
    info.name = "end_point";
    info.summary = "distance of the curve's ends from the first and last data point";
    info.source = "Piegl & Tiller, The NURBS Book, sec. 9.2";
    AddCoordinateOptions(" of the point instead", &info.options);
  } else if (kDerivative == 1) {
    info.name = "end_tangent";
    info.summary = "difference of the derivative at the ends from Bessel's or a given one";
    info.source = "Farin, Curves and Surfaces for CAGD, sec. 9.8; Lan Hao 2008";
    info.options.push_back(UnitsOption("times the knot difference over the degree"));
    AddCoordinateOptions(" of the derivative instead", &info.options);
  } else {
    info.name = "end_curvature";
    info.summary = "difference of the second derivative at the ends from zero or a given one";
    info.source = "de Boor, A Practical Guide to Splines, ch. IV";
    info.options.push_back(UnitsOption("as it is"));
    AddCoordinateOptions(" of the second derivative instead", &info.options);
  }
  return info;
}

std::unique_ptr<Term> MakeEndPointTerm() { return std::make_unique<EndTerm<0>>(); }
std::unique_ptr<Term> MakeEndTangentTerm() { return std::make_unique<EndTerm<1>>(); }
std::unique_ptr<Term> MakeEndCurvatureTerm() { return std::make_unique<EndTerm<2>>(); }

}  // namespace batten
