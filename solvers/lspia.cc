#include "solvers/lspia.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "problems/fit_problem.h"
#include "solvers/normal_spectrum.h"

namespace batten {
namespace {

constexpr char kNeedsDiagonalSteps[] =
    "lspia weighs fairing by control point in steps that each has of its own; use step=diagonal";

}  // namespace

SolverInfo LspiaSolver::ClassInfo() {
  SolverInfo info;
  info.name = "lspia";
  info.summary = "least-squares progressive-iterative approximation";
  info.source = "Deng & Lin, CAD 47, 2014; Lin, Cao & Zhang, arXiv:1707.09109";
  info.needs = {"compiled rows"};
  info.supports = {"linear constraints", "weights", "any rank"};
  info.native_rule = NativeRule::kStep;
  info.options = {
      OptionInfo::Word("step", "diagonal",
                       {"diagonal", "max_column", "optimal", "cauchy", "barzilai_borwein"},
                       "diagonal: 1 / column sum per control point; max_column: 2 / largest column "
                       "sum; optimal: 2 / (l1 + ln); cauchy: the best step of each iteration; "
                       "barzilai_borwein: the best one of the iteration before"),
      OptionInfo::Real("relaxation", 1.0, 1e-6, 1.0, "factor of the step"),
      OptionInfo::Real("fairing_factor", 1.0, 0.0, 1e6,
                       "what the terms fairing count times as much at the control points "
                       "fairing_first to fairing_last (fairing-PIA)"),
      OptionInfo::Integer("fairing_first", 0, 0, 1'000'000'000, "first of them, counted from 0"),
      OptionInfo::Integer("fairing_last", 1'000'000'000, 0, 1'000'000'000,
                          "last of them, or of all"),
  };
  return info;
}

LspiaSolver::LspiaSolver(const OptionValues& options)
    : step_rule_(options.Word("step")),
      relaxation_(options.Real("relaxation")),
      fairing_factor_(options.Real("fairing_factor")),
      fairing_first_(options.Integer("fairing_first")),
      fairing_last_(options.Integer("fairing_last")) {}

LspiaSolver::LspiaSolver(std::vector<double> fairing_factors)
    : step_rule_("diagonal"), relaxation_(1.0), fairing_factors_(std::move(fairing_factors)) {}

SolverInfo LspiaSolver::Info() const {
  SolverInfo info = ClassInfo();
  if (weighs_fairing()) {
    info.limit =
        "(A'(Q - A P))_i = (f_i - 1) (F P)_i for every control point i, F of the terms fairing";
  }
  return info;
}

std::string LspiaSolver::WhyUnsupported(const Objective& objective) const {
  std::string why = WhyNoUnboundedCurveView(objective, "lspia");
  if (!why.empty() || !weighs_fairing()) return why;
  if (step_rule_ != "diagonal") {
    return kNeedsDiagonalSteps;
  }
  why = FairingWeights::WhyNot(objective, "lspia");
  if (!why.empty()) return why;
  const int n = objective.problem().curve_fit()->basis().num_control_points();
  if (fairing_factors_.empty() && (fairing_first_ > fairing_last_ || fairing_first_ >= n)) {
    return "lspia weighs fairing from control point fairing_first=" +
           std::to_string(fairing_first_) + " to fairing_last=" + std::to_string(fairing_last_) +
           ", which are none of 0 to " + std::to_string(n - 1) + "; use others or fairing_factor=1";
  }
  return "";
}

void LspiaSolver::WeighFairing() {
  const NormalBand& band = objective()->curve_view()->normal_band();
  std::vector<double> factors = fairing_factors_;
  if (factors.empty()) {
    factors.assign(static_cast<std::size_t>(band.size()), 1.0);
    for (int j = fairing_first_; j <= std::min(fairing_last_, band.size() - 1); ++j) {
      factors[static_cast<std::size_t>(j)] = fairing_factor_;
    }
  }
  CHECK_EQ(factors.size(), static_cast<std::size_t>(band.size()));
  weighted_.emplace(*objective(), band, std::move(factors));
}

std::optional<Outcome> LspiaSolver::ChooseStep(const Eigen::VectorXd& x) {
  CurveView& view = *objective()->curve_view();
  const int d = view.dimension();
  // Row sums of |N| are the column sums of A where A's rows are no less than 0 and sum to 1, and
  // bound the spectrum of N, or of the diagonally scaled N by 1, where they are not (Gershgorin).
  const std::vector<double> sums =
      weighted_.has_value() ? weighted_->RowSums() : view.normal_band().AbsoluteRowSums();
  double largest = 0.0;
  for (const double sum : sums) largest = std::max(largest, sum);
  step_.setZero(x.size());
  if (largest == 0.0) return Outcome{StopReason::kSolved, "no data point touches a control point"};
  if (step_rule_ == "diagonal") {
    for (Eigen::Index j = 0; j < x.size(); ++j) {
      const double sum = sums[static_cast<std::size_t>(j / d)];
      // A control point without data has no residual: it stays.
      if (sum > 0.0) step_[j] = relaxation_ / sum;
    }
    return std::nullopt;
  }
  if (step_rule_ == "max_column") {
    step_.setConstant(relaxation_ * 2.0 / largest);
    context()->Note("step", NumberText(step_[0]));
    if (relaxation_ == 1.0) {
      WarnOfDivergence(
          "an eigenvalue of I - mu N is -1 where the largest one of N is the largest "
          "column sum; a relaxation below 1 mends it");
    }
    return std::nullopt;
  }
  if (step_rule_ == "cauchy") {
    step_.resize(0);
    return std::nullopt;
  }
  NormalSpectrum spectrum;
  const Status status = EstimateNormalSpectrum(&view, context()->seed(), &spectrum);
  if (status != Status::kOk) return Ended(status);
  const double l1 = spectrum.largest;
  const double ln = spectrum.smallest;
  step_.setConstant(relaxation_ * 2.0 / (l1 + ln));
  context()->Note("eigenvalues of A'A", NumberText(ln) + " to " + NumberText(l1));
  context()->Note("predicted rate", NumberText((l1 - ln) / (l1 + ln)));
  return std::nullopt;
}

std::optional<Outcome> LspiaSolver::DoStart(Eigen::VectorXd* x) {
  last_move_.resize(0);
  alternations_ = 0;
  own_limit_.Reset();
  weighted_.reset();
  if (weighs_fairing()) WeighFairing();
  // Cauchy's steps change from one iteration to the next, and the longest move can come late.
  guard_.Reset(step_rule_ == "cauchy" ? 3 * StallGuard::kPatience : StallGuard::kPatience);
  return ChooseStep(*x);
}

Status LspiaSolver::Map(const Eigen::VectorXd& x, Eigen::VectorXd* g_of_x) {
  Status status = objective()->curve_view()->NormalResidual(x, &residual_);
  if (status != Status::kOk) return status;
  if (weighted_.has_value()) {
    if (!objective()->curve_view()->AllowProduct(x)) return Status::kStop;
    weighted_->AddTo(x, &residual_);
  }
  if (step_.size() > 0) {
    *g_of_x = x + step_.cwiseProduct(residual_);
    return Status::kOk;
  }
  status = objective()->curve_view()->NormalProduct(residual_, &product_);
  if (status != Status::kOk) return status;
  const double curvature = residual_.dot(product_);
  const double step = curvature > 0.0 ? relaxation_ * residual_.squaredNorm() / curvature : 0.0;
  *g_of_x = x + step * residual_;
  return Status::kOk;
}

std::optional<Outcome> LspiaSolver::Inspect(const Eigen::VectorXd& x,
                                            const Eigen::VectorXd& g_of_x) {
  // With an eigenvalue of I - mu N at -1 the moves turn about and stay as long as they were.
  constexpr double kOpposite = -1.0 + 1e-10;
  constexpr double kSameLength = 1.0 - 1e-10;
  constexpr int kPatience = 20;
  move_ = g_of_x - x;
  const double length = move_.norm();
  if (weighted_.has_value() && own_limit_.Reached(length, x)) {
    return Outcome{StopReason::kNativeStop,
                   "its steps are 1e-10 of the first one: it goes to its own limit, which is not "
                   "the minimum of E: fairing is weighed by control point"};
  }
  const bool as_long = last_move_.size() == move_.size() && length >= kSameLength * last_length_;
  // Hardly ever: moves shrink.
  const double product = length * last_length_;
  const bool turned = as_long && product > 0.0 && move_.dot(last_move_) <= kOpposite * product;
  alternations_ = turned ? alternations_ + 1 : 0;
  if (alternations_ >= kPatience) {
    return Outcome{StopReason::kStalled,
                   "an eigenvalue of I - mu A'A is -1: the iteration jumps to and fro and never "
                   "converges; take a smaller step (relaxation below 1)"};
  }
  last_move_.swap(move_);
  last_length_ = length;
  return guard_.Check(length);
}

std::vector<double> LspiaSolver::State() const {
  std::vector<double> state(last_move_.data(), last_move_.data() + last_move_.size());
  state.push_back(alternations_);
  own_limit_.AppendTo(&state);
  guard_.AppendTo(&state);
  return state;
}

void LspiaSolver::Restore(const std::vector<double>& state) {
  const auto size = static_cast<Eigen::Index>(state.size()) - 4;
  last_move_ = Eigen::Map<const Eigen::VectorXd>(state.data(), size);
  last_length_ = last_move_.norm();
  alternations_ = static_cast<int>(state[static_cast<std::size_t>(size)]);
  own_limit_.Restore(state.data() + size + 1);
  guard_.Restore(state.data() + size + 2);
}

BarzilaiBorweinLspiaSolver::BarzilaiBorweinLspiaSolver(const OptionValues& options)
    : relaxation_(options.Real("relaxation")),
      weighs_fairing_(options.Real("fairing_factor") != 1.0) {}

std::string BarzilaiBorweinLspiaSolver::WhyUnsupported(const Objective& objective) const {
  if (weighs_fairing_) {
    return kNeedsDiagonalSteps;
  }
  return WhyNoUnboundedCurveView(objective, "lspia");
}

std::optional<Outcome> BarzilaiBorweinLspiaSolver::DoStart(Eigen::VectorXd* /*x*/) {
  const std::vector<double> sums = objective()->curve_view()->normal_band().AbsoluteRowSums();
  const double largest = *std::max_element(sums.begin(), sums.end());
  if (largest == 0.0) return Outcome{StopReason::kSolved, "no data point touches a control point"};
  first_step_ = 1.0 / largest;
  previous_x_.resize(0);
  guard_.Reset();
  return std::nullopt;
}

std::optional<Outcome> BarzilaiBorweinLspiaSolver::DoStep(Eigen::VectorXd* x) {
  const Status status = objective()->curve_view()->NormalResidual(*x, &residual_);
  if (status != Status::kOk) return Ended(status);
  double step = first_step_;
  if (previous_x_.size() == x->size()) {
    const Eigen::VectorXd move = *x - previous_x_;
    const double curvature = move.dot(previous_residual_ - residual_);
    const double squared = move.squaredNorm();
    // Between the inverses of the spectrum's ends, but for rounding.
    if (curvature > 0.0 && std::isfinite(squared / curvature)) step = squared / curvature;
  }
  previous_x_ = *x;
  previous_residual_ = residual_;
  *x += relaxation_ * step * residual_;
  return guard_.Check(residual_.norm());
}

std::vector<double> BarzilaiBorweinLspiaSolver::State() const {
  std::vector<double> state;
  guard_.AppendTo(&state);
  if (previous_x_.size() == 0) return state;
  state.insert(state.end(), previous_x_.data(), previous_x_.data() + previous_x_.size());
  state.insert(state.end(), previous_residual_.data(),
               previous_residual_.data() + previous_residual_.size());
  return state;
}

void BarzilaiBorweinLspiaSolver::Restore(const std::vector<double>& state) {
  guard_.Restore(state.data());
  const auto size = static_cast<Eigen::Index>(state.size() - 2) / 2;
  previous_x_ = Eigen::Map<const Eigen::VectorXd>(state.data() + 2, size);
  previous_residual_ = Eigen::Map<const Eigen::VectorXd>(state.data() + 2 + size, size);
}

SolverEntry LspiaEntry() {
  return {LspiaSolver::ClassInfo(),
          [](const OptionValues& options, std::unique_ptr<Solver>) -> std::unique_ptr<Solver> {
            if (options.Word("step") == "barzilai_borwein") {
              return std::make_unique<BarzilaiBorweinLspiaSolver>(options);
            }
            return std::make_unique<LspiaSolver>(options);
          }};
}

}  // namespace batten
