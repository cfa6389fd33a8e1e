#include "problems/objective.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "problems/fit_problem.h"

namespace batten {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
// Each entry of the gradient is a sum of products that carry one rounding each, and P, stored with
// one, contributes as much again; 4 leaves a factor of two over both.
constexpr double kFloorRoundings = 4.0;

}  // namespace

Objective::Objective(const Problem* problem, EvaluationMonitor* monitor, Options options)
    : problem_(problem),
      monitor_(monitor),
      options_(options),
      num_variables_(problem->elimination().num_free(problem->num_variables())),
      view_(options.compile ? CurveView::Make(*problem, monitor) : nullptr),
      seats_(std::any_of(problem->terms().begin(), problem->terms().end(),
                         [](const auto& term) { return term.family->seats(); })),
      projects_(problem->curve_fit() != nullptr && problem->curve_fit()->is_projected()) {}

bool Objective::AllowProjection(const Eigen::VectorXd& x) {
  if (!projects_ || monitor_ == nullptr) return true;
  if (projected_at_.size() == x.size() && projected_at_ == x) return true;
  projected_at_ = x;
  return Allow(Evaluation::kProjection, &x);
}

const FreeView* Objective::free_view() const {
  if (!free_view_is_made_) free_view_ = FreeView::Make(*problem_);
  free_view_is_made_ = true;
  return free_view_.get();
}

bool Objective::Seat(Eigen::VectorXd* x) const {
  if (!seats_) return false;
  Eigen::VectorXd all = Expand(*x);
  for (const Problem::TermInstance& term : problem_->terms()) term.family->Seat(&all);
  Eigen::VectorXd seated = problem_->elimination().FreeVariables(all);
  const bool moves = seated != *x;
  x->swap(seated);
  return moves;
}

void Objective::Aim(const Eigen::VectorXd& x, const Eigen::VectorXd& gradient,
                    Eigen::VectorXd* direction) const {
  if (!seats_) return;
  const LinearElimination& elimination = problem_->elimination();
  Eigen::VectorXd all = elimination.Expand(x);
  const Eigen::VectorXd slopes = elimination.ExpandDirection(gradient);
  Eigen::VectorXd moves = elimination.ExpandDirection(*direction);
  for (const Problem::TermInstance& term : problem_->terms()) {
    term.family->KeepTogether(all, slopes, &moves);
  }
  all += moves;
  for (const Problem::TermInstance& term : problem_->terms()) term.family->Seat(&all);
  *direction = elimination.FreeVariables(all) - x;
}

Eigen::VectorXd Objective::start() const {
  return problem_->elimination().FreeVariables(problem_->start());
}

Eigen::VectorXd Objective::Expand(const Eigen::VectorXd& x) const {
  return problem_->elimination().Expand(x);
}

Status Objective::EvaluateTerms(const Eigen::VectorXd& all, double* energy,
                                Eigen::VectorXd* gradient) const {
  *energy = 0.0;
  if (gradient != nullptr) gradient->setZero(all.size());
  for (const Problem::TermInstance& term : problem_->terms()) {
    const Status status = term.family->Evaluate(all, 0, term.family->size(), energy, gradient);
    if (status != Status::kOk) return status;
  }
  return Status::kOk;
}

Status Objective::EvaluateRows(const Eigen::VectorXd& x, double* energy,
                               Eigen::VectorXd* gradient) const {
  if (gradient != nullptr) gradient->setZero(x.size());
  *energy = view_->rows().Evaluate(x.data(), gradient == nullptr ? nullptr : gradient->data());
  const bool finite = std::isfinite(*energy) && (gradient == nullptr || gradient->allFinite());
  return finite ? Status::kOk : Status::kNonFinite;
}

Status Objective::Energy(const Eigen::VectorXd& x, double* energy) {
  if (!AllowAt(Evaluation::kEnergy, x)) return Status::kStop;
  if (view_ != nullptr) return EvaluateRows(x, energy, nullptr);
  return problem_->elimination().trivial() ? EvaluateTerms(x, energy, nullptr)
                                           : EvaluateTerms(Expand(x), energy, nullptr);
}

Status Objective::EnergyAndGradient(const Eigen::VectorXd& x, double* energy,
                                    Eigen::VectorXd* gradient) {
  if (!AllowAt(Evaluation::kEnergy, x) || !Allow(Evaluation::kGradient, &x)) return Status::kStop;
  if (view_ != nullptr) return EvaluateRows(x, energy, gradient);
  if (problem_->elimination().trivial()) return EvaluateTerms(x, energy, gradient);
  Eigen::VectorXd full;
  const Status status = EvaluateTerms(Expand(x), energy, &full);
  if (status == Status::kOk) *gradient = problem_->elimination().Restrict(full);
  return status;
}

Status Objective::Gradient(const Eigen::VectorXd& x, Eigen::VectorXd* gradient) {
  if (view_ == nullptr) {
    double energy = 0.0;
    return EnergyAndGradient(x, &energy, gradient);
  }
  if (!Allow(Evaluation::kGradient, &x)) return Status::kStop;
  gradient->resize(x.size());
  view_->normal_band().NormalResidual(x.data(), gradient->data());
  *gradient *= -2.0;
  return gradient->allFinite() ? Status::kOk : Status::kNonFinite;
}

