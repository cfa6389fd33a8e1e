// Smoothing splines with a knot at every point and one given weight: the solver alone, nothing
// cached but the problem. fairing_peers.py runs it beside SciPy and checks that the curves agree.

#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/noisy_loop.h"

namespace batten {
namespace {

/// Places in [0, 1] and two noisy waves, as make_data() in fairing_peers.py has them.
DataSet MakeWaves(int n) {
  std::uint64_t state = 12345;
  std::vector<double> numbers(3 * static_cast<std::size_t>(n));
  for (double& number : numbers) {
    state = 6364136223846793005U * state + 1442695040888963407U;
    number = static_cast<double>(state >> 11) * std::exp2(-53.0);
  }
  DataSet data;
  data.name = "noisy_waves";
  data.points.resize(n, 2);
  data.parameters = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd& t = *data.parameters;
  for (int i = 1; i < n; ++i) t[i] = t[i - 1] + 0.5 + numbers[static_cast<std::size_t>(i) - 1];
  t /= t[n - 1];
  for (int i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(n + i);
    data.points(i, 0) = std::sin(9.0 * t[i]) + 0.1 * numbers[k];
    data.points(i, 1) = std::cos(7.0 * t[i]) + 0.1 * numbers[k + static_cast<std::size_t>(n)];
  }
  return data;
}

std::unique_ptr<Problem> MakeSmoothing(int n, const std::string& weight) {
  DataSet data = MakeWaves(n);
  FitSpec spec;
  spec.parameters.reset();
  spec.given_knots.assign(3, 0.0);
  spec.given_knots.insert(spec.given_knots.end(), data.parameters->begin(), data.parameters->end());
  spec.given_knots.insert(spec.given_knots.end(), 3, 1.0);
  std::string error;
  for (const std::string& term : {std::string("interpolation"), "fairing/weight=" + weight}) {
    NameSpec name;
    CHECK(ParseNameSpec(term, &name, &error)) << error;
    spec.terms.push_back(std::move(name));
  }
  std::unique_ptr<Problem> problem = MakeFitProblem(std::move(data), std::move(spec), &error);
  CHECK(problem != nullptr) << error;
  return problem;
}

void Smooth(benchmark::State& state, const std::string& solver_name, int n,
            const std::string& weight) {
  const std::unique_ptr<Problem> problem = MakeSmoothing(n, weight);
  // A process waits for its first pages longer than for any that it has given back.
  std::string message;
  SolveAlone(*problem, solver_name, 1, &message);
  for (auto _ : state) {
    const double begin = CpuSeconds();
    benchmark::DoNotOptimize(SolveAlone(*problem, solver_name).data());
    state.SetIterationTime(CpuSeconds() - begin);
  }
  if (!message.empty()) state.SetLabel(message);
}

// At the first weight curves keep some hundred bends, at any number of points; the normal equations
// of 1e6 points then have no sure digit, and banded_cholesky hands over to banded_qr. At the second
// one it solves both sizes itself.
void Register(int n, const std::string& weight) {
  for (const char* solver : {"banded_qr", "banded_cholesky"}) {
    const std::string name =
        std::string("Smooth/") + solver + "/" + std::to_string(n) + "/" + weight;
    benchmark::RegisterBenchmark(name.c_str(), Smooth, solver, n, weight)
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
  }
}

}  // namespace
}  // namespace batten

int main(int argc, char** argv) {
  batten::Register(10000, "1e-8");
  batten::Register(10000, "1e-12");
  batten::Register(1000000, "1e-6");
  batten::Register(1000000, "1e-12");
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
