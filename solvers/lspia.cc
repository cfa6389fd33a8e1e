#include "solvers/lspia.h"

#include <cmath>

#include "solvers/lanczos.h"

namespace batten {

SolverInfo LspiaSolver::ClassInfo() {
  SolverInfo info;
  info.name = "lspia";
  info.summary = "least-squares progressive-iterative approximation";
  info.source = "Deng & Lin, CAD 47, 2014; Lin, Cao & Zhang, arXiv:1707.09109";
  info.needs = {"compiled rows"};
  info.supports = {"linear constraints", "weights", "any rank"};
  info.native_rule = NativeRule::kStep;
  info.options = {
      OptionInfo::Word("step", "diagonal", {"diagonal", "max_column", "optimal"},
                       "diagonal: 1 / column sum per control point; max_column: 2 / largest column "
                       "sum; optimal: 2 / (l1 + ln)"),
      OptionInfo::Real("relaxation", 1.0, 1e-6, 1.0, "factor of the step"),
  };
  return info;
}

LspiaSolver::LspiaSolver(const OptionValues& options)
    : step_rule_(options.Word("step")), relaxation_(options.Real("relaxation")) {}

std::string LspiaSolver::WhyUnsupported(const Objective& objective) const {
  const std::string why = WhyNoCurveView(objective, "lspia");
  return why.empty() ? WhyNoBounds(objective, "lspia") : why;
}

std::optional<Outcome> LspiaSolver::ChooseStep(const Eigen::VectorXd& x) {
  CurveView& view = *objective()->curve_view();
  const int d = view.dimension();
  // Row sums of |N| are the column sums of A where A's rows are no less than 0 and sum to 1, and
  // bound the spectrum of N, or of the diagonally scaled N by 1, where they are not (Gershgorin).
  const std::vector<double> sums = view.normal_band().AbsoluteRowSums();
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
    return std::nullopt;
  }
  Spectrum spectrum;
  const auto multiply = [&view](const Eigen::VectorXd& v, Eigen::VectorXd* product) {
    return view.NormalProduct(v, product);
  };
  // From N times a random vector, so that the null space, where nothing has to converge, is left
  // out.
  Eigen::VectorXd start;
  Status status = multiply(RandomStart(x.size(), context()->seed()), &start);
  constexpr double kRelativeError = 1e-3;
  constexpr int kMaxProducts = 300;
  if (status == Status::kOk) {
    status = EstimateSpectrum(multiply, start, kRelativeError, kMaxProducts, &spectrum);
  }
  if (status != Status::kOk) return Ended(status);
  // A Ritz value may still be below l1 by more than its error bound, which is the distance to some
  // eigenvalue: the largest row sum of |N| is never below l1 (Gershgorin), and is taken where the
  // recursion did not settle.
  const bool settled =
      spectrum.largest > 0.0 && spectrum.largest_error <= kRelativeError * spectrum.largest;
  const double l1 =
      settled ? std::min(largest, spectrum.largest + spectrum.largest_error) : largest;
  const double ln = std::max(0.0, spectrum.smallest);
  step_.setConstant(relaxation_ * 2.0 / (l1 + ln));
  context()->Note("eigenvalues of A'A", NumberText(ln) + " to " + NumberText(l1));
  context()->Note("predicted rate", NumberText((l1 - ln) / (l1 + ln)));
  return std::nullopt;
}

std::optional<Outcome> LspiaSolver::DoStart(Eigen::VectorXd* x) {
  last_move_.resize(0);
  alternations_ = 0;
  return ChooseStep(*x);
}

Status LspiaSolver::Map(const Eigen::VectorXd& x, Eigen::VectorXd* g_of_x) {
  const Status status = objective()->curve_view()->NormalResidual(x, &residual_);
  if (status == Status::kOk) *g_of_x = x + step_.cwiseProduct(residual_);
  return status;
}

std::optional<Outcome> LspiaSolver::Inspect(const Eigen::VectorXd& x,
                                            const Eigen::VectorXd& g_of_x) {
  // With an eigenvalue of I - mu N at -1 the moves turn about and stay as long as they were.
  constexpr double kOpposite = -1.0 + 1e-10;
  constexpr double kSameLength = 1.0 - 1e-10;
  constexpr int kPatience = 20;
  const Eigen::VectorXd move = g_of_x - x;
  if (last_move_.size() == move.size()) {
    const double product = move.norm() * last_move_.norm();
    const bool turned = product > 0.0 && move.dot(last_move_) <= kOpposite * product;
    const bool as_long = move.norm() >= kSameLength * last_move_.norm();
    alternations_ = turned && as_long ? alternations_ + 1 : 0;
    if (alternations_ >= kPatience) {
      return Outcome{StopReason::kStalled,
                     "an eigenvalue of I - mu A'A is -1: the iteration jumps to and fro and never "
                     "converges; take a smaller step (relaxation below 1)"};
    }
  }
  last_move_ = move;
  return std::nullopt;
}

std::vector<double> LspiaSolver::State() const {
  std::vector<double> state(last_move_.data(), last_move_.data() + last_move_.size());
  state.push_back(alternations_);
  return state;
}

void LspiaSolver::Restore(const std::vector<double>& state) {
  last_move_ =
      Eigen::Map<const Eigen::VectorXd>(state.data(), static_cast<Eigen::Index>(state.size()) - 1);
  alternations_ = static_cast<int>(state.back());
}

}  // namespace batten
