#include "solvers/best_of.h"

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <utility>

#include "problems/fit_problem.h"
#include "solvers/foot_projection.h"
#include "solvers/options_note.h"

namespace batten {
namespace {

/// The run of the base from one start: it ends after so many iterations, or where |g| has fallen
/// so far that the order of the ends is clear, and books nothing.
class StartContext final : public RunContext {
 public:
  StartContext(const Problem& problem, int steps, RunContext* outer)
      : judge_(&problem, nullptr), steps_(steps), outer_(outer) {}

  Status Iterate(const Eigen::VectorXd& x) override {
    constexpr double kClear = 1e-6;
    double norm = 0.0;
    outer_->OffTheClock([&] {
      double energy = 0.0;
      Eigen::VectorXd gradient;
      const bool ok = judge_.EnergyAndGradient(x, &energy, &gradient) == Status::kOk;
      norm = ok ? gradient.norm() : std::nan("");
    });
    if (iterations_ == 0) first_norm_ = norm;
    if (norm <= kClear * first_norm_) reason_ = StopReason::kGradientSmall;
    if (++iterations_ > steps_) reason_ = StopReason::kIterationLimit;
    return reason_ == StopReason::kNotRun ? Status::kOk : Status::kStop;
  }
  StopReason stop_reason() const override {
    return reason_ == StopReason::kNotRun ? outer_->stop_reason() : reason_;
  }
  /// With what options it ran is of the whole run, other notes are of this part alone.
  void Note(const std::string& name, const std::string& value) override {
    if (name == kOptionsThatRan) outer_->Note(name, value);
  }
  void OffTheClock(const std::function<void()>& work) override { outer_->OffTheClock(work); }
  std::uint64_t seed() const override { return outer_->seed(); }
  int threads() const override { return outer_->threads(); }

