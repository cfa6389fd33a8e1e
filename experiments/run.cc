#include "experiments/run.h"

#include <atomic>
#include <cmath>
#include <exception>
#include <limits>
#include <new>

#include "experiments/run_control.h"
#include "experiments/running_solver.h"
#include "experiments/short_number.h"
#include "experiments/sparse_run.h"
#include "problems/fit_problem.h"
#include "solvers/solver_registry.h"

namespace batten {
namespace {

// The interrupt handler sets it: lock-free, hence safe there.
std::atomic<bool> interrupt_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);

/// Geometric mean of the gradient's factor per iteration over the last third of the iterations that
/// are well above the rounding floor. Nothing where the gradient stands still: a method with a
/// limit other than the minimum comes to it at a rate that |g| does not show.
double ObservedRate(const RunResult& result) {
  constexpr double kAboveFloor = 100.0;
  constexpr int kFewest = 6;
  constexpr double kStandsStill = 1e-9;
  constexpr double kComesToAStand = 1e-3;
  int last = -1;
  for (const TraceRow& row : result.trace) {
    if (!(row.gradient_norm > kAboveFloor * result.gradient_floor)) break;
    last = row.iteration;
  }
  if (last < kFewest) return std::numeric_limits<double>::quiet_NaN();
  const int first = last - last / 3;
  const double ratio = result.trace[static_cast<std::size_t>(last)].gradient_norm /
                       result.trace[static_cast<std::size_t>(first)].gradient_norm;
  if (std::abs(ratio - 1.0) < kStandsStill) return std::numeric_limits<double>::quiet_NaN();
  // What ends at such a limit may still have been on its way in these iterations.
  const SolverInfo* const info = SolverRegistry::Global().Find(result.solver.name);
  const bool has_limit = info != nullptr && !info->limit.empty();
  const StopReason reason = result.outcome.reason;
  const bool ended_itself =
      reason == StopReason::kNativeStop || (has_limit && reason == StopReason::kStepSmall);
  const double last_factor = result.trace[static_cast<std::size_t>(last)].gradient_norm /
                             result.trace[static_cast<std::size_t>(last) - 1].gradient_norm;
  if (ended_itself && std::abs(last_factor - 1.0) < kComesToAStand) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return std::pow(ratio, 1.0 / (last - first));
}

/// Stands before run control and tells of what it lets through.
class Watched final : public EvaluationMonitor {
 public:
  Watched(EvaluationMonitor* control, const EvaluationWatch& watch)
      : control_(control), watch_(watch) {}
  bool Allow(Evaluation kind, const Eigen::VectorXd* x) override {
    return control_->Allow(kind, x) && watch_(kind, x);
  }

