#include "splines/knot_rules.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>

namespace batten {
namespace {

constexpr KnotRule kAllRules[] = {KnotRule::kUniform, KnotRule::kAveraged};

std::string WhyBadSetting(int degree, int n, EndKnots ends, double begin, double end) {
  std::ostringstream why;
  const int fewest = ends == EndKnots::kPeriodic ? 1 : degree + 1;
  if (degree < 1 || degree > kMaxDegree) {
    why << "degree is " << degree << ", must be 1 to " << kMaxDegree;
  } else if (n < fewest) {
    why << "there are " << n << " control points, degree " << degree << " needs at least "
        << fewest;
  } else if (!(begin < end) || !std::isfinite(end - begin)) {
    why << "the domain is [" << begin << ", " << end << "], must be finite and not empty";
  }
  return why.str();
}

std::string WhyBadParameters(double begin, double end, const Eigen::VectorXd& parameters) {
  std::ostringstream why;
  if (parameters.size() == 0) why << "there are no parameters to average knots from";
  double previous = begin;
  for (Eigen::Index i = 0; i < parameters.size() && why.tellp() == 0; ++i) {
    if (!(parameters[i] >= begin && parameters[i] <= end)) {
      why << "parameter " << i << " is " << parameters[i] << ", must be in [" << begin << ", "
          << end << "]";
    } else if (parameters[i] < previous) {
      why << "parameter " << i << " is " << parameters[i] << ", below its predecessor, " << previous
          << "; parameters must not decrease";
    }
    previous = parameters[i];
  }
  return why.str();
}

/// The map i -> t_i, linear between integers, at numerator / denominator (>= 0). In integers
/// because 3 * (m / 3.0) may fall short of m. With a period > 0 the map goes on beyond t_(m-1).
double ParameterAt(const Eigen::VectorXd& parameters, std::int64_t numerator,
                   std::int64_t denominator, double period) {
  const std::int64_t m = parameters.size();
  const auto at = [&](std::int64_t i) {
    if (period == 0.0) return parameters[i];
    // begin + (end - begin) may round to below end, and the map would step back at the seam.
    const std::int64_t turns = i / m;
    return std::min(parameters[i % m], parameters[0] + period) +
           static_cast<double>(turns) * period;
  };
  const std::int64_t i = numerator / denominator;
  const std::int64_t rest = numerator % denominator;
  if (rest == 0) return at(i);
  const double fraction = static_cast<double>(rest) / static_cast<double>(denominator);
  return std::min(at(i) + fraction * (at(i + 1) - at(i)), at(i + 1));
}

/// u_(p+1)..u_(n-1) of open knots.
std::vector<double> AveragedInnerKnots(int degree, int n, const Eigen::VectorXd& parameters) {
  const std::int64_t m = parameters.size();
  const int num_spans = n - degree;
  std::vector<double> inner;
  if (m > n) {
    for (std::int64_t j = 1; j < num_spans; ++j) {
      inner.push_back(ParameterAt(parameters, j * m - num_spans, num_spans, 0.0));
    }
    return inner;
  }
  Eigen::VectorXd refined(n);
  for (std::int64_t i = 0; i < n; ++i) {
    refined[i] = ParameterAt(parameters, i * (m - 1), n - 1, 0.0);
  }
  for (int j = 1; j < num_spans; ++j) {
    // One after the other: each sum then is no smaller than the one before, roundings included.
    double sum = 0.0;
    for (int i = 0; i < degree; ++i) sum += refined[j + i];
    // By rounding the mean of equal parameters may leave them, and the domain with them.
    inner.push_back(std::clamp(sum / degree, refined[j], refined[j + degree - 1]));
  }
  return inner;
}

/// Knots u_0..u_(n+p) around the spans' ends u_p..u_n.
std::vector<double> WithOuterKnots(int degree, EndKnots ends, const std::vector<double>& domain) {
  const bool floating = ends == EndKnots::kFloating;
  const double first_step = floating ? domain[1] - domain[0] : 0.0;
  const double last_step = floating ? domain.back() - domain[domain.size() - 2] : 0.0;
  std::vector<double> knots;
  for (int i = degree; i >= 1; --i) knots.push_back(domain.front() - i * first_step);
  knots.insert(knots.end(), domain.begin(), domain.end());
  for (int i = 1; i <= degree; ++i) knots.push_back(domain.back() + i * last_step);
  return knots;
}

/// Knots u_0..u_(n+2p) that repeat u_p..u_(n+p-1), each the sum of one of these and whole periods.
std::vector<double> WithRepeatedKnots(int degree, const std::vector<double>& turn, double period) {
  const int n = static_cast<int>(turn.size());
  std::vector<double> knots;
  for (int k = -degree; k <= n + degree; ++k) {
    const int turns = k >= 0 ? k / n : -((n - 1 - k) / n);
    knots.push_back(turn[k - turns * n] + turns * period);
  }
  return knots;
}

std::string WhyTooManyEqual(int degree, EndKnots ends, const std::vector<double>& knots) {
  std::string why;
  const bool periodic = ends == EndKnots::kPeriodic;
  if (!BsplineBasis::Make(degree, periodic, knots, &why)) return "averaged " + why;
  if (ends != EndKnots::kFloating) return "";
  // The basis allows p + 1 equal knots at an end; of floating ones no function would be left there.
  for (std::size_t k = 0; k + degree < knots.size(); ++k) {
    if (knots[k] == knots[k + degree]) {
      std::ostringstream sentence;
      sentence << "averaged knot " << k << ", " << knots[k] << ", stands more than " << degree
               << " times; use fewer control points or distinct parameters";
      return sentence.str();
    }
  }
  return "";
}

}  // namespace

const char* ToString(KnotRule rule) {
  switch (rule) {
    case KnotRule::kUniform:
      return "uniform";
    case KnotRule::kAveraged:
      return "averaged";
  }
  return "unknown";
}

bool FromString(const std::string& text, KnotRule* rule) {
  for (const KnotRule known : kAllRules) {
    if (text == ToString(known)) {
      *rule = known;
      return true;
    }
  }
  return false;
}

std::vector<double> UniformKnots(int degree, int num_control_points, EndKnots ends, double begin,
                                 double end) {
  if (!WhyBadSetting(degree, num_control_points, ends, begin, end).empty()) return {};
  const bool periodic = ends == EndKnots::kPeriodic;
  const int num_spans = periodic ? num_control_points : num_control_points - degree;
  std::vector<double> domain;
  for (int i = 0; i < num_spans; ++i) domain.push_back(begin + (end - begin) * i / num_spans);
  if (periodic) return WithRepeatedKnots(degree, domain, end - begin);
  domain.push_back(end);
  std::vector<double> knots = WithOuterKnots(degree, EndKnots::kEndInterpolating, domain);
  if (ends == EndKnots::kEndInterpolating) return knots;
  for (int i = 1; i <= degree; ++i) {
    const double reach = (end - begin) * i / num_spans;
    knots[degree - i] = begin - reach;
    knots[num_control_points + i] = end + reach;
  }
  return knots;
}

std::vector<double> AveragedKnots(int degree, int num_control_points, EndKnots ends, double begin,
                                  double end, const Eigen::VectorXd& parameters,
                                  std::string* error) {
  const auto refuse = [error](const std::string& sentence) {
    if (error != nullptr) *error = sentence;
    return std::vector<double>();
  };
  std::string why = WhyBadSetting(degree, num_control_points, ends, begin, end);
  if (why.empty()) why = WhyBadParameters(begin, end, parameters);
  if (!why.empty()) return refuse(why);

  std::vector<double> knots;
  if (ends == EndKnots::kPeriodic) {
    const std::int64_t half_steps = degree % 2 == 0 ? 1 : 0;
    const std::int64_t n = num_control_points;
    for (std::int64_t j = 0; j < n; ++j) {
      knots.push_back(
          ParameterAt(parameters, (2 * j + half_steps) * parameters.size(), 2 * n, end - begin));
    }
    knots = WithRepeatedKnots(degree, knots, end - begin);
  } else {
    std::vector<double> domain = AveragedInnerKnots(degree, num_control_points, parameters);
    domain.insert(domain.begin(), begin);
    domain.push_back(end);
    knots = WithOuterKnots(degree, ends, domain);
  }
  why = WhyTooManyEqual(degree, ends, knots);
  return why.empty() ? knots : refuse(why);
}

}  // namespace batten
