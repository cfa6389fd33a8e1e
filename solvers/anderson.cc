#include "solvers/anderson.h"

#include <cmath>

#include "solvers/basic_solution.h"

namespace batten {
namespace {

void Append(const Eigen::VectorXd& vector, std::vector<double>* state) {
  state->push_back(static_cast<double>(vector.size()));
  state->insert(state->end(), vector.data(), vector.data() + vector.size());
}

Eigen::VectorXd Take(const double** next) {
  const auto size = static_cast<Eigen::Index>(*(*next)++);
  Eigen::VectorXd vector = Eigen::Map<const Eigen::VectorXd>(*next, size);
  *next += size;
  return vector;
}

}  // namespace

SolverInfo AndersonSolver::ClassInfo() {
  SolverInfo info;
  info.name = "anderson";
  info.summary = "Anderson acceleration of a fixed point, safeguarded by E";
  info.source = "Anderson, J. ACM 12, 1965; Walker & Ni, SINUM 49, 2011; Peng et al., ACM TOG 2018";
  info.needs = {"a base that is a fixed point"};
  info.supports = {"what its base supports"};
  info.native_rule = NativeRule::kStep;
  info.wraps_solver = true;
  info.usual_base = "lspia";
  info.options = {
      OptionInfo::Integer("window", 5, 1, 50, "number of past steps that are combined")};
  return info;
}

AndersonSolver::AndersonSolver(const OptionValues& options, std::unique_ptr<Solver> base)
    : window_(options.Integer("window")),
      base_(std::move(base)),
      map_(dynamic_cast<FixedPoint*>(base_.get())) {}

std::string AndersonSolver::WhyUnsupported(const Objective& objective) const {
  if (map_ == nullptr) {
    return "anderson accelerates fixed points, and " + base_->Info().name +
           (base_->Info().name == "lspia" ? " with this step" : "") +
           " is none; use a base such as lspia, gim or jacobi_pia, where parameters are free pdm, "
           "tdm, sdm or gi";
  }
  const std::string why = base_->WhyUnsupported(objective);
  return why.empty() ? "" : "anderson:" + why;
}

std::optional<Outcome> AndersonSolver::DoStart(Eigen::VectorXd* x) {
  guard_.Reset();
  num_tried_ = num_rejected_ = 0;
  base_raises_ = false;
  last_image_.resize(0);
  image_differences_.clear();
  move_differences_.clear();
  Eigen::VectorXd start = *x;  // which the base may move
  if (std::optional<Outcome> outcome = map_->Start(objective(), context(), &start)) return outcome;
  const Status status = Evaluate(start, &energy_, &gradient_);
  if (status != Status::kOk) return Ended(status);
  x->swap(start);
  return std::nullopt;
}

Status AndersonSolver::Evaluate(const Eigen::VectorXd& x, double* energy,
                                Eigen::VectorXd* gradient) {
  return objective()->is_quadratic() ? objective()->Gradient(x, gradient)
                                     : objective()->Energy(x, energy);
}

/// The differences to the step before.
void AndersonSolver::Remember() {
  if (last_image_.size() == image_.size()) {
    image_differences_.push_back(image_.head(move_.size()) - last_image_.head(move_.size()));
    move_differences_.push_back(move_ - last_move_);
    if (static_cast<int>(move_differences_.size()) > window_) {
      image_differences_.erase(image_differences_.begin());
      move_differences_.erase(move_differences_.begin());
    }
  }
  last_image_ = image_;
  last_move_ = move_;
}

Eigen::VectorXd AndersonSolver::Accelerated() const {
  // Columns of length 1, so that the pivots show dependence and not size; newest first, so that of
  // equally long ones the newest is taken.
  constexpr double kDependent = 1e-10;
  const auto count = static_cast<Eigen::Index>(move_differences_.size());
  Eigen::MatrixXd columns(move_.size(), count);
  Eigen::VectorXd lengths(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::VectorXd& column = move_differences_[static_cast<std::size_t>(count - 1 - k)];
    lengths[k] = column.norm();
    columns.col(k) = lengths[k] > 0.0 ? Eigen::VectorXd(column / lengths[k]) : column;
  }
  const Eigen::VectorXd gamma = BasicSolution(columns, move_, kDependent);
  Eigen::VectorXd x = image_;
  for (Eigen::Index k = 0; k < count; ++k) {
    if (lengths[k] == 0.0) continue;
    x.head(move_.size()) -=
        gamma[k] / lengths[k] * image_differences_[static_cast<std::size_t>(count - 1 - k)];
  }
  return x;
}

Status AndersonSolver::TryCandidate(const Eigen::VectorXd& x, bool* rises) {
  const Status status = Evaluate(candidate_, &next_energy_, &next_gradient_);
  if (status != Status::kOk) return status;
  // Of a quadratic the difference of E without cancellation: the mean slope along the step.
  rise_ = objective()->is_quadratic() ? 0.5 * (gradient_ + next_gradient_).dot(candidate_ - x)
                                      : next_energy_ - energy_;
  *rises = !(rise_ <= 0.0);
  return status;
}

bool AndersonSolver::IsBeyondRounding(const Eigen::VectorXd& x) {
  if (residual_size_ < 0.0) residual_size_ = objective()->ResidualSize(x);
  // Both values of E carry it.
  return !(rise_ <= 2.0 * Objective::EnergyRoundingFloor(energy_, residual_size_));
}

std::optional<Outcome> AndersonSolver::DoStep(Eigen::VectorXd* x) {
  Status status = map_->MapLeading(*x, &image_);
  if (status != Status::kOk) return Ended(status);
  const Eigen::Index mapped = map_->num_mapped(*x);
  move_ = image_.head(mapped) - x->head(mapped);
  Remember();
  bool rises = true;
  if (!move_differences_.empty()) {
    candidate_ = Accelerated();
    ++num_tried_;
    if (candidate_.allFinite()) status = map_->Complete(&candidate_);
    if (status == Status::kOk && candidate_.allFinite()) status = TryCandidate(*x, &rises);
    if (status == Status::kStop) return Ended(status);
  }
  if (rises || status != Status::kOk) {
    num_rejected_ += move_differences_.empty() ? 0 : 1;
    candidate_ = image_;
    status = map_->Complete(&candidate_);
    if (status == Status::kOk) status = TryCandidate(*x, &rises);
    if (status != Status::kOk) return Ended(status);
    if (rises && !base_raises_ && IsBeyondRounding(*x)) {
      base_raises_ = true;
      WarnOfDivergence("a step of " + base_->Info().name +
                       " raises E, so that E safeguards nothing");
    }
  }
  x->swap(candidate_);
  energy_ = next_energy_;
  gradient_.swap(next_gradient_);
  // Moves can grow for long while E falls, where it is not quadratic.
  return guard_.Check(objective()->is_quadratic() ? move_.norm() : energy_);
}

void AndersonSolver::AtEnd() {
  if (num_tried_ == 0) return;
  context()->Note("rejected steps", std::to_string(num_rejected_) + " of " +
                                        std::to_string(num_tried_) + ", E would have risen");
}

std::vector<double> AndersonSolver::State() const {
  std::vector<double> state;
  guard_.AppendTo(&state);
  Append(last_image_, &state);
  Append(last_move_, &state);
  state.push_back(static_cast<double>(move_differences_.size()));
  for (std::size_t k = 0; k < move_differences_.size(); ++k) {
    Append(image_differences_[k], &state);
    Append(move_differences_[k], &state);
  }
  state.push_back(energy_);
  return state;
}

void AndersonSolver::Restore(const std::vector<double>& state) {
  guard_.Restore(state.data());
  const double* next = state.data() + 2;
  last_image_ = Take(&next);
  last_move_ = Take(&next);
  const auto count = static_cast<std::size_t>(*next++);
  image_differences_.resize(count);
  move_differences_.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    image_differences_[k] = Take(&next);
    move_differences_[k] = Take(&next);
  }
  // Not that of Start, which may have moved its x.
  energy_ = *next;
}

SolverEntry AndersonEntry() {
  return {AndersonSolver::ClassInfo(),
          [](const OptionValues& options, std::unique_ptr<Solver> base) -> std::unique_ptr<Solver> {
            return std::make_unique<AndersonSolver>(options, std::move(base));
          }};
}

}  // namespace batten
