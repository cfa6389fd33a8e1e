// What one evaluation of a fit costs per data point: compiled, through the functors, by Ceres.

#include <benchmark/benchmark.h>
#include <ceres/problem.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/noisy_loop.h"
#include "problems/objective.h"

namespace batten {
namespace {

constexpr int kPoints = 1000000;
constexpr int kControlPoints = 10000;

/// CPU time over the number of data points.
void ReportPerPoint(benchmark::State& state, int num_points) {
  state.counters["per_point"] = benchmark::Counter(
      num_points, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

const Problem& Fit() { return LoopFit(kPoints, kControlPoints, /*closed=*/false); }

/// The same fit with its term told to run its loops with sizes known at run time only.
const Problem& RunTimeSizedFit() {
  static const Problem& problem = *[] {
    static FitSetting& setting = *new FitSetting(Fit().curve_fit()->setting());
    setting.use_static_sizes = false;
    const Term* term = nullptr;
    OptionValues options;
    std::string error;
    CHECK(TermRegistry::Global().Resolve({"interpolation", {}, nullptr}, &term, &options, &error))
        << error;
    auto* const made = new Problem("run_time_sizes");
    made->AddVariables("control_points", Fit().start());
    made->AddTerm("interpolation", term->MakeFamily(setting, options, &error));
    return made;
  }();
  return problem;
}

const Problem& FitOfSizes(bool static_sizes) { return static_sizes ? Fit() : RunTimeSizedFit(); }

/// Limit of everything that has to look at the data: one pass over points and parameters.
void ReadInput(benchmark::State& state) {
  const CurveFit& fit = *Fit().curve_fit();
  for (auto _ : state) {
    benchmark::DoNotOptimize(fit.data().points.colwise().sum().eval());
    benchmark::DoNotOptimize(fit.parameters().sum());
  }
  ReportPerPoint(state, kPoints);
}
BENCHMARK(ReadInput)->Unit(benchmark::kMillisecond);

void EvaluateObjective(benchmark::State& state, const Problem& problem, bool compile,
                       bool with_gradient) {
  Objective objective(&problem, nullptr, Objective::Options{compile});
  const Eigen::VectorXd x = objective.start();
  double energy = 0.0;
  Eigen::VectorXd gradient;
  objective.Energy(x, &energy);  // rows are compiled here, off the clock
  for (auto _ : state) {
    if (with_gradient) {
      objective.EnergyAndGradient(x, &energy, &gradient);
    } else {
      objective.Energy(x, &energy);
    }
    benchmark::DoNotOptimize(energy);
  }
  ReportPerPoint(state, kPoints);
}

void EnergyAndGradient(benchmark::State& state, bool compile, bool static_sizes) {
  EvaluateObjective(state, FitOfSizes(static_sizes), compile, /*with_gradient=*/true);
}
BENCHMARK_CAPTURE(EnergyAndGradient, compiled, true, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(EnergyAndGradient, uncompiled, false, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(EnergyAndGradient, uncompiled_run_time_sizes, false, false)
    ->Unit(benchmark::kMillisecond);

void EnergyAlone(benchmark::State& state, bool compile) {
  EvaluateObjective(state, Fit(), compile, /*with_gradient=*/false);
}
BENCHMARK_CAPTURE(EnergyAlone, compiled, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(EnergyAlone, uncompiled, false)->Unit(benchmark::kMillisecond);

/// Degree 6 has no loops of fixed size, degree 5 has: the price of run-time sizes once the rows are
/// in memory, to be read with 9 and 8 numbers per row in mind.
void CompiledOfDegree(benchmark::State& state) {
  const auto degree = static_cast<int>(state.range(0));
  EvaluateObjective(state, LoopFit(kPoints, kControlPoints, /*closed=*/false, degree),
                    /*compile=*/true, /*with_gradient=*/true);
}
BENCHMARK(CompiledOfDegree)->Arg(6)->Arg(5)->Unit(benchmark::kMillisecond);

/// The fit as a user of Ceres writes it: one AutoDiffCostFunction per data point.
class NativeCeresFit {
 public:
  explicit NativeCeresFit(const Problem& fit) : problem_(Options()), x_(fit.start()) {
    const BlockFamily& family = *fit.terms().front().family;
    std::vector<int> offsets;
    std::vector<int> sizes;
    for (int block = 0; block < family.size(); ++block) {
      family.Bind(x_, block, &offsets, &sizes);
      std::vector<double*> pointers;
      for (const int offset : offsets) pointers.push_back(x_.data() + offset);
      problem_.AddResidualBlock(family.MakeCeresCostFunction(x_, block).release(), nullptr,
                                pointers);
    }
  }

  /// Ceres' cost, which is E / 2, and its gradient.
  bool Evaluate(double* cost, std::vector<double>* gradient) {
    return problem_.Evaluate(ceres::Problem::EvaluateOptions(), cost, nullptr, gradient, nullptr);
  }

 private:
  static ceres::Problem::Options Options() {
    ceres::Problem::Options options;
    options.disable_all_safety_checks = true;
    return options;
  }

  ceres::Problem problem_;
  Eigen::VectorXd x_;
};

void CeresProblemEvaluate(benchmark::State& state) {
  static NativeCeresFit& native = *new NativeCeresFit(Fit());
  double cost = 0.0;
  std::vector<double> gradient;
  for (auto _ : state) {
    native.Evaluate(&cost, &gradient);
    benchmark::DoNotOptimize(gradient.data());
  }
  ReportPerPoint(state, kPoints);
  double energy = 0.0;
  Objective(&Fit(), nullptr).Energy(Fit().start(), &energy);
  if (!(std::abs(2.0 * cost - energy) <= 1e-10 * energy)) {
    state.SkipWithError("Ceres' cost is not E / 2");
  }
}
BENCHMARK(CeresProblemEvaluate)->Unit(benchmark::kMillisecond);

/// Takes rows and keeps nothing.
class Discard final : public RowConsumer {
 public:
  void Consume(const RowBlock& block) override {
    benchmark::DoNotOptimize(block.coefficients);
    benchmark::ClobberMemory();
  }
};

void StreamRows(benchmark::State& state, bool static_sizes) {
  Objective objective(&FitOfSizes(static_sizes), nullptr);
  const RowSource& rows = objective.curve_view()->row_source();
  Discard discard;
  for (auto _ : state) rows.Stream(&discard);
  ReportPerPoint(state, kPoints);
}
BENCHMARK_CAPTURE(StreamRows, static_sizes, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(StreamRows, run_time_sizes, false)->Unit(benchmark::kMillisecond);

void CompileRows(benchmark::State& state) {
  Objective objective(&Fit(), nullptr);
  const RowSource& rows = objective.curve_view()->row_source();
  for (auto _ : state) {
    const BandedRows compiled({&rows});
    benchmark::DoNotOptimize(compiled.num_blocks());
  }
  ReportPerPoint(state, kPoints);
}
BENCHMARK(CompileRows)->Unit(benchmark::kMillisecond);

void BuildNormalBand(benchmark::State& state, bool static_sizes) {
  Objective objective(&FitOfSizes(static_sizes), nullptr);
  const RowSource& rows = objective.curve_view()->row_source();
  for (auto _ : state) {
    const NormalBand band = NormalBand::FromRows(rows);
    benchmark::DoNotOptimize(band.band().data());
  }
  ReportPerPoint(state, kPoints);
}
BENCHMARK_CAPTURE(BuildNormalBand, static_sizes, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BuildNormalBand, run_time_sizes, false)->Unit(benchmark::kMillisecond);

/// The gradient alone: no cost per data point, whatever their number.
void GradientByNormalBand(benchmark::State& state) {
  const auto num_points = static_cast<int>(state.range(0));
  Objective objective(&LoopFit(num_points, kControlPoints, /*closed=*/false), nullptr);
  const Eigen::VectorXd x = objective.start();
  Eigen::VectorXd gradient;
  objective.Gradient(x, &gradient);  // the band is built here, off the clock
  for (auto _ : state) {
    objective.Gradient(x, &gradient);
    benchmark::DoNotOptimize(gradient.data());
  }
  ReportPerPoint(state, num_points);
}
BENCHMARK(GradientByNormalBand)->Arg(10000)->Arg(kPoints)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace batten

BENCHMARK_MAIN();
