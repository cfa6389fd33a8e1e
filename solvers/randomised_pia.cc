#include "solvers/randomised_pia.h"

#include <algorithm>
#include <cmath>

namespace batten {
namespace {

/// Number `index` of a stream of uniform numbers in [0, 1) that depends on the seed alone
/// (splitmix64: Steele, Lea & Flood, OOPSLA 2014). A counter is all the state it has.
double Uniform(std::uint64_t seed, std::uint64_t index) {
  std::uint64_t z = (seed * 0xd1342543de82ef95ULL) + (index + 1) * 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  z ^= z >> 31;
  return static_cast<double>(z >> 11) * 0x1.0p-53;
}

}  // namespace

SolverInfo RandomisedPiaSolver::ClassInfo() {
  SolverInfo info;
  info.name = "randomised_pia";
  info.summary = "LSPIA of one randomly drawn block of control points after the other";
  info.source = "Wu & Liu, arXiv:2212.06398";
  info.needs = {"compiled rows"};
  info.supports = {"linear constraints", "weights", "any rank"};
  info.native_rule = NativeRule::kStep;
  info.options = {OptionInfo::Integer("block", 8, 1, 1000000, "control points per block")};
  return info;
}

RandomisedPiaSolver::RandomisedPiaSolver(const OptionValues& options)
    : block_size_(options.Integer("block")) {}

std::string RandomisedPiaSolver::WhyUnsupported(const Objective& objective) const {
  return WhyNoUnboundedCurveView(objective, "randomised_pia");
}

void RandomisedPiaSolver::MeasureBlocks(const NormalBand& band) {
  // ||A_U||_F^2 is the trace of N_UU. Its largest row sum of |N_UU| bounds ||A_U||_2^2; that of all
  // of N's row is no less and costs nothing more.
  const std::vector<double> diagonal = band.Diagonal();
  const std::vector<double> sums = band.AbsoluteRowSums();
  cumulated_.clear();
  steps_.clear();
  double total = 0.0;
  for (int begin = 0; begin < band.size(); begin += block_size_) {
    const int end = std::min(begin + block_size_, band.size());
    double largest = 0.0;
    for (int j = begin; j < end; ++j) {
      total += diagonal[static_cast<std::size_t>(j)];
      largest = std::max(largest, sums[static_cast<std::size_t>(j)]);
    }
    cumulated_.push_back(total);
    steps_.push_back(largest > 0.0 ? 1.0 / largest : 0.0);
  }
}

std::optional<Outcome> RandomisedPiaSolver::DoStart(Eigen::VectorXd* /*x*/) {
  since_ = 0;
  earlier_.resize(0);
  draws_ = 0;
  const NormalBand& band = objective()->curve_view()->normal_band();
  sweep_.emplace(&band);
  MeasureBlocks(band);
  if (cumulated_.back() == 0.0) {
    return Outcome{StopReason::kSolved, "no data point touches a control point"};
  }
  return std::nullopt;
}

int RandomisedPiaSolver::DrawBlock() {
  const double drawn = Uniform(context()->seed(), draws_++) * cumulated_.back();
  const auto found = std::upper_bound(cumulated_.begin(), cumulated_.end(), drawn);
  return static_cast<int>(std::min(found, cumulated_.end() - 1) - cumulated_.begin());
}

void RandomisedPiaSolver::MoveBlock(int block, Eigen::VectorXd* x) {
  const CurveView& view = *objective()->curve_view();
  const int d = view.dimension();
  const int begin = block * block_size_;
  const int end = std::min(begin + block_size_, view.num_points());
  residual_.resize(static_cast<std::size_t>(end - begin) * static_cast<std::size_t>(d));
  for (int j = begin; j < end; ++j) {
    sweep_->RowResidual(j, x->data(),
                        residual_.data() + static_cast<std::ptrdiff_t>(j - begin) * d);
  }
  double* const points = x->data() + static_cast<std::ptrdiff_t>(begin) * d;
  for (std::size_t k = 0; k < residual_.size(); ++k) {
    points[k] += steps_[static_cast<std::size_t>(block)] * residual_[k];
  }
}

/// E never rises but for rounding; random moves tell little of whether it still falls. So every
/// kPatience iterations its difference is computed, without cancellation, as the mean slope.
std::optional<Outcome> RandomisedPiaSolver::CheckProgress(const Eigen::VectorXd& x) {
  constexpr int kPatience = 1000;
  if (earlier_.size() > 0 && ++since_ < kPatience) return std::nullopt;
  Eigen::VectorXd residual;
  const Status status = objective()->curve_view()->NormalResidual(x, &residual);
  if (status != Status::kOk) return Ended(status);
  const bool falls = earlier_.size() == 0 || (residual + earlier_residual_).dot(x - earlier_) > 0.0;
  if (!falls) {
    return Outcome{StopReason::kStalled, "E has not fallen in " + std::to_string(kPatience) +
                                             " iterations: the rest is rounding"};
  }
  since_ = 0;
  earlier_ = x;
  earlier_residual_ = residual;
  return std::nullopt;
}

/// As many draws as there are blocks: the work of one product with N.
std::optional<Outcome> RandomisedPiaSolver::DoStep(Eigen::VectorXd* x) {
  if (std::optional<Outcome> outcome = CheckProgress(*x)) return outcome;
  if (!objective()->curve_view()->AllowProduct(*x)) return Ended(Status::kStop);
  for (std::size_t k = 0; k < steps_.size(); ++k) MoveBlock(DrawBlock(), x);
  if (!x->allFinite()) return Ended(Status::kNonFinite);
  return std::nullopt;
}

std::vector<double> RandomisedPiaSolver::State() const {
  std::vector<double> state = {static_cast<double>(draws_), static_cast<double>(since_)};
  state.insert(state.end(), earlier_.data(), earlier_.data() + earlier_.size());
  if (earlier_.size() > 0) {
    state.insert(state.end(), earlier_residual_.data(),
                 earlier_residual_.data() + earlier_residual_.size());
  }
  return state;
}

void RandomisedPiaSolver::Restore(const std::vector<double>& state) {
  draws_ = static_cast<std::uint64_t>(state[0]);
  since_ = static_cast<int>(state[1]);
  const auto size = static_cast<Eigen::Index>(state.size() - 2) / 2;
  earlier_ = Eigen::Map<const Eigen::VectorXd>(state.data() + 2, size);
  earlier_residual_ = Eigen::Map<const Eigen::VectorXd>(state.data() + 2 + size, size);
}

}  // namespace batten
