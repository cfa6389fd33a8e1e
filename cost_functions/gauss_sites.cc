#include "cost_functions/gauss_sites.h"

#include <utility>
#include <vector>

#include "splines/gauss_legendre.h"

namespace batten {
namespace {

/// What sites point into.
struct Quadrature {
  std::vector<double> parameters;
  std::vector<double> weights;
};

}  // namespace

std::shared_ptr<const Sites> MakeGaussSites(const FitSetting& setting, int points, double factor) {
  const BsplineBasis& basis = *setting.basis;
  const GaussRule rule = GaussLegendreRule(points);
  auto quadrature = std::make_shared<Quadrature>();
  auto sites = std::make_shared<Sites>();
  for (int span = basis.first_span(); span <= basis.last_span(); ++span) {
    const double begin = basis.knots()[static_cast<std::size_t>(span)];
    const double length = basis.knots()[static_cast<std::size_t>(span) + 1] - begin;
    if (!(length > 0.0)) continue;
    const auto first = static_cast<int>(quadrature->parameters.size());
    const double of_span = setting.span_weights == nullptr
                               ? factor
                               : factor * (*setting.span_weights)[sites->groups.size()];
    for (std::size_t g = 0; g < rule.nodes.size(); ++g) {
      quadrature->parameters.push_back(begin + 0.5 * (1.0 + rule.nodes[g]) * length);
      quadrature->weights.push_back(0.5 * rule.weights[g] * length * of_span);
    }
    sites->groups.push_back({span, first, static_cast<int>(quadrature->parameters.size())});
  }
  sites->size = static_cast<int>(quadrature->parameters.size());
  sites->parameters = quadrature->parameters.data();
  sites->weights = quadrature->weights.data();
  sites->storage = std::move(quadrature);
  return sites;
}

}  // namespace batten
