#include "experiments/loss_notes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/short_number.h"
#include "problems/fit_problem.h"
#include "splines/normal_band.h"
#include "splines/scaled_rows.h"

namespace batten {
namespace {

/// rho'(|r|^2) of each block at x; none where there is no loss, or no value.
std::vector<double> WeightsOf(const BlockFamily& family, const Eigen::VectorXd& x) {
  Eigen::VectorXd residuals;
  if (family.loss() == nullptr || family.Residuals(x, &residuals) != Status::kOk) return {};
  const int k = family.num_residuals();
  std::vector<double> weights(static_cast<std::size_t>(family.size()));
  for (std::size_t b = 0; b < weights.size(); ++b) {
    double rho[3];
    family.loss()->Evaluate(residuals.segment(static_cast<Eigen::Index>(b) * k, k).squaredNorm(),
                            rho);
    weights[b] = rho[1];
  }
  return weights;
}

/// Diagonal of A'A of all terms' rows, with the weights of the losses or without; empty where a
/// term has no rows.
std::vector<double> Diagonal(const Problem& problem, const Eigen::VectorXd& x, bool weighted) {
  std::vector<double> sum;
  for (const Problem::TermInstance& term : problem.terms()) {
    const RowSource* const rows = term.family->rows_without_loss();
    if (rows == nullptr) return {};
    std::vector<double> factors = weighted ? WeightsOf(*term.family, x) : std::vector<double>();
    for (double& factor : factors) factor = std::sqrt(std::max(factor, 0.0));
    const NormalBand band = factors.empty()
                                ? NormalBand::FromRows(*rows)
                                : NormalBand::FromRows(ScaledRows(rows, std::move(factors)));
    sum.resize(static_cast<std::size_t>(band.size()), 0.0);
    for (std::size_t j = 0; j < sum.size(); ++j) {
      sum[j] += band.band()[j * static_cast<std::size_t>(band.width())];
    }
  }
  return sum;
}

std::string RejectedBlocks(const Problem& problem, const Eigen::VectorXd& x) {
  constexpr double kHardly = 0.1;
  constexpr int kAsk = 4;  // one in so many
  for (const Problem::TermInstance& term : problem.terms()) {
    const std::vector<double> weights = WeightsOf(*term.family, x);
    const auto count = std::count_if(weights.begin(), weights.end(),
                                     [](double weight) { return weight < kHardly; });
    if (kAsk * count <= static_cast<std::ptrdiff_t>(weights.size())) continue;
    return std::to_string(count) + " of " + std::to_string(weights.size()) + " residuals of " +
           term.name +
           " count less than a tenth: the curve follows the others alone; if these are no "
           "outliers, a larger loss_scale, less weight on other terms or huber keeps it with them";
  }
  return "";
}

std::string LostControlPoints(const Problem& problem, const Eigen::VectorXd& x) {
  constexpr double kHardly = 1e-3;
  const std::vector<double> plain = Diagonal(problem, x, false);
  const std::vector<double> weighted = Diagonal(problem, x, true);
  std::string text;
  int count = 0;
  constexpr int kNamed = 5;
  for (std::size_t j = 0; j < plain.size() && weighted.size() == plain.size(); ++j) {
    if (!(weighted[j] < kHardly * plain[j])) continue;
    if (count++ < kNamed) text += (count > 1 ? ", " : "") + std::to_string(j);
  }
  if (count == 0) return "";
  return "control points " + text + (count > kNamed ? ", ..." : "") + " (" + std::to_string(count) +
         ", counted from 0) are held by less than a thousandth of their "
         "data's weight: there the curve may go anywhere; a light fairing term or huber holds them";
}

/// How far one reweighted solve moves control points, over the data's size; 0 where there is none.
double ReweightedMove(const Problem& problem, const Eigen::VectorXd& x) {
  NameSpec irls;
  std::string error;
  RunSpec spec;
  spec.start = x;
  spec.max_iterations = 1;
  spec.gradient_tolerance = 0.0;
  spec.keep_trace = false;
  RunResult step;
  if (!ParseNameSpec("irls:banded_qr", &irls, &error) || !Run(problem, irls, spec, &step, &error) ||
      !step.skipped.empty() || !step.x.allFinite()) {
    return 0.0;
  }
  const CurveFit& fit = *problem.curve_fit();
  const Points moved = fit.ControlPoints(step.x) - fit.ControlPoints(x);
  return moved.rowwise().norm().maxCoeff() / fit.size();
}

}  // namespace

void NoteLosses(const Problem& problem, RunResult* run) {
  const CurveFit* const fit = problem.curve_fit();
  const auto has_loss = [](const Problem::TermInstance& term) {
    return term.family->loss() != nullptr;
  };
  if (fit == nullptr || !run->x.allFinite() ||
      std::none_of(problem.terms().begin(), problem.terms().end(), has_loss)) {
    return;
  }
  std::string rejected = RejectedBlocks(problem, run->x);
  if (rejected.empty()) rejected = LostControlPoints(problem, run->x);
  if (!rejected.empty()) run->notes.emplace_back("rejected points", rejected);
  constexpr double kFar = 1e-6;
  if (!IsSuccess(run->outcome.reason)) return;
  const double move = ReweightedMove(problem, run->x);
  if (!(move > kFar)) return;
  run->notes.emplace_back("far from the minimum",
                          "a step of irls:banded_qr from here moves control points by up to " +
                              ShortNumber(move, 2) +
                              " of the data's size, though |g| is small beside that of the start; "
                              "a lower --gradient_tolerance goes on");
}

}  // namespace batten
