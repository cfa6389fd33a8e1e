// Direct fits with nothing cached: the parameters are given, everything else is computed.

#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <memory>
#include <string>
#include <utility>

#include "benchmarks/noisy_loop.h"
#include "problems/objective.h"
#include "solvers/solver_registry.h"

namespace batten {
namespace {

constexpr int kPoints = 1000000;
constexpr int kControlPoints = 10000;

/// E in the user's units: the peers' fits must have the same.
void ReportEnergy(benchmark::State& state, const Problem& problem, const Eigen::VectorXd& x) {
  double energy = 0.0;
  Objective(&problem, nullptr).Energy(x, &energy);
  state.counters["energy"] = energy * problem.units().energy;
}

double Seconds(int threads) { return threads == 1 ? CpuSeconds() : WallSeconds(); }

/// From a data set in memory to control points in its units, as peers do it: spans, scaling, start,
/// rows and solution. Copying the data set and giving memory back is off the clock.
void FromDataSet(benchmark::State& state, const std::string& solver_name, bool closed,
                 int threads = 1) {
  const DataSet data = MakeNoisyLoop(kPoints);
  std::unique_ptr<Problem> problem;
  Eigen::VectorXd x;
  for (auto _ : state) {
    problem.reset();
    DataSet copy = data;
    const double start = Seconds(threads);
    problem = MakeLoopFit(std::move(copy), kControlPoints, closed);
    x = SolveAlone(*problem, solver_name, threads);
    const Points control_points = problem->curve_fit()->ControlPoints(x);
    state.SetIterationTime(Seconds(threads) - start);
    benchmark::DoNotOptimize(control_points.data());
  }
  ReportEnergy(state, *problem, x);
}

void FromProblem(benchmark::State& state, const std::string& solver_name, bool closed,
                 int threads = 1) {
  const Problem& problem = LoopFit(kPoints, kControlPoints, closed);
  Eigen::VectorXd x;
  for (auto _ : state) {
    const double start = Seconds(threads);
    x = SolveAlone(problem, solver_name, threads);
    state.SetIterationTime(Seconds(threads) - start);
    benchmark::DoNotOptimize(x.data());
  }
  ReportEnergy(state, problem, x);
}

#define BATTEN_DIRECT_BENCHMARK(function, solver, form)                                 \
  BENCHMARK_CAPTURE(function, solver##_##form, #solver, std::string(#form) == "closed") \
      ->UseManualTime()                                                                 \
      ->Unit(benchmark::kMillisecond)
BATTEN_DIRECT_BENCHMARK(FromDataSet, banded_cholesky, open);
BATTEN_DIRECT_BENCHMARK(FromDataSet, banded_cholesky, closed);
BATTEN_DIRECT_BENCHMARK(FromDataSet, banded_qr, open);
BATTEN_DIRECT_BENCHMARK(FromDataSet, banded_qr, closed);
BATTEN_DIRECT_BENCHMARK(FromProblem, banded_cholesky, open);
BATTEN_DIRECT_BENCHMARK(FromProblem, banded_cholesky, closed);
BATTEN_DIRECT_BENCHMARK(FromProblem, banded_qr, open);
BATTEN_DIRECT_BENCHMARK(FromProblem, banded_qr, closed);
#undef BATTEN_DIRECT_BENCHMARK

// Two threads share the sum of the normal band; what comes before and after stays in one.
#define BATTEN_THREADED_BENCHMARK(function, form)                                                 \
  BENCHMARK_CAPTURE(function, banded_cholesky_##form##_2_threads, std::string("banded_cholesky"), \
                    std::string(#form) == "closed", 2)                                            \
      ->UseManualTime()                                                                           \
      ->Unit(benchmark::kMillisecond)
BATTEN_THREADED_BENCHMARK(FromDataSet, open);
BATTEN_THREADED_BENCHMARK(FromDataSet, closed);
BATTEN_THREADED_BENCHMARK(FromProblem, open);
BATTEN_THREADED_BENCHMARK(FromProblem, closed);
#undef BATTEN_THREADED_BENCHMARK

/// 1e7 points, 1e5 control points. The peak is that of the whole process, data included, since it
/// began: true only if this is the one benchmark of the process (--benchmark_filter).
void LargeFit(benchmark::State& state, const std::string& solver_name) {
  constexpr int kManyPoints = 10000000;
  constexpr int kManyControlPoints = 100000;
  for (auto _ : state) {
    DataSet data = MakeNoisyLoop(kManyPoints);
    const double start = CpuSeconds();
    const std::unique_ptr<Problem> problem =
        MakeLoopFit(std::move(data), kManyControlPoints, /*closed=*/false);
    const Eigen::VectorXd x = SolveAlone(*problem, solver_name);
    const Points control_points = problem->curve_fit()->ControlPoints(x);
    state.SetIterationTime(CpuSeconds() - start);
    benchmark::DoNotOptimize(control_points.data());
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  constexpr double kKibibytesPerMebibyte = 1024.0;
  state.counters["peak_MiB"] = static_cast<double>(usage.ru_maxrss) / kKibibytesPerMebibyte;
}
BENCHMARK_CAPTURE(LargeFit, banded_cholesky, "banded_cholesky")
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(LargeFit, banded_qr, "banded_qr")
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace batten

BENCHMARK_MAIN();
