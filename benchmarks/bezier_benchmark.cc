// Bezier subdivision: halving beside a plain loop of the same arithmetic, cut rules beside halving,
// and beside the flatteners of renderers at equal true error.

#include <benchmark/benchmark.h>
#include <glog/logging.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <functional>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "benchmarks/flatteners.h"
#include "experiments/bezier_paper_curves.h"
#include "solvers/cut_rule_registry.h"
#include "splines/bezier_distance.h"
#include "splines/bezier_measures.h"

namespace {
std::atomic<long> num_allocations{0};
}  // namespace

// Inlined, GCC takes the pair for a mismatch.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++num_allocations;
  if (void* const memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t /*size*/) noexcept {
  std::free(memory);
}

namespace batten {
namespace {

constexpr int kRounds = 10;
constexpr int kNumCuts = (1 << kRounds) - 1;

void ReportControlPoints(benchmark::State& state, int degree) {
  state.counters["control_points"] = benchmark::Counter(
      static_cast<double>(kNumCuts) * (degree + 1), benchmark::Counter::kIsIterationInvariantRate);
}

/// Room for all pieces of the rounds, round after round.
std::vector<double> RoomFor(const BezierCurve& curve) {
  std::vector<double> room(static_cast<std::size_t>(2 << kRounds) * curve.control_points().size());
  std::copy(curve.control_points().data(),
            curve.control_points().data() + curve.control_points().size(), room.data());
  return room;
}

// de Casteljau's algorithm at 1/2 as a textbook has it, ten rounds, nothing else.
void PlainLoop(benchmark::State& state) {
  const auto n = static_cast<int>(state.range(0));
  std::vector<double> room = RoomFor(FamilyCurve("uniform", n, 0));
  const int size = 2 * (n + 1);
  for (auto _ : state) {
    for (int piece = 1; piece <= kNumCuts; ++piece) {
      const double* points = room.data() + (piece - 1) * size;
      double* const first = room.data() + (2 * piece - 1) * size;
      double* const second = first + size;
      for (int k = 0; k < size; ++k) second[k] = points[k];
      for (int r = 0; r <= n; ++r) {
        first[2 * r] = second[0];
        first[2 * r + 1] = second[1];
        for (int k = 0; k < 2 * (n - r); ++k) second[k] = 0.5 * (second[k] + second[k + 2]);
      }
    }
    benchmark::DoNotOptimize(room.data());
    benchmark::ClobberMemory();
  }
  ReportControlPoints(state, n);
}
BENCHMARK(PlainLoop)->Arg(3)->Arg(25);

void CutsAlone(benchmark::State& state) {
  const auto n = static_cast<int>(state.range(0));
  std::vector<double> room = RoomFor(FamilyCurve("uniform", n, 0));
  const int size = 2 * (n + 1);
  for (auto _ : state) {
    for (int piece = 1; piece <= kNumCuts; ++piece) {
      double* const first = room.data() + (2 * piece - 1) * size;
      CutBezier(n, 2, 0.5, room.data() + (piece - 1) * size, first, first + size);
    }
    benchmark::DoNotOptimize(room.data());
    benchmark::ClobberMemory();
  }
  ReportControlPoints(state, n);
}
BENCHMARK(CutsAlone)->Arg(3)->Arg(25);

// All of Subdivide() with the rule `half`: scaling, stop tests, vertices. As many cuts as above.
void HalvingInRounds(benchmark::State& state) {
  const auto n = static_cast<int>(state.range(0));
  const BezierCurve curve = FamilyCurve("uniform", n, 0);
  SubdivisionOptions options;
  options.mode = SubdivisionMode::kUniform;
  options.max_depth = kRounds;
  options.relative_tolerance = 0.0;
  Subdivision result;
  std::string error;
  for (auto _ : state) {
    CHECK(Subdivide(curve, CutChoice(), options, &result, &error)) << error;
    benchmark::DoNotOptimize(result.vertices.data());
  }
  CHECK_EQ(result.cuts, kNumCuts);
  ReportControlPoints(state, n);
}
BENCHMARK(HalvingInRounds)->Arg(3)->Arg(25);

// Allocations of a whole subdivision at 1e-5 and at 1e-9, with a hundred times as many cuts.
void Allocations(benchmark::State& state, const char* rule_name) {
  const BezierCurve curve = FamilyCurve("walk", 12, 0);
  NameSpec spec;
  std::string error;
  CHECK(ParseNameSpec(rule_name, &spec, &error)) << error;
  const std::unique_ptr<CutRule> rule = CutRuleRegistry::Global().Make(spec, nullptr, &error);
  SubdivisionOptions options;
  options.relative_tolerance = state.range(0) == 5 ? 1e-5 : 1e-9;
  Subdivision result;
  long before = 0, after = 0;
  for (auto _ : state) {
    before = num_allocations;
    CHECK(SubdivideBy(rule.get(), curve, options, &result, &error)) << error;
    after = num_allocations;
  }
  state.counters["allocations"] = static_cast<double>(after - before);
  state.counters["cuts"] = static_cast<double>(result.cuts);
}
BENCHMARK_CAPTURE(Allocations, half, "half")->Arg(5)->Arg(9);
BENCHMARK_CAPTURE(Allocations, longest, "longest")->Arg(5)->Arg(9);

/// Fifty curves of each family.
std::vector<BezierCurve> SomeCurves(int degree) {
  constexpr int kCurves = 50;
  std::vector<BezierCurve> curves;
  for (const std::string& family : CurveFamilies()) {
    for (int k = 0; k < kCurves; ++k) curves.push_back(FamilyCurve(family, degree, k));
  }
  return curves;
}

// By the certified stop, so that every result is within the tolerance.
void Rule(benchmark::State& state, const char* rule_name) {
  NameSpec spec;
  std::string error;
  CHECK(ParseNameSpec(rule_name, &spec, &error)) << error;
  const std::unique_ptr<CutRule> rule = CutRuleRegistry::Global().Make(spec, nullptr, &error);
  const std::vector<BezierCurve> curves = SomeCurves(static_cast<int>(state.range(0)));
  SubdivisionOptions options;
  options.stop = StopMeasure::kPolygon;
  Subdivision result;
  double pieces = 0.0;
  for (auto _ : state) {
    pieces = 0.0;
    for (const BezierCurve& curve : curves) {
      CHECK(SubdivideBy(rule.get(), curve, options, &result, &error)) << error;
      pieces += result.num_pieces();
    }
  }
  state.counters["pieces"] = pieces;
}
BENCHMARK_CAPTURE(Rule, half, "half")->Arg(3)->Arg(6)->Arg(12)->Arg(16)->Arg(20)->Arg(25);
BENCHMARK_CAPTURE(Rule, longest, "longest")->Arg(3)->Arg(6)->Arg(12)->Arg(16)->Arg(20)->Arg(25);
BENCHMARK_CAPTURE(Rule, share, "share")->Arg(3)->Arg(6)->Arg(12)->Arg(16)->Arg(20)->Arg(25);

using Flattener = std::function<void(const BezierCurve&, double, std::vector<double>*)>;

/// A curve's certified error over its box, and its pieces.
struct Flattened {
  double error = 0.0;
  double pieces = 0.0;
};
Flattened Judge(const BezierCurve& curve, const Flattener& flatten, double tolerance, double size) {
  std::vector<double> parameters;
  flatten(curve, tolerance, &parameters);
  Points vertices(parameters.size(), 2);
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    curve.Evaluate(parameters[k], vertices.data() + 2 * k);
  }
  const Eigen::Map<const Eigen::VectorXd> t(parameters.data(),
                                            static_cast<Eigen::Index>(parameters.size()));
  return {BoundHausdorffDistance(curve, t, vertices).upper / size,
          static_cast<double>(parameters.size()) - 1.0};
}

/// The largest tolerance that leaves a true error of at most `wanted`, of tolerances 2 % apart:
/// what a method calls its tolerance is not always what it keeps.
double FairTolerance(const BezierCurve& curve, const Flattener& flatten, double wanted,
                     double size) {
  constexpr double kFactor = 1.02;
  constexpr double kHighest = 4.0;
  double tolerance = kHighest * wanted * size;
  while (Judge(curve, flatten, tolerance, size).error > wanted) tolerance /= kFactor;
  return tolerance;
}

// Each method flattens each curve with the tolerance that brings its true error just below 1e-4 of
// the curve's box.
void AtEqualError(benchmark::State& state, const std::vector<BezierCurve>& curves,
                  const Flattener& flatten) {
  constexpr double kWanted = 1e-4;
  std::vector<double> tolerances;
  double pieces = 0.0, mean_error = 0.0;
  for (const BezierCurve& curve : curves) {
    const double size = BoxSide(curve.degree(), 2, curve.control_points().data());
    tolerances.push_back(FairTolerance(curve, flatten, kWanted, size));
    const Flattened found = Judge(curve, flatten, tolerances.back(), size);
    pieces += found.pieces;
    mean_error += found.error / static_cast<double>(curves.size());
  }
  std::vector<double> parameters;
  for (auto _ : state) {
    for (std::size_t k = 0; k < curves.size(); ++k) {
      parameters.clear();
      flatten(curves[k], tolerances[k], &parameters);
      benchmark::DoNotOptimize(parameters.data());
    }
  }
  state.counters["pieces"] = pieces;
  state.counters["mean_error"] = mean_error;
}

Flattener ByRule(const std::string& name, StopMeasure stop) {
  NameSpec spec;
  std::string error;
  CHECK(ParseNameSpec(name, &spec, &error)) << error;
  std::shared_ptr<CutRule> rule = CutRuleRegistry::Global().Make(spec, nullptr, &error);
  CHECK(rule != nullptr) << error;
  return [rule, stop](const BezierCurve& curve, double tolerance, std::vector<double>* parameters) {
    SubdivisionOptions options;
    options.stop = stop;
    options.reference_size = 1.0;
    options.relative_tolerance = tolerance;
    Subdivision result;
    std::string why;
    CHECK(SubdivideBy(rule.get(), curve, options, &result, &why)) << why;
    parameters->swap(result.parameters);
  };
}

std::vector<BezierCurve> Glyphs(const char* name) {
  std::vector<BezierCurve> curves;
  std::string error;
  CHECK(GlyphCurves(name, &curves, &error)) << error;
  return curves;
}

void Register(const std::string& set, const std::vector<BezierCurve>& curves,
              const std::vector<std::pair<std::string, Flattener>>& methods) {
  for (const auto& [name, flatten] : methods) {
    benchmark::RegisterBenchmark(("Flatten/" + set + "/" + name).c_str(),
                                 [curves, method = flatten](benchmark::State& state) {
                                   AtEqualError(state, curves, method);
                                 });
  }
}

void RegisterFlatteners() {
  const std::vector<std::pair<std::string, Flattener>> ours = {
      {"half_polygon", ByRule("half", StopMeasure::kPolygon)},
      {"longest_polygon", ByRule("longest", StopMeasure::kPolygon)},
      {"longest_segment", ByRule("longest", StopMeasure::kSegment)},
      {"wang", &FlattenByWang}};
  const auto with = [&ours](const char* name, Flattener flatten) {
    auto all = ours;
    all.emplace_back(name, std::move(flatten));
    return all;
  };
  constexpr int kCubic = 3;
  Register("quadratic_glyphs", Glyphs("noto_mono"), with("levien", &FlattenByLevien));
  Register("cubic_glyphs", Glyphs("ebgaramond_italic"), with("hain", &FlattenByHain));
  Register("random_cubics", SomeCurves(kCubic), with("hain", &FlattenByHain));
}

}  // namespace
}  // namespace batten

int main(int argc, char** argv) {
  batten::RegisterFlatteners();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
