#include "solvers/gim.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "problems/fit_problem.h"
#include "solvers/lanczos.h"

namespace batten {
namespace {

/// Without options.
std::string NameOf(const std::string& term) { return term.substr(0, term.find('/')); }

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

SolverInfo GimSolver::ClassInfo() {
  SolverInfo info;
  info.name = "gim";
  info.summary =
      "geometric iteration (PIA): each control point moves by the residual paired with it";
  info.source = "Qi et al. 1975; de Boor 1979; Lin, Wang & Dong 2004; Lin, Bao & Wang 2005";
  info.needs = {"compiled rows", "only the interpolation term without weights",
                "as many control points as points"};
  info.native_rule = NativeRule::kStep;
  return info;
}

std::string GimSolver::WhyUnsupported(const Objective& objective) const {
  std::string why = WhyNoCurveView(objective, "gim");
  if (why.empty()) why = WhyNoBounds(objective, "gim");
  if (!why.empty()) return why;
  const Problem& problem = objective.problem();
  const CurveFit* fit = problem.curve_fit();
  if (fit == nullptr || problem.terms().size() != 1 || problem.terms()[0].family->weight() != 1.0 ||
      fit->data().weights.has_value() || NameOf(problem.terms()[0].name) != "interpolation") {
    return "gim moves control points by residuals of the interpolation term alone, without "
           "weights; use lspia";
  }
  if (!problem.elimination().trivial()) return "gim takes no constraints; use lspia";
  const auto m = std::to_string(fit->parameters().size());
  if (fit->parameters().size() != fit->basis().num_control_points()) {
    return "gim needs " + m + " control points for " + m + " points";
  }
  return "";
}

std::optional<Outcome> GimSolver::DoStart(Eigen::VectorXd* /*x*/) {
  const CurveFit& fit = *objective()->problem().curve_fit();
  const Sites& sites = *fit.setting().data;
  std::vector<double> parameters(static_cast<std::size_t>(sites.size));
  for (int row = 0; row < sites.size; ++row) {
    parameters[static_cast<std::size_t>(row)] = sites.parameters[sites.item(row)];
  }
  control_point_of_row_ = PairWithControlPoints(fit.basis(), parameters);
  context()->OffTheClock(
      [this] { context()->Note("spectral radius of I - A", NumberText(SpectralRadius())); });
  return std::nullopt;
}

Status GimSolver::Map(const Eigen::VectorXd& x, Eigen::VectorXd* g_of_x) {
  CurveView& view = *objective()->curve_view();
  const Status status = view.Residuals(x, &residuals_);
  if (status != Status::kOk) return status;
  *g_of_x = x;
  Eigen::Map<Points> points(g_of_x->data(), view.num_points(), view.dimension());
  for (Eigen::Index row = 0; row < residuals_.rows(); ++row) {
    points.row(control_point_of_row_[static_cast<std::size_t>(row)]) += residuals_.row(row);
  }
  return Status::kOk;
}

/// Of I - A, rows of A put where their control points are: dense for few points, otherwise a power
/// iteration's growth (a lower estimate), without counting products.
double GimSolver::SpectralRadius() const {
  const BandedRows& rows = objective()->curve_view()->rows();
  const int n = rows.shape().num_columns;
  const int d = rows.shape().dimension;
  const auto apply = [&](const Eigen::VectorXd& v) {
    // Residuals() gives Q - A v; with the one at zero taken off, -A v is left.
    Points zero(n, d);
    Points moved(n, d);
    const Eigen::VectorXd origin = Eigen::VectorXd::Zero(v.size());
    rows.Residuals(origin.data(), zero.data());
    rows.Residuals(v.data(), moved.data());
    moved -= zero;
    Eigen::VectorXd result = v;
    for (int row = 0; row < n; ++row) {
      const int j = control_point_of_row_[static_cast<std::size_t>(row)];
      result.segment(static_cast<Eigen::Index>(j) * d, d) += moved.row(row).transpose();
    }
    return result;
  };
  constexpr int kLargestDense = 300;
  if (n <= kLargestDense) {
    Eigen::MatrixXd matrix(n, n);
    for (int k = 0; k < n; ++k) {
      const Eigen::VectorXd column = apply(Eigen::VectorXd::Unit(static_cast<Eigen::Index>(n) * d,
                                                                 static_cast<Eigen::Index>(k) * d));
      for (int j = 0; j < n; ++j) matrix(j, k) = column[static_cast<Eigen::Index>(j) * d];
    }
    return Eigen::EigenSolver<Eigen::MatrixXd>(matrix, false).eigenvalues().cwiseAbs().maxCoeff();
  }
  Eigen::VectorXd v = RandomStart(static_cast<Eigen::Index>(n) * d, context()->seed()).normalized();
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

}  // namespace batten
