#include "solvers/irls.h"

#include <cmath>
#include <deque>

#include "splines/scaled_rows.h"

namespace batten {
namespace {

/// Roots of rho'(|r|^2) of a term's blocks. A residual whose weight is zero has no say.
std::vector<double> RootWeights(const BlockFamily& family, const RowSource& rows,
                                const Eigen::VectorXd& all) {
  // Norms come with the root of the term's weight in them, the loss is of the plain residual.
  std::vector<double> factors = ResidualNorms(rows, all.data());
  for (double& factor : factors) {
    const double squared_norm = factor * factor / family.weight();
    double rho[3];
    family.loss()->Evaluate(squared_norm, rho);
    factor = std::sqrt(std::max(rho[1], 0.0));
  }
  return factors;
}

}  // namespace

SolverInfo IrlsSolver::ClassInfo() {
  SolverInfo info;
  info.name = "irls";
  info.summary = "iteratively reweighted least squares: losses for a direct solver";
  info.source = "Holland & Welsch, Comm. Stat. A6, 1977; Huber, Robust Statistics, ch. 7";
  info.needs = {"a direct base", "terms that are compiled rows without their loss"};
  info.supports = {"losses", "linear constraints", "weights"};
  info.native_rule = NativeRule::kStep;
  info.wraps_solver = true;
  info.usual_base = "banded_qr";
  return info;
}

IrlsSolver::IrlsSolver(std::unique_ptr<Solver> base)
    : base_(std::move(base)), direct_(dynamic_cast<DirectSolver*>(base_.get())) {}

std::string IrlsSolver::WhyUnsupported(const Objective& objective) const {
  if (direct_ == nullptr) {
    return "irls solves by a direct method, and " + base_->Info().name +
           " is none; use a base such as banded_qr";
  }
  const Problem& problem = objective.problem();
  const std::string name = "irls:" + base_->Info().name;
  std::string why = WhyNoBounds(objective, name);
  if (!why.empty()) return why;
  std::vector<const RowSource*> sources;
  for (const Problem::TermInstance& term : problem.terms()) {
    sources.push_back(term.family->rows_without_loss());
  }
  if (!objective.options().compile || CurveView::Make(problem, sources, nullptr) == nullptr) {
    return name + " needs terms that are compiled rows without their loss; use lbfgs";
  }
  return "";
}

Status IrlsSolver::Map(const Eigen::VectorXd& x, Eigen::VectorXd* g_of_x) {
  const Problem& problem = objective()->problem();
  const Eigen::VectorXd all = objective()->Expand(x);
  std::deque<ScaledRows> weighted;
  std::vector<const RowSource*> sources;
  for (const Problem::TermInstance& term : problem.terms()) {
    const RowSource* rows = term.family->rows_without_loss();
    if (term.family->loss() != nullptr && term.family->weight() > 0.0) {
      weighted.emplace_back(rows, RootWeights(*term.family, *rows, all));
      rows = &weighted.back();
    }
    sources.push_back(rows);
  }
  if (!objective()->Allow(Evaluation::kProduct, &x)) return Status::kStop;
  const auto view = CurveView::Make(problem, std::move(sources), nullptr);
  *g_of_x = x;
  const Outcome outcome = direct_->SolveRows(*view, problem, context(), g_of_x);
  said_ = outcome.message;
  return outcome.reason == StopReason::kSolved ? Status::kOk : Status::kNonFinite;
}

void IrlsSolver::AtEnd() {
  if (!said_.empty()) context()->Note("last solve", said_);
}

SolverEntry IrlsEntry() {
  return {
      IrlsSolver::ClassInfo(),
      [](const OptionValues& /*options*/, std::unique_ptr<Solver> base) -> std::unique_ptr<Solver> {
        return std::make_unique<IrlsSolver>(std::move(base));
      }};
}

}  // namespace batten