Status Objective::Jacobian(const Eigen::VectorXd& x, Eigen::VectorXd* residuals,
                           SparseRows* jacobian) {
  if (!AllowAt(Evaluation::kJacobian, x)) return Status::kStop;
  const Eigen::VectorXd all = Expand(x);
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<Eigen::VectorXd> parts;
  int num_rows = 0;
  for (const Problem::TermInstance& term : problem_->terms()) {
    const BlockFamily& family = *term.family;
    const std::size_t first_entry = entries.size();
    parts.emplace_back();
    Status status = family.Residuals(all, &parts.back());
    if (status == Status::kOk) status = family.Jacobian(all, num_rows, &entries);
    if (status != Status::kOk) return status;
    const int k = family.num_residuals();
    Eigen::VectorXd root(family.size());
    for (int b = 0; b < family.size(); ++b) {
      const double squared_norm = parts.back().segment(b * k, k).squaredNorm();
      double rho[3] = {squared_norm, 1.0, 0.0};
      if (family.loss() != nullptr) family.loss()->Evaluate(squared_norm, rho);
      root[b] = std::sqrt(family.weight() * std::max(rho[1], 0.0));
      parts.back().segment(b * k, k) *= root[b];
    }
    for (std::size_t e = first_entry; e < entries.size(); ++e) {
      const Eigen::Triplet<double>& old = entries[e];
      entries[e] = {old.row(), old.col(), old.value() * root[(old.row() - num_rows) / k]};
    }
    num_rows += static_cast<int>(parts.back().size());
  }
  residuals->resize(num_rows);
  int row = 0;
  for (const Eigen::VectorXd& part : parts) {
    residuals->segment(row, part.size()) = part;
    row += static_cast<int>(part.size());
  }
  SparseRows full(num_rows, problem_->num_variables());
  full.setFromTriplets(entries.begin(), entries.end());
  *jacobian =
      problem_->elimination().trivial() ? full : SparseRows(full * problem_->elimination().z());
  return Status::kOk;
}

Status Objective::HessianTimes(const Eigen::VectorXd& x, const Eigen::VectorXd& v,
                               Eigen::VectorXd* product) {
  if (view_ != nullptr) {
    const Status status = view_->NormalProduct(v, product);
    if (status == Status::kOk) *product *= 2.0;
    return status;
  }
  if (!AllowProjection(x) || !Allow(Evaluation::kProduct, nullptr)) return Status::kStop;
  const LinearElimination& elimination = problem_->elimination();
  const Eigen::VectorXd all = elimination.Expand(x);
  const Eigen::VectorXd direction = elimination.ExpandDirection(v);
  Eigen::VectorXd full = Eigen::VectorXd::Zero(all.size());
  for (const Problem::TermInstance& term : problem_->terms()) {
    const Status status = term.family->AddHessianTimes(all, direction, &full);
    if (status != Status::kOk) return status;
  }
  *product = elimination.Restrict(full);
  return Status::kOk;
}

Status Objective::PartialEnergy(const Eigen::VectorXd& x, int term, int begin, int end,
                                double* energy) {
  if (!AllowAt(Evaluation::kEnergy, x)) return Status::kStop;
  *energy = 0.0;
  return problem_->terms()[static_cast<std::size_t>(term)].family->Evaluate(Expand(x), begin, end,
                                                                            energy, nullptr);
}

double Objective::GradientRoundingFloor(const Eigen::VectorXd& x) const {
  Eigen::VectorXd bound = Eigen::VectorXd::Zero(x.size());
  if (view_ != nullptr) {
    view_->rows().AddRoundingBound(x.data(), bound.data());
  } else {
    Objective plain(problem_, nullptr, options_);
    Eigen::VectorXd residuals;
    SparseRows jacobian;
    if (plain.Jacobian(x, &residuals, &jacobian) != Status::kOk) return 0.0;
    // |J||x| + |r| stands for |A||P| + |Q|: where r = A P - Q, |Q| is at most their sum.
    bound = jacobian.cwiseAbs().transpose() *
            (jacobian.cwiseAbs() * x.cwiseAbs() + residuals.cwiseAbs());
  }
  return 2.0 * kFloorRoundings * kEpsilon * bound.norm();
}

double Objective::ResidualSize(const Eigen::VectorXd& x) const {
  const Eigen::VectorXd all = Expand(x);
  const Eigen::VectorXd origin = Eigen::VectorXd::Zero(all.size());
  double sum = 0.0;
  for (const Problem::TermInstance& term : problem_->terms()) {
    Eigen::VectorXd here;
    Eigen::VectorXd at_origin;
    if (term.family->Residuals(all, &here) != Status::kOk) continue;
    const double size = term.family->Residuals(origin, &at_origin) == Status::kOk
                            ? (at_origin.cwiseAbs() + (here - at_origin).cwiseAbs()).squaredNorm()
                            : here.squaredNorm();
    sum += term.family->weight() * size;
  }
  return std::sqrt(sum);
}

double Objective::EnergyRoundingFloor(double energy, double residual_size) {
  return kFloorRoundings * kEpsilon * (2.0 * std::sqrt(energy) * residual_size + energy);
}

std::vector<double> Objective::TermEnergies(const Eigen::VectorXd& x) const {
  const Eigen::VectorXd all = Expand(x);
  std::vector<double> energies;
  for (const Problem::TermInstance& term : problem_->terms()) {
    double energy = 0.0;
    const bool ok =
        term.family->Evaluate(all, 0, term.family->size(), &energy, nullptr) == Status::kOk;
    energies.push_back(ok ? energy : std::numeric_limits<double>::quiet_NaN());
  }
  return energies;
}

}  // namespace batten
