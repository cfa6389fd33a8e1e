#include "solvers/paired_iteration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "problems/fit_problem.h"
#include "solvers/lanczos.h"
#include "splines/dense_eigenvalues.h"

namespace batten {
namespace {

/// Indices of `values` in increasing order of value.
std::vector<int> SortedOrder(const std::vector<double>& values) {
  std::vector<int> order(values.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return values[static_cast<std::size_t>(a)] < values[static_cast<std::size_t>(b)];
  });
  return order;
}

/// Shift s for which values a_i and b_(i+s), both sorted and on a circle, are closest in the sum of
/// squares around their mean difference, looked for near the shift that makes it zero.
int BestRotation(const std::vector<double>& a, const std::vector<double>& b, double period) {
  const auto n = static_cast<int>(a.size());
  int best = 0;
  double least = std::numeric_limits<double>::infinity();
  // Both are sorted on one period: rotations beyond the degree's reach are far off, yet with points
  // crowded in one place any can win, so all are tried for short lists.
  const int reach = n <= 2000 ? n / 2 + 1 : 64;
  for (int shift = -reach; shift <= reach; ++shift) {
    double sum = 0.0;
    for (int i = 0; i < n && sum < least; ++i) {
      const int k = ((i + shift) % n + n) % n;
      const double wraps = std::floor(static_cast<double>(i + shift) / n);
      const double difference =
          b[static_cast<std::size_t>(k)] + wraps * period - a[static_cast<std::size_t>(i)];
      sum += difference * difference;
    }
    if (sum < least || (sum == least && std::abs(shift) < std::abs(best))) {
      least = sum;
      best = shift;
    }
  }
  return best;
}

}  // namespace

std::vector<int> PairWithControlPoints(const BsplineBasis& basis,
                                       const std::vector<double>& parameters_by_row) {
  const auto n = static_cast<int>(parameters_by_row.size());
  std::vector<double> greville(static_cast<std::size_t>(n));
  for (int j = 0; j < n; ++j) greville[static_cast<std::size_t>(j)] = basis.Greville(j);
  const std::vector<int> rows = SortedOrder(parameters_by_row);
  const std::vector<int> controls = SortedOrder(greville);
  std::vector<double> a;
  std::vector<double> b;
  for (const int row : rows) a.push_back(parameters_by_row[static_cast<std::size_t>(row)]);
  for (const int j : controls) b.push_back(greville[static_cast<std::size_t>(j)]);
  const int shift = basis.periodic() ? BestRotation(a, b, basis.domain_length()) : 0;
  std::vector<int> result(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) {
    result[static_cast<std::size_t>(rows[static_cast<std::size_t>(i)])] =
        controls[static_cast<std::size_t>(((i + shift) % n + n) % n)];
  }
  return result;
}

std::vector<double> ParametersByRow(const Problem& problem) {
  const Sites& sites = *problem.curve_fit()->setting().data;
  std::vector<double> parameters(static_cast<std::size_t>(sites.size));
  for (int row = 0; row < sites.size; ++row) {
    parameters[static_cast<std::size_t>(row)] = sites.parameters[sites.item(row)];
  }
  return parameters;
}

double SpectralRadiusOf(const std::function<Points(const Points&)>& apply, int num_points,
                        std::uint64_t seed) {
  constexpr int kLargestDense = 300;
  if (num_points <= kLargestDense) {
    const Eigen::MatrixXd matrix = apply(Points::Identity(num_points, num_points));
    return EigenvalueSizes(matrix).maxCoeff();
  }
  Points v = RandomStart(num_points, seed).normalized();
  constexpr int kWarmUp = 200;
  constexpr int kCounted = 100;
  double growth = 0.0;
  for (int k = 0; k < kWarmUp + kCounted; ++k) {
    v = apply(v);
    const double norm = v.norm();
    if (!(norm > 0.0)) return 0.0;
    if (k >= kWarmUp) growth += std::log(norm) / kCounted;
    v /= norm;
  }
  return std::exp(growth);
}

