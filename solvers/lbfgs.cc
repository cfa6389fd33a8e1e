#include "solvers/lbfgs.h"

#include <cmath>

namespace batten {
namespace {

/// E along x + a d, by evaluation. Leaves the last point's gradient behind.
class EvaluatedLine : public LineFunction {
 public:
  EvaluatedLine(Objective* objective, const Eigen::VectorXd& x, const Eigen::VectorXd& direction,
                double energy, Eigen::VectorXd* next_x, Eigen::VectorXd* next_gradient,
                double* next_energy)
      : objective_(objective),
        x_(x),
        direction_(direction),
        energy_(energy),
        next_x_(next_x),
        next_gradient_(next_gradient),
        next_energy_(next_energy) {}

  Status Evaluate(LinePoint* point) override {
    last_step_ = point->step;
    *next_x_ = x_ + point->step * direction_;
    const Status status = objective_->EnergyAndGradient(*next_x_, next_energy_, next_gradient_);
    if (status != Status::kOk) return status;
    point->change = *next_energy_ - energy_;
    point->slope = next_gradient_->dot(direction_);
    return Status::kOk;
  }
  double last_step() const { return last_step_; }  // next_x and the others belong to it

 private:
  Objective* objective_;
  const Eigen::VectorXd& x_;
  const Eigen::VectorXd& direction_;
  double energy_;
  Eigen::VectorXd* next_x_;
  Eigen::VectorXd* next_gradient_;
  double* next_energy_;
  double last_step_ = 0.0;
};

/// E along a line of a quadratic: a g'd + a^2 d'Hd / 2.
class QuadraticLine : public LineFunction {
 public:
  QuadraticLine(double slope, double curvature) : slope_(slope), curvature_(curvature) {}
  Status Evaluate(LinePoint* point) override {
    point->change = point->step * (slope_ + 0.5 * point->step * curvature_);
    point->slope = slope_ + point->step * curvature_;
    return std::isfinite(point->change) ? Status::kOk : Status::kNonFinite;
  }