 private:
  Objective judge_;
  int steps_;
  RunContext* outer_;
  int iterations_ = 0;
  double first_norm_ = 0.0;
  StopReason reason_ = StopReason::kNotRun;
};

/// Of the disturbance, around a start that is a robust fit: of the minima of a loss that is not
/// convex the one near it is the estimate, lower ones elsewhere bend out to a few points (Yohai,
/// Ann. Statist. 15, 1987).
constexpr double kNearRobustStart = 0.1;

/// Moves free parameters to the feet, where the problem has a view that knows them.
Status GoToFeet(Objective* objective, int threads, Eigen::VectorXd* x) {
  const CurveFit& fit = *objective->problem().curve_fit();
  if (!fit.has_free_parameters() || objective->free_view() == nullptr) return Status::kOk;
  Eigen::VectorXd all = objective->Expand(*x);
  const Status status = ProjectParameters(objective, threads, *x, &all);
  if (status == Status::kOk) *x = objective->problem().elimination().FreeVariables(all);
  return status;
}

/// Every control point moved by up to `radius` in each coordinate, free parameters at the feet.
Status Disturb(Objective* objective, double radius, int threads, std::mt19937_64* random,
               Eigen::VectorXd* x) {
  const CurveFit& fit = *objective->problem().curve_fit();
  Eigen::VectorXd all = objective->Expand(*x);
  const auto num_coordinates =
      static_cast<Eigen::Index>(fit.basis().num_control_points()) * fit.dimension();
  for (double& coordinate : all.head(num_coordinates)) {
    // Not std::uniform_real_distribution, whose numbers differ between libraries.
    const double unit = std::ldexp(static_cast<double>((*random)() >> 11), -53);
    coordinate += radius * (2.0 * unit - 1.0);
  }
  *x = objective->problem().elimination().FreeVariables(all);
  return GoToFeet(objective, threads, x);
}

/// Root mean square distance of the control points from their mean.
double Radius(const Objective& objective, const Eigen::VectorXd& x) {
  const CurveFit& fit = *objective.problem().curve_fit();
  const Points points = fit.ControlPoints(objective.Expand(x)) * fit.setting().scale;
  const Points centred = points.rowwise() - points.colwise().mean();
  return std::sqrt(centred.squaredNorm() / static_cast<double>(points.rows()));
}

}  // namespace

SolverInfo BestOfSolver::ClassInfo() {
  SolverInfo info;
  info.name = "best_of";
  info.summary = "a solver from several disturbed starts, then on from the best end";
  info.source = "multi-start; Rinnooy Kan & Timmer, Math. Programming 39, 1987";
  info.needs = {"free parameters"};
  info.supports = {"what its base supports"};
  info.native_rule = NativeRule::kGradient;
  info.wraps_solver = true;
  info.usual_base = "foot_newton";
  info.options = {
      OptionInfo::Integer("starts", 10, 1, 100'000, "the problem's own start among them"),
      OptionInfo::Integer("steps", 100, 1, 1'000'000, "most iterations from each"),
      OptionInfo::Real("disturbance", 0.3, 0.0, 10.0,
                       "of each coordinate of the control points, in parts of the start's radius")};
  return info;
}

BestOfSolver::BestOfSolver(const OptionValues& options, std::unique_ptr<Solver> base)
    : starts_(options.Integer("starts")),
      steps_(options.Integer("steps")),
      disturbance_(options.Real("disturbance")),
      base_(std::move(base)) {}

std::string BestOfSolver::WhyUnsupported(const Objective& objective) const {
  const std::string why = base_->WhyUnsupported(objective);
  if (!why.empty()) return "best_of:" + why;
  const CurveFit* fit = objective.problem().curve_fit();
  const std::string name = "best_of:" + base_->Info().name;
  if (fit == nullptr) return name + " needs a curve with free parameters; use lbfgs";
  if (fit->spec().parameter_kind != ParameterKind::kFixed) return "";
  return name + " needs free parameters; here they are fixed, use " + base_->Info().name;
}

Outcome BestOfSolver::DoMinimize(Objective* objective, RunContext* context, Eigen::VectorXd* x) {
  if (context->Iterate(*x) != Status::kOk) return {context->stop_reason(), ""};
  const Eigen::VectorXd start = *x;
  const bool is_robust = objective->problem().curve_fit()->starts_robustly();
  const double radius =
      (is_robust ? kNearRobustStart : 1.0) * disturbance_ * Radius(*objective, start);
  std::mt19937_64 random(context->seed());
  double lowest = std::numeric_limits<double>::infinity();
  int best = 0;
  for (int k = 0; k < starts_; ++k) {
    Eigen::VectorXd end = start;
    Status status = Status::kOk;
    if (k > 0) status = Disturb(objective, radius, context->threads(), &random, &end);
    if (status == Status::kStop) return {context->stop_reason(), ""};
    if (status == Status::kNonFinite) continue;
    StartContext inner(objective->problem(), steps_, context);
    base_->Minimize(objective, &inner, &end);
    if (context->stop_reason() != StopReason::kNotRun) return {context->stop_reason(), ""};
    // Ends are compared as curves are, by E at the feet, and the best goes on from there.
    double energy = 0.0;
    status = GoToFeet(objective, context->threads(), &end);
    if (status == Status::kOk) status = objective->Energy(end, &energy);
    if (status == Status::kStop) return {context->stop_reason(), ""};
    if (status == Status::kNonFinite || !(energy < lowest)) continue;
    lowest = energy;
    best = k;
    *x = end;
    if (context->IterateOnTheWay(*x) != Status::kOk) return {context->stop_reason(), ""};
  }
  context->Note("best start", std::to_string(best) + " of 0 to " + std::to_string(starts_ - 1));
  return base_->Minimize(objective, context, x);
}

SolverEntry BestOfEntry() {
  return {BestOfSolver::ClassInfo(),
          [](const OptionValues& options, std::unique_ptr<Solver> base) -> std::unique_ptr<Solver> {
            return std::make_unique<BestOfSolver>(options, std::move(base));
          }};
}

}  // namespace batten
