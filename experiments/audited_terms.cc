#include "experiments/audited_terms.h"

#include <glog/logging.h>

#include <cmath>
#include <optional>

#include "cost_functions/bessel_tangents.h"
#include "cost_functions/end_options.h"
#include "cost_functions/term.h"

namespace batten {
namespace {

bool Resolve(const Problem::TermInstance& term, NameSpec* name, OptionValues* options) {
  const Term* registered = nullptr;
  std::string error;
  return ParseNameSpec(term.name, name, &error) &&
         TermRegistry::Global().Resolve(*name, &registered, options, &error);
}

AuditedLoss LossOf(const CurveFit& fit, const OptionValues& options) {
  using Kind = AuditedLoss::Kind;
  const std::string& loss = options.Word("loss");
  AuditedLoss made;
  made.scale = options.Real("loss_scale") * fit.size();
  if (loss == "huber") made.kind = Kind::kHuber;
  if (loss == "cauchy") made.kind = Kind::kCauchy;
  if (loss == "tukey") made.kind = Kind::kTukey;
  if (loss == "soft_l1") made.kind = Kind::kSoftL1;
  CHECK(made.kind != Kind::kNone || loss == "none") << loss;
  return made;
}

AuditedIntegral Integral(const CurveFit& fit, const OptionValues& options) {
  AuditedIntegral integral;
  integral.derivative = options.Integer("derivative");
  integral.factor = options.Real("weight");
  if (options.Word("units") == "scale_free") {
    integral.factor *= std::pow(fit.basis().domain_length(), 2 * integral.derivative - 1);
  }
  integral.span_factors = fit.spec().span_weights;
  return integral;
}

AuditedBending Bending(const CurveFit& fit, const OptionValues& options) {
  AuditedBending bending;
  bending.variation = options.Word("measure") == "variation";
  bending.points = options.Integer("points");
  bending.factor = options.Real("weight");
  if (options.Word("units") == "scale_free") {
    bending.factor *= std::pow(fit.size(), bending.variation ? 5 : 3);
  }
  bending.span_factors = fit.spec().span_weights;
  return bending;
}

/// The factor of the residual.
double Unit(const BsplineBasis& basis, int derivative, const OptionValues& options, bool at_end) {
  if (derivative == 0) return 1.0;
  if (options.Word("units") == "scale_free") return std::pow(basis.domain_length(), derivative);
  if (derivative == 2) return 1.0;
  const std::vector<double>& knots = basis.knots();
  const auto span = static_cast<std::size_t>(at_end ? basis.last_span() : basis.first_span());
  return (knots[span + 1] - knots[span]) / basis.degree();
}

AuditedEnd End(const CurveFit& fit, int derivative, const OptionValues& options, bool at_end) {
  std::optional<Eigen::RowVectorXd> value;
  if (derivative == 0) value = EndDatum(fit.setting(), at_end);
  if (derivative == 1) value = BesselTangent(fit.setting(), at_end);
  AuditedEnd end;
  end.at_end = at_end;
  end.derivative = derivative;
  const double unit = Unit(fit.basis(), derivative, options, at_end);
  // rho is of unit * (C^(k) - value): with b, s and rho go in proportion.
  end.factor = options.Real("weight") * unit * unit;
  end.loss = LossOf(fit, options);
  end.loss.scale /= unit;
  Eigen::RowVectorXd given;
  std::string beyond;
  GivenCoordinates(options, fit.dimension(), &given, &beyond);
  for (int c = 0; c < fit.dimension(); ++c) {
    const double otherwise = value.has_value() ? (*value)[c] : 0.0;
    end.value.push_back(given[c] == kNotGiven ? otherwise : given[c]);
  }
  return end;
}

}  // namespace

bool IsDistanceTerm(const Problem::TermInstance& term, const CurveFit& fit) {
  NameSpec name;
  std::string error;
  return ParseNameSpec(term.name, &name, &error) &&
         name.name == DistanceTermOf(fit.spec().parameter_kind);
}

bool AddTerms(const Problem& problem, AuditedFit* plain) {
  const CurveFit& fit = *problem.curve_fit();
  plain->distances.clear();
  for (const Problem::TermInstance& term : problem.terms()) {
    NameSpec name;
    OptionValues options;
    if (!Resolve(term, &name, &options)) return false;
    if (IsDistanceTerm(term, fit)) {
      plain->distances.push_back({options.Real("weight"), LossOf(fit, options)});
      continue;
    }
    const bool is_bending = name.name == "curve_fairing";
    if (name.name == "fairing" || is_bending) {
      if (term.family->loss() != nullptr) return false;
      if (is_bending) plain->bendings.push_back(Bending(fit, options));
      if (!is_bending) plain->integrals.push_back(Integral(fit, options));
      continue;
    }
    int derivative = -1;
    if (name.name == "end_point") derivative = 0;
    if (name.name == "end_tangent") derivative = 1;
    if (name.name == "end_curvature") derivative = 2;
    if (derivative < 0) return false;
    for (const bool at_end : {false, true}) {
      if (options.Word("end") == (at_end ? "begin" : "end")) continue;
      plain->ends.push_back(End(fit, derivative, options, at_end));
    }
  }
  return true;
}

}  // namespace batten
