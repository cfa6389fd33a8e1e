// What one iteration costs: of our solvers on the normal band, and of our L-BFGS beside libLBFGS.

#include <benchmark/benchmark.h>
#include <lbfgs.h>

#include <algorithm>
#include <memory>
#include <string>

#include "benchmarks/noisy_loop.h"
#include "benchmarks/race_functions.h"
#include "problems/objective.h"
#include "solvers/solver_registry.h"
#include "solvers/stepper.h"

namespace batten {
namespace {

constexpr int kControlPoints = 10000;
constexpr int kPoints = 1000000;
/// Iterations before the clock starts: the memory of 10 pairs is full then, for good.
constexpr int kWarmUp = 10;
constexpr int kIterations = 20;

void ReportPerIteration(benchmark::State& state) {
  state.counters["per_iteration"] = benchmark::Counter(
      kIterations, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// `calls`: evaluations of E and g in all timed iterations of all the benchmark's loops.
void ReportPerEvaluation(benchmark::State& state, long calls) {
  const auto count = static_cast<double>(calls);
  state.counters["per_evaluation"] =
      benchmark::Counter(count, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["evaluations_per_iteration"] =
      benchmark::Counter(count / kIterations, benchmark::Counter::kAvgIterations);
}

/// Seconds that iterations kWarmUp + 1 .. kWarmUp + kIterations take. `calls` is the running count
/// of evaluations, `timed` is raised by those of the timed iterations; both may be null. A run that
/// ends too soon is the benchmark's error.
double TimeSteps(benchmark::State& state, const std::string& solver_name, Objective* objective,
                 const long* calls, long* timed) {
  std::string error;
  NameSpec spec;
  CHECK(ParseNameSpec(solver_name, &spec, &error)) << error;
  const std::unique_ptr<Solver> solver = SolverRegistry::Global().Make(spec, nullptr, &error);
  auto* const stepper = dynamic_cast<Stepper*>(solver.get());
  CHECK(stepper != nullptr) << error;
  IdleContext context;
  Eigen::VectorXd x = objective->start();
  bool ended = stepper->Start(objective, &context, &x).has_value();
  for (int k = 0; k < kWarmUp && !ended; ++k) ended = stepper->Step(&x).has_value();
  const long calls_before = calls == nullptr ? 0 : *calls;
  const double start = CpuSeconds();
  for (int k = 0; k < kIterations && !ended; ++k) ended = stepper->Step(&x).has_value();
  const double seconds = CpuSeconds() - start;
  if (ended) state.SkipWithError("the run ended before its last timed iteration");
  if (timed != nullptr) *timed += *calls - calls_before;
  benchmark::DoNotOptimize(x.data());
  return seconds;
}

/// On the normal band: the same for 1e4 and for 1e6 points.
void StepOnNormalBand(benchmark::State& state, const std::string& solver_name) {
  const auto num_points = static_cast<int>(state.range(0));
  Objective objective(&LoopFit(num_points, kControlPoints, /*closed=*/false), nullptr);
  objective.curve_view()->normal_band();  // built off the clock
  for (auto _ : state) {
    state.SetIterationTime(TimeSteps(state, solver_name, &objective, nullptr, nullptr));
  }
  ReportPerIteration(state);
}
#define BATTEN_STEP_BENCHMARK(name, solver)         \
  BENCHMARK_CAPTURE(StepOnNormalBand, name, solver) \
      ->Arg(10000)                                  \
      ->Arg(kPoints)                                \
      ->UseManualTime()                             \
      ->Unit(benchmark::kMicrosecond)
BATTEN_STEP_BENCHMARK(lspia, "lspia");
BATTEN_STEP_BENCHMARK(cg, "cg");
BATTEN_STEP_BENCHMARK(lbfgs, "lbfgs/memory=10");
#undef BATTEN_STEP_BENCHMARK
// Beside lspia with as many points: their work per iteration is one pass over the band, too.
#define BATTEN_FAMILY_BENCHMARK(solver)                \
  BENCHMARK_CAPTURE(StepOnNormalBand, solver, #solver) \
      ->Arg(kControlPoints)                            \
      ->UseManualTime()                                \
      ->Unit(benchmark::kMicrosecond)
BATTEN_FAMILY_BENCHMARK(jacobi_pia);
BATTEN_FAMILY_BENCHMARK(gauss_seidel_pia);
BATTEN_FAMILY_BENCHMARK(sor_pia);
BATTEN_FAMILY_BENCHMARK(polyak_lspia);
BATTEN_FAMILY_BENCHMARK(nesterov_lspia);
BATTEN_FAMILY_BENCHMARK(chebyshev_lspia);
BATTEN_FAMILY_BENCHMARK(mlspia);
#undef BATTEN_FAMILY_BENCHMARK
// On the rows, of which it needs as many as control points. Its set-up takes much longer than the
// iterations that are timed: once.
BENCHMARK_CAPTURE(StepOnNormalBand, preconditioned_pia, "preconditioned_pia")
    ->Arg(kControlPoints)
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);

RaceFunction* FunctionNamed(const std::string& name) {
  static RaceFunction* const rosenbrock = new RosenbrockFunction();
  if (name == "rosenbrock") return rosenbrock;
  static RaceFunction* const normal_band =
      new NormalBandFunction(LoopFit(kPoints, kControlPoints, /*closed=*/false));
  return normal_band;
}

/// The function that both call, alone: what is left of an iteration is the method's own.
void FunctionAlone(benchmark::State& state, const std::string& function_name) {
  RaceFunction* const function = FunctionNamed(function_name);
  const Eigen::VectorXd x = function->start();
  Eigen::VectorXd gradient(x.size());
  for (auto _ : state) {
    gradient.setZero();
    benchmark::DoNotOptimize(function->AddGradient(x.data(), gradient.data()));
    benchmark::DoNotOptimize(gradient.data());
  }
}
BENCHMARK_CAPTURE(FunctionAlone, normal_band, "normal_band")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(FunctionAlone, rosenbrock, "rosenbrock")->Unit(benchmark::kMicrosecond);

void OurLbfgs(benchmark::State& state, const std::string& function_name) {
  long calls = 0;
  long timed = 0;
  const Problem problem = MakeRaceProblem(FunctionNamed(function_name), &calls);
  Objective objective(&problem, nullptr);
  for (auto _ : state) {
    state.SetIterationTime(TimeSteps(state, "lbfgs/memory=10", &objective, &calls, &timed));
  }
  ReportPerIteration(state);
  ReportPerEvaluation(state, timed);
}
BENCHMARK_CAPTURE(OurLbfgs, normal_band, "normal_band")
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(OurLbfgs, rosenbrock, "rosenbrock")
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);

/// What libLBFGS' callbacks share: the clock starts when iteration kWarmUp is done and stops when
/// iteration kWarmUp + kIterations is. Between the two lie as many updates, directions and line
/// searches as in TimeSteps.
struct PeerRun {
  RaceFunction* function;
  long calls = 0;
  long calls_before = 0;
  double started = 0.0;
  double seconds = 0.0;
  bool done = false;
};

lbfgsfloatval_t EvaluateForPeer(void* instance, const lbfgsfloatval_t* x, lbfgsfloatval_t* gradient,
                                int size, lbfgsfloatval_t /*step*/) {
  auto* const run = static_cast<PeerRun*>(instance);
  ++run->calls;
  std::fill_n(gradient, size, 0.0);
  return run->function->AddGradient(x, gradient);
}

int WatchPeer(void* instance, const lbfgsfloatval_t* /*x*/, const lbfgsfloatval_t* /*gradient*/,
              lbfgsfloatval_t /*energy*/, lbfgsfloatval_t /*x_norm*/,
              lbfgsfloatval_t /*gradient_norm*/, lbfgsfloatval_t /*step*/, int /*size*/,
              int iteration, int /*evaluations*/) {
  auto* const run = static_cast<PeerRun*>(instance);
  if (iteration == kWarmUp) {
    run->calls_before = run->calls;
    run->started = CpuSeconds();
  }
  if (iteration == kWarmUp + kIterations) {
    run->seconds = CpuSeconds() - run->started;
    run->done = true;
  }
  return run->done ? 1 : 0;  // anything but 0 ends it
}

/// Its own defaults (line search of More and Thuente, ftol 1e-4, gtol 0.9), memory 10, no stop
/// rule.
void LibLbfgs(benchmark::State& state, const std::string& function_name) {
  RaceFunction* const function = FunctionNamed(function_name);
  const Eigen::VectorXd start = function->start();
  const auto size = static_cast<int>(start.size());
  lbfgs_parameter_t parameters;
  lbfgs_parameter_init(&parameters);
  parameters.m = 10;
  parameters.epsilon = 0.0;
  lbfgsfloatval_t* const x = lbfgs_malloc(size);
  long timed = 0;
  for (auto _ : state) {
    std::copy_n(start.data(), size, x);
    PeerRun run{function};
    lbfgs(size, x, nullptr, EvaluateForPeer, WatchPeer, &run, &parameters);
    if (!run.done) state.SkipWithError("the run ended before its last timed iteration");
    timed += run.calls - run.calls_before;
    state.SetIterationTime(run.seconds);
  }
  lbfgs_free(x);
  ReportPerIteration(state);
  ReportPerEvaluation(state, timed);
}
BENCHMARK_CAPTURE(LibLbfgs, normal_band, "normal_band")
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(LibLbfgs, rosenbrock, "rosenbrock")
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace batten

BENCHMARK_MAIN();