std::string PairedIteration::WhyUnsupported(const Objective& objective) const {
  const std::string name = Info().name;
  std::string why = FurtherTerms::WhyNot(objective, name);
  if (!why.empty()) return why;
  const CurveFit& fit = *objective.problem().curve_fit();
  const auto m = std::to_string(fit.parameters().size());
  if (fit.parameters().size() != fit.basis().num_control_points()) {
    return name + " needs " + m + " control points for " + m + " points";
  }
  return "";
}

std::optional<Outcome> PairedIteration::DoStart(Eigen::VectorXd* /*x*/) {
  guard_.Reset();
  own_limit_.Reset();
  const Problem& problem = objective()->problem();
  std::optional<BandedRows> own;
  rows_ = PairedRows(FurtherTerms::InterpolationRows(objective(), &own),
                     PairWithControlPoints(problem.curve_fit()->basis(), ParametersByRow(problem)));
  terms_ = FurtherTerms(objective());
  if (has_further_terms()) {
    const std::vector<double> sums = terms_.RowSums();
    scale_ = Eigen::Map<const Eigen::ArrayXd>(sums.data(), rows_.size());
    // Rows of |B| sum to 1.
    scale_ = (1.0 + scale_).inverse();
  }
  if (std::optional<Outcome> outcome = Prepare()) return outcome;
  context()->OffTheClock([this] {
    const double radius = SpectralRadius();
    const std::string name = "spectral radius of " + MatrixName();
    context()->Note(name, NumberText(radius));
    // Of a singular A the radius is 1, which rounding may put below.
    constexpr double kRounding = 1e-9;
    if (radius >= 1.0 - kRounding) WarnOfDivergence("the " + name + " is " + NumberText(radius));
  });
  return std::nullopt;
}

Status PairedIteration::Map(const Eigen::VectorXd& x, Eigen::VectorXd* g_of_x) {
  if (!objective()->curve_view()->AllowProduct(x)) return Status::kStop;
  rows_.Residuals(x.data(), &moves_);
  if (has_further_terms()) {
    terms_.Pull(x.data(), &pull_);
    moves_ += pull_;
    moves_.array().colwise() *= scale_;
  }
  if (!moves_.allFinite()) return Status::kNonFinite;
  TurnIntoMoves(&moves_);
  *g_of_x = x + Eigen::Map<const Eigen::VectorXd>(moves_.data(), x.size());
  return Status::kOk;
}

/// Follows the Map of the same x.
std::optional<Outcome> PairedIteration::Inspect(const Eigen::VectorXd& x,
                                                const Eigen::VectorXd& /*g_of_x*/) {
  const double move = moves_.norm();
  if (has_further_terms() && own_limit_.Reached(move, x)) {
    return Outcome{
        StopReason::kNativeStop,
        "its steps are 1e-10 of the first one: it goes to its own limit, which is not the "
        "minimum of E: at each control point the residual balances the pull of the "
        "further terms"};
  }
  return guard_.Check(move);
}

std::vector<double> PairedIteration::State() const {
  std::vector<double> state;
  own_limit_.AppendTo(&state);
  guard_.AppendTo(&state);
  return state;
}

void PairedIteration::Restore(const std::vector<double>& state) {
  own_limit_.Restore(state.data());
  guard_.Restore(state.data() + 1);
}

PairedIteration::SparseRowMajor PairedIteration::Matrix() const {
  SparseRowMajor a = rows_.ToSparse();
  if (!has_further_terms()) return a;
  a += terms_.ToSparse();
  return scale_.matrix().asDiagonal() * a;
}

double PairedIteration::SpectralRadius() const {
  const SparseRowMajor a = Matrix();
  const auto apply = [&](const Points& v) {
    Points moved = -(a * v);
    TurnIntoMovesLinearly(&moved);
    return Points(v + moved);
  };
  return SpectralRadiusOf(apply, static_cast<int>(a.rows()), context()->seed());
}

}  // namespace batten