 private:
  EvaluationMonitor* control_;
  const EvaluationWatch& watch_;
};

/// Distance of the farthest control point from the data's middle, in sizes of the data.
double Reach(const CurveFit& fit, const Eigen::VectorXd& x) {
  const Points control_points = fit.ControlPoints(x);
  const Eigen::Map<const Eigen::RowVectorXd> center(fit.setting().center, fit.dimension());
  return (control_points.rowwise() - center).rowwise().norm().maxCoeff() / fit.size();
}

/// In sizes of the data: a curve that goes there does so for no point, and where E has lost half of
/// its digits.
constexpr double kFar = 100.0;
constexpr double kHidden = 1e4;

/// What a user of moving parameters has to know to read the end of a run.
void AddWarnings(const Problem& problem, RunResult* result) {
  const CurveFit* fit = problem.curve_fit();
  if (fit == nullptr || !(fit->has_free_parameters() || fit->is_projected())) return;
  const int degree = fit->basis().degree();
  const std::string& solver = result->solver.name;
  if (degree == 1) {
    result->notes.emplace_back("degree 1",
                               "the curve has corners, where E has no derivative by t: a run may "
                               "end at one, with |g| not small");
  } else if (degree == 2 && (solver == "newton" || solver == "foot_newton" || solver == "sdm")) {
    result->notes.emplace_back(
        "degree 2", "second derivatives jump at knots, so that convergence may be slow there");
  }
  const double reach = Reach(*fit, result->x);
  if (reach > kFar) {
    result->notes.emplace_back("far from the data",
                               "control points are up to " + ShortNumber(reach, 2) +
                                   " times the data's size away" +
                                   (reach > kHidden ? ", where rounding hides much of E" : ""));
  }
  const double start_reach = Reach(*fit, problem.start());
  if (start_reach > kFar && result->outcome.reason == StopReason::kGradientSmall) {
    result->notes.emplace_back(
        "far start", "|g| is small beside that of the start, " + ShortNumber(start_reach, 2) +
                         " times the data's size away; a lower --gradient_tolerance or a "
                         "nearer start goes on");
  }
}

/// What throws ends alone: its outcome says so. Not in a process of its own, which tells it better.
Outcome MinimizeCatching(Solver* solver, Objective* objective, RunContext* context,
                         Eigen::VectorXd* x) {
  const Eigen::VectorXd start = *x;
  try {
    return solver->Minimize(objective, context, x);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& exception) {
    if (x->size() != start.size()) *x = start;
    constexpr std::size_t kLongest = 300;
    return {StopReason::kNumericalFailure,
            "threw an exception: " + Quoted(exception.what(), kLongest)};
  }
}

/// `most_iterates`: 0 for what `spec` says.
bool RunWatched(const Problem& problem, const NameSpec& solver_name, const RunSpec& spec,
                std::size_t most_iterates, bool catches, RunResult* result, std::string* error,
                const EvaluationWatch& watch) {
  *result = RunResult();
  result->solver = solver_name;
  OptionValues options;
  const std::unique_ptr<Solver> solver =
      SolverRegistry::Global().Make(solver_name, &options, error);
  if (solver == nullptr) return false;
  result->options = options.ToText();

  RunControl control(problem, spec, solver->Info().native_rule, result);
  if (most_iterates > 0) control.KeepAtMost(most_iterates);
  Watched watched(&control, watch);
  EvaluationMonitor* const monitor = watch ? static_cast<EvaluationMonitor*>(&watched) : &control;
  // Made before the clock starts: nothing in it is evaluated or compiled before the solver asks.
  Objective objective(&problem, monitor, Objective::Options{spec.compile});
  result->skipped = solver->WhyUnsupported(objective);
  if (!result->skipped.empty()) return true;
  Eigen::VectorXd x =
      spec.start.size() > 0 ? problem.elimination().FreeVariables(spec.start) : objective.start();
  const RunningSolver running(solver_name.ToString());
  control.Begin();
  result->outcome = catches ? MinimizeCatching(solver.get(), &objective, &control, &x)
                            : solver->Minimize(&objective, &control, &x);
  control.Finish(x);
  result->observed_rate = ObservedRate(*result);
  if (result->x.allFinite()) AddWarnings(problem, result);
  return true;
}

}  // namespace

const char* ToString(Mode mode) { return mode == Mode::kRace ? "race" : "native"; }

bool FromString(const std::string& text, Mode* mode) {
  if (text != "race" && text != "native") return false;
  *mode = text == "race" ? Mode::kRace : Mode::kNative;
  return true;
}

void RequestInterrupt() { interrupt_requested = true; }
bool InterruptRequested() { return interrupt_requested; }

bool Run(const Problem& problem, const NameSpec& solver, const RunSpec& spec, RunResult* result,
         std::string* error, const EvaluationWatch& watch) {
  return RunWatched(problem, solver, spec, 0, true, result, error, watch);
}

bool RunKeepingSome(const Problem& problem, const NameSpec& solver, const RunSpec& spec,
                    std::size_t most, RunResult* result, std::string* error) {
  return RunWatched(problem, solver, spec, most, false, result, error, nullptr);
}

}  // namespace batten
