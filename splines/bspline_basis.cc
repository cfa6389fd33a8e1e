#include "splines/bspline_basis.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

namespace batten {
namespace {

template <typename... Parts>
std::string Sentence(const Parts&... parts) {
  std::ostringstream stream;
  stream.precision(std::numeric_limits<double>::max_digits10);
  (stream << ... << parts);
  return stream.str();
}

std::string WhyBadNumbers(const std::vector<double>& knots) {
  const int num_knots = static_cast<int>(knots.size());
  for (int k = 0; k < num_knots; ++k) {
    if (!std::isfinite(knots[k])) {
      return Sentence("knot ", k, " is ", knots[k], ", knots must be finite");
    }
  }
  for (int k = 0; k + 1 < num_knots; ++k) {
    if (knots[k + 1] < knots[k]) {
      return Sentence("knot ", k + 1, " is ", knots[k + 1], ", below knot ", k, ", ", knots[k],
                      "; knots must not decrease");
    }
    // Basis functions divide by differences of knots: none may overflow, nor its reciprocal.
    const double step = knots[k + 1] - knots[k];
    if (step > 0.0 && !std::isfinite(1.0 / step)) {
      return Sentence("knots ", k, " and ", k + 1, " are ", step,
                      " apart, which is too little to divide by; make them equal or scale them up");
    }
  }
  if (!std::isfinite(knots.back() - knots.front())) {
    return Sentence("knots reach from ", knots.front(), " to ", knots.back(),
                    ", farther than a double can hold; scale them down");
  }
  return "";
}

std::string WhyBadMultiplicity(int degree, bool periodic, int last_domain_knot,
                               const std::vector<double>& knots) {
  const int num_knots = static_cast<int>(knots.size());
  const double begin = knots[degree];
  const double end = knots[last_domain_knot];
  for (int first = 0, last = 0; first < num_knots; first = last) {
    while (last < num_knots && knots[last] == knots[first]) ++last;
    // A periodic spline has no ends: its knots outside the domain are copies of inner ones.
    const bool inside = periodic || (begin < knots[first] && knots[first] < end);
    const int allowed = inside ? degree : degree + 1;
    if (last - first > allowed) {
      return Sentence("knot ", first, ", ", knots[first], ", stands ", last - first,
                      " times, must be at most ", allowed, " times",
                      inside ? " (the degree) inside the domain" : " (the order)");
    }
  }
  return "";
}

std::string WhyNotPeriodic(int degree, int n, const std::vector<double>& knots) {
  const double period = knots[n + degree] - knots[degree];
  const double size = std::max(std::abs(knots.front()), std::abs(knots.back()));
  const double tolerance = 8.0 * std::numeric_limits<double>::epsilon() * size;
  for (int k = 0; k <= 2 * degree; ++k) {
    const double step = knots[k + n] - knots[k];
    if (std::abs(step - period) > tolerance) {
      return Sentence("knots ", k, " and ", k + n, " are ", step, " apart, the period is ", period,
                      "; periodic knots must repeat with the period");
    }
  }
  return "";
}

}  // namespace

std::optional<BsplineBasis> BsplineBasis::Make(int degree, bool periodic, std::vector<double> knots,
                                               std::string* error) {
  const auto refuse = [error](const std::string& sentence) {
    if (error != nullptr) *error = sentence;
    return std::nullopt;
  };
  if (degree < 1 || degree > kMaxDegree) {
    return refuse(Sentence("degree is ", degree, ", must be 1 to ", kMaxDegree));
  }
  const std::size_t fewest = 2 * degree + 2;
  if (knots.size() < fewest || knots.size() > std::numeric_limits<int>::max()) {
    return refuse(Sentence("there are ", knots.size(), " knots, a",
                           periodic ? " periodic" : "n open", " spline of degree ", degree,
                           " needs at least ", fewest));
  }
  const int num_control_points =
      static_cast<int>(knots.size()) - (periodic ? 2 * degree + 1 : degree + 1);
  std::string why = WhyBadNumbers(knots);
  if (!why.empty()) return refuse(why);
  const int last_domain_knot = num_control_points + (periodic ? degree : 0);
  if (!(knots[degree] < knots[last_domain_knot])) {
    return refuse(Sentence("knots ", degree, " to ", last_domain_knot, " are all ", knots[degree],
                           "; the domain between them must not be empty"));
  }
  if (periodic) why = WhyNotPeriodic(degree, num_control_points, knots);
  if (why.empty()) why = WhyBadMultiplicity(degree, periodic, last_domain_knot, knots);
  if (!why.empty()) return refuse(why);
  return BsplineBasis(degree, periodic, std::move(knots), num_control_points);
}

int BsplineBasis::FindSpan(double t) const {
  const auto first = knots_.begin() + first_span();
  const auto end = knots_.begin() + last_span() + 1;
  // Looking for domain_end() from below skips the empty spans there; NaN lands there as well.
  const auto after = t < domain_end() ? std::upper_bound(first, end, std::max(t, domain_begin()))
                                      : std::lower_bound(first, end, domain_end());
  return static_cast<int>(after - knots_.begin()) - 1;
}

int BsplineBasis::FindSpanFrom(int hint, double t) const {
  // Beyond some ten knots a bisection of all is the faster way.
  constexpr int kMaxWalk = 10;
  int span = std::clamp(hint, first_span(), last_span());
  for (int step = 0; step < kMaxWalk; ++step) {
    if (t < knots_[span]) {
      if (span == first_span()) break;
      --span;
    } else if (t < knots_[span + 1]) {
      return span;
    } else {
      if (span == last_span()) break;
      ++span;
    }
  }
  return FindSpan(t);
}

double BsplineBasis::Wrap(double t) const {
  if (!periodic_) return std::clamp(t, domain_begin(), domain_end());
  if (t >= domain_begin() && t < domain_end()) return t;
  double offset = std::fmod(t - domain_begin(), domain_length());
  if (offset < 0.0) offset += domain_length();
  const double wrapped = domain_begin() + offset;
  // Just below the seam the sum rounds up to domain_end(), which is domain_begin() one turn on.
  return wrapped >= domain_end() ? domain_begin() : wrapped;
}

double BsplineBasis::Greville(int j) const {
  double sum = 0.0;
  for (int i = 1; i <= degree_; ++i) sum += knots_[j + i];
  // The mean of equal knots must not leave them by a rounding: at the ends that is off the domain.
  const double mean = std::clamp(sum / degree_, knots_[j + 1], knots_[j + degree_]);
  return periodic_ ? Wrap(mean) : mean;
}

}  // namespace batten
