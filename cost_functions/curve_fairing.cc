#include "cost_functions/curve_fairing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "cost_functions/functor_family.h"
#include "cost_functions/gauss_sites.h"

namespace batten {
namespace {

constexpr CurvatureMeasure kBending = CurvatureMeasure::kBending;
constexpr CurvatureMeasure kVariation = CurvatureMeasure::kVariation;

/// `scale_free`: the size of the data; `source`: 1 in the user's units.
double LengthUnit(const FitSetting& setting, const OptionValues& options) {
  return options.Word("units") == "scale_free" ? setting.size : setting.scale;
}
constexpr int LengthPower(CurvatureMeasure measure) { return measure == kBending ? 3 : 5; }

/// What makes the integral, an inverse length to the power 1 or 3, a squared length as E is.
template <CurvatureMeasure kMeasure>
double Factor(const FitSetting& setting, const OptionValues& options) {
  return std::pow(LengthUnit(setting, options), LengthPower(kMeasure));
}

/// What rounding of control points as large as the data leaves of the speed of a curve that crosses
/// them.
double LeastSpeed(const FitSetting& setting) {
  constexpr double kRoundings = 64.0 * std::numeric_limits<double>::epsilon();
  return kRoundings * setting.size / setting.basis->domain_length();
}

/// Whether products of four derivatives by the parameter are normal numbers: |N'| is at most
/// 2 p / h, h the length of the shortest span.
bool IsComputable(const BsplineBasis& basis) {
  double shortest = basis.domain_length();
  for (int span = basis.first_span(); span <= basis.last_span(); ++span) {
    const auto k = static_cast<std::size_t>(span);
    const double length = basis.knots()[k + 1] - basis.knots()[k];
    if (length > 0.0) shortest = std::min(shortest, length);
  }
  constexpr double kLargest = 1e60;
  return basis.domain_length() < kLargest && 2.0 * basis.degree() / shortest < kLargest;
}

/// Empty, or why a curve of this kind has no such integral.
std::string WhyNot(const FitSetting& setting, const OptionValues& options) {
  const BsplineBasis& basis = *setting.basis;
  const bool bending = options.Word("measure") == "bending";
  if (setting.dimension < 2) return "needs data of dimension 2 or more; a line has no curvature";
  const int lowest = bending ? 2 : 3;
  if (basis.degree() < lowest) {
    return "of measure " + options.Word("measure") + " needs degree " + std::to_string(lowest) +
           " or more, else curvature " + (bending ? "is infinite" : "jumps") +
           " at the knots; found " + std::to_string(basis.degree());
  }
  if (basis.periodic() && basis.num_control_points() < 3) {
    return "needs 3 control points of a closed curve, else it turns back on itself; found " +
           std::to_string(basis.num_control_points());
  }
  if (!IsComputable(basis)) {
    return "finds spans or a domain (length " + NumberText(basis.domain_length()) +
           ") whose powers leave the range of numbers; divide the parameters and knots by its "
           "length";
  }
  const double factor =
      bending ? Factor<kBending>(setting, options) : Factor<kVariation>(setting, options);
  constexpr double kSmallest = 1e-150;
  if (!(factor > kSmallest && factor < 1.0 / kSmallest)) {
    return "in source units leaves the range of numbers for data of this size; use "
           "units=scale_free";
  }
  return "";
}

class CurveFairingTerm final : public Term {
 public:
  TermInfo Info() const override { return CurveFairingResidual<kBending>::Info(); }
  std::unique_ptr<BlockFamily> MakeFamily(const FitSetting& setting, const OptionValues& options,
                                          std::string* error) const override {
    const std::string why = WhyNot(setting, options);
    if (!why.empty()) {
      *error = "term curve_fairing " + why;
      return nullptr;
    }
    return options.Word("measure") == "bending" ? Make<kBending>(setting, options)
                                                : Make<kVariation>(setting, options);
  }

 private:
  template <CurvatureMeasure kMeasure>
  static std::unique_ptr<BlockFamily> Make(const FitSetting& setting, const OptionValues& options) {
    using Functor = CurveFairingResidual<kMeasure>;
    return std::make_unique<FunctorFamily<Functor>>(
        setting, Functor(options, Factor<kMeasure>(setting, options), LeastSpeed(setting)),
        options.Real("weight"), MakeLoss(options, setting.size));
  }
};

}  // namespace

template <CurvatureMeasure kMeasure>
TermInfo CurveFairingResidual<kMeasure>::Info() {
  TermInfo info;
  info.name = "curve_fairing";
  info.summary = "integral of the squared curvature, or of its change, over the arc length";
  info.source =
      "Euler 1744; Horn, ACM TOMS 9, 1983; Moreton & Sequin, Computer Graphics 26 (SIGGRAPH), 1992";
  info.options = {
      OptionInfo::Word("measure", "bending", {"bending", "variation"},
                       "kappa^2 ds, or (d kappa / ds)^2 ds"),
      OptionInfo::Integer("points", 4, 1, 32,
                          "q of the Gauss rule in each span: the integral's error falls as the "
                          "power 2 q of the length of the spans"),
      OptionInfo::Word("units", "scale_free", {"scale_free", "source"},
                       "the integral times the power of the data's size that makes it a squared "
                       "length, or the integral as it is")};
  return info;
}

template <CurvatureMeasure kMeasure>
std::shared_ptr<const Sites> CurveFairingResidual<kMeasure>::MakeSites(
    const FitSetting& setting) const {
  return MakeGaussSites(setting, points, factor_);
}

ConstantSpeedFairing FairingOfConstantSpeed(const FitSetting& setting,
                                            const OptionValues& options) {
  const CurvatureMeasure measure = options.Word("measure") == "bending" ? kBending : kVariation;
  ConstantSpeedFairing made;
  made.fairing.name = "fairing";
  made.fairing.options = {{"derivative", measure == kBending ? "2" : "3"},
                          {"weight", NumberText(options.Real("weight"))}};
  made.unit = LengthUnit(setting, options);
  made.power = LengthPower(measure);
  return made;
}

std::unique_ptr<Term> MakeCurveFairingTerm() { return std::make_unique<CurveFairingTerm>(); }

}  // namespace batten
