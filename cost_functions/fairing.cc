#include "cost_functions/fairing.h"

#include <algorithm>
#include <cmath>

#include "cost_functions/functor_family.h"
#include "cost_functions/gauss_sites.h"

namespace batten {
namespace {

/// L^(2k - 1), L the length of the domain: d^k C / dv^k = L^k C^(k) for v = u / L, and dv = du / L.
double ScaleFreeFactor(const BsplineBasis& basis, int derivative) {
  return std::pow(basis.domain_length(), 2 * derivative - 1);
}

class FairingTerm final : public Term {
 public:
  TermInfo Info() const override { return FairingResidual<2>::Info(); }
  std::unique_ptr<BlockFamily> MakeFamily(const FitSetting& setting, const OptionValues& options,
                                          std::string* error) const override {
    const int k = options.Integer("derivative");
    if (k > setting.basis->degree()) {
      *error = "term fairing: derivative is " + std::to_string(k) +
               ", but that of a curve of degree " + std::to_string(setting.basis->degree()) +
               " is zero; allowed: 1 to " + std::to_string(std::min(setting.basis->degree(), 3));
      return nullptr;
    }
    if (!IsComputable(*setting.basis, k, options.Word("units") == "scale_free")) {
      *error = "term fairing: derivative " + std::to_string(k) + " over a domain of length " +
               NumberText(setting.basis->domain_length()) +
               " leaves the range of numbers; divide the parameters and knots by its length";
      return nullptr;
    }
    if (k == 1) return Make<1>(setting, options);
    if (k == 2) return Make<2>(setting, options);
    return Make<3>(setting, options);
  }

 private:
  template <int kDerivative>
  static std::unique_ptr<BlockFamily> Make(const FitSetting& setting, const OptionValues& options) {
    return std::make_unique<FunctorFamily<FairingResidual<kDerivative>>>(
        setting, FairingResidual<kDerivative>(options), options.Real("weight"),
        MakeLoss(options, setting.size));
  }

  /// Whether derivatives, weights and their products are normal numbers: |N^(k)| is at most
  /// (2 p / h)^k, h the length of the shortest span.
  static bool IsComputable(const BsplineBasis& basis, int k, bool scale_free) {
    double shortest = basis.domain_length();
    for (int span = basis.first_span(); span <= basis.last_span(); ++span) {
      const double length = basis.knots()[static_cast<std::size_t>(span) + 1] -
                            basis.knots()[static_cast<std::size_t>(span)];
      if (length > 0.0) shortest = std::min(shortest, length);
    }
    const double factor = scale_free ? ScaleFreeFactor(basis, k) : 1.0;
    const double derivative = std::pow(2.0 * basis.degree() / shortest, k);
    const double weights[] = {shortest * factor, basis.domain_length() * factor};
    const auto is_normal = [](double number) {
      constexpr double kSmallest = 1e-280;  // leaves squares of rounding errors their digits
      return number > kSmallest && number < 1.0 / kSmallest;
    };
    return is_normal(weights[0]) && is_normal(weights[1]) && is_normal(derivative) &&
           is_normal(weights[0] * derivative * derivative);
  }
};

}  // namespace

template <int kDerivative>
TermInfo FairingResidual<kDerivative>::Info() {
  TermInfo info;
  info.name = "fairing";
  info.summary = "integral of the squared derivative of order 1, 2 or 3 over the curve, exactly";
  info.source =
      "Schoenberg, Proc. Nat. Acad. Sci. 52, 1964; de Boor, A Practical Guide to Splines, ch. XIV";
  info.affine = true;
  info.options = {OptionInfo::Integer("derivative", 2, 1, 3,
                                      "order k of the derivative: 1 draws the curve to a point, "
                                      "2 to a straight line, 3 to a parabola"),
                  OptionInfo::Word("units", "scale_free", {"scale_free", "source"},
                                   "the integral over the parameter normalised to [0, 1], or over "
                                   "the parameter as it is")};
  return info;
}

template <int kDerivative>
std::shared_ptr<const Sites> FairingResidual<kDerivative>::MakeSites(
    const FitSetting& setting) const {
  const BsplineBasis& basis = *setting.basis;
  const double factor = scale_free ? ScaleFreeFactor(basis, kDerivative) : 1.0;
  return MakeGaussSites(setting, basis.degree() - kDerivative + 1, factor);
}

std::unique_ptr<Term> MakeFairingTerm() { return std::make_unique<FairingTerm>(); }

}  // namespace batten