 private:
  double slope_;
  double curvature_;
};

}  // namespace

SolverInfo LbfgsSolver::ClassInfo() {
  SolverInfo info;
  info.name = "lbfgs";
  info.summary = "limited-memory BFGS with a Wolfe line search, our own";
  info.source =
      "Liu & Nocedal, Math. Programming 45, 1989; Liu et al., Accelerated Geometric "
      "Iteration Method, 2016; Hager & Zhang, SIAM J. Optim. 16, 2005";
  info.needs = {};
  info.supports = {"any objective", "linear constraints", "losses",
                   "weights",       "any rank",           "order of points"};
  info.native_rule = NativeRule::kGradient;
  info.options = {
      OptionInfo::Integer("memory", 10, 3, 20, "pairs kept"),
      OptionInfo::Word("wolfe", "weak", {"weak", "strong"},
                       "curvature condition of the line search"),
      OptionInfo::Real("c1", 1e-4, 1e-12, 0.4, "sufficient decrease"),
      OptionInfo::Real("c2", 0.9, 0.5, 0.999, "curvature"),
  };
  return info;
}

LbfgsSolver::LbfgsSolver(const OptionValues& options) : memory_(options.Integer("memory")) {
  wolfe_.strong = options.Word("wolfe") == "strong";
  wolfe_.sufficient_decrease = options.Real("c1");
  wolfe_.curvature = options.Real("c2");
}

std::string LbfgsSolver::WhyUnsupported(const Objective& objective) const {
  return WhyNoBounds(objective, "lbfgs");
}

std::optional<Outcome> LbfgsSolver::DoStart(Eigen::VectorXd* x) {
  memory_.Clear();
  const Status status = objective()->is_quadratic()
                            ? objective()->Gradient(*x, &gradient_)
                            : objective()->EnergyAndGradient(*x, &energy_, &gradient_);
  if (status != Status::kOk) return Ended(status);
  if (!objective()->is_quadratic()) residual_size_ = objective()->ResidualSize(*x);
  return std::nullopt;
}

double LbfgsSolver::FirstStep() const {
  // The inverse of the first gradient's length bounds the first move by 1: H0 knows no scale.
  return memory_.size() > 0 ? 1.0 : std::min(1.0, 1.0 / gradient_.norm());
}

LineSearchEnd LbfgsSolver::Search(const Eigen::VectorXd& x, double slope, LinePoint* found,
                                  Status* status) {
  if (!objective()->is_quadratic()) {
    wolfe_.noise = Objective::EnergyRoundingFloor(energy_, residual_size_);
    EvaluatedLine line(objective(), x, direction_, energy_, &next_x_, &next_gradient_,
                       &next_energy_);
    const LineSearchEnd end = SearchWolfe(wolfe_, slope, FirstStep(), &line, found);
    if (end == LineSearchEnd::kFound && line.last_step() != found->step) {
      *status = line.Evaluate(found);  // the step taken is not the one tried last
    }
    return end;
  }
  wolfe_.noise = 0.0;
  *status = objective()->HessianTimes(x, direction_, &product_);
  if (*status != Status::kOk) return LineSearchEnd::kStopped;
  QuadraticLine line(slope, direction_.dot(product_));
  const LineSearchEnd end = SearchWolfe(wolfe_, slope, FirstStep(), &line, found);
  if (end != LineSearchEnd::kFound) return end;
  next_x_ = x + found->step * direction_;
  *status = objective()->Gradient(next_x_, &next_gradient_);
  return end;
}

/// The slope along the direction, which is first turned to where a step may lead.
double LbfgsSolver::AimAlong(const Eigen::VectorXd& x) {
  objective()->Aim(x, gradient_, &direction_);
  return gradient_.dot(direction_);
}

double LbfgsSolver::AimDownhill(const Eigen::VectorXd& x, double part) {
  memory_.Clear();
  direction_ = -part * gradient_;
  return AimAlong(x);
}

std::optional<Outcome> LbfgsSolver::DoStep(Eigen::VectorXd* x) {
  memory_.Direction(gradient_, &direction_);
  double slope = AimAlong(*x);
  if (!(slope < 0.0) && memory_.size() > 0) slope = AimDownhill(*x);
  LinePoint found;
  Status status = Status::kOk;
  LineSearchEnd end = Search(*x, slope, &found, &status);
  if (end == LineSearchEnd::kNoStep && memory_.size() > 0) {
    // The pairs may hold only noise: once more from the plain gradient.
    end = Search(*x, AimDownhill(*x), &found, &status);
  }
  // A short step is turned less, and goes down at last.
  for (double part = 1e-2; end == LineSearchEnd::kNoStep && objective()->seats() && part > 1e-9;
       part *= 1e-2) {
    end = Search(*x, AimDownhill(*x, part), &found, &status);
  }
  if (end == LineSearchEnd::kStopped) {
    return Ended(status == Status::kNonFinite ? status : Status::kStop);
  }
  if (end == LineSearchEnd::kNoStep) {
    return Outcome{StopReason::kLineSearchEnded, "no step along the gradient lowers E measurably"};
  }
  if (status != Status::kOk) return Ended(status);
  // Where it stays, E and g are known from the search.
  if (objective()->Seat(&next_x_)) {
    status = objective()->EnergyAndGradient(next_x_, &next_energy_, &next_gradient_);
    if (status != Status::kOk) return Ended(status);
  }
  // Pairs from the points themselves: s = x+ - x as rounded, so that it belongs to y.
  direction_ = next_x_ - *x;
  if (direction_.isZero(0.0)) {
    return Outcome{StopReason::kLineSearchEnded, "the step is below rounding"};
  }
  gradient_ = next_gradient_ - gradient_;
  memory_.Add(direction_, gradient_);
  gradient_.swap(next_gradient_);
  energy_ = next_energy_;
  x->swap(next_x_);
  return std::nullopt;
}

std::vector<double> LbfgsSolver::State() const {
  std::vector<double> state = memory_.ToNumbers();
  state.push_back(residual_size_);
  return state;
}

void LbfgsSolver::Restore(const std::vector<double>& state) {
  memory_.FromNumbers({state.begin(), state.end() - 1}, gradient_.size());
  residual_size_ = state.back();
}

}  // namespace batten
