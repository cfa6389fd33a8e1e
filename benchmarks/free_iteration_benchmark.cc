// Free parameters: what one iteration costs per data point on one core, of whole solvers and of the
// parts of lm_schur's. Prints Markdown tables.

#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include "benchmarks/noisy_loop.h"
#include "problems/objective.h"
#include "solvers/foot_model.h"
#include "solvers/solver_registry.h"
#include "solvers/stepper.h"

namespace batten {
namespace {

/// A bent loop with noise, free parameters from the data's own.
std::unique_ptr<Problem> FreeLoop(int m, int n) {
  DataSet data;
  data.points.resize(m, 2);
  for (int i = 0; i < m; ++i) {
    const double a = 2.0 * M_PI * i / m;
    const double r = 1.0 + 0.3 * std::cos(3.0 * a + 0.7) + 0.01 * std::sin(977.0 * i);
    data.points.row(i) << r * std::cos(a), r * std::sin(a);
  }
  FitSpec spec;
  spec.closed = true;
  spec.control_points = n;
  spec.parameter_kind = ParameterKind::kFree;
  std::string error;
  std::unique_ptr<Problem> problem = MakeFitProblem(std::move(data), spec, &error);
  CHECK(problem != nullptr) << error;
  return problem;
}

int ControlPointsFor(int m) { return m < 100'000 ? 20 : m / 1000; }

/// Whole iterations behind the first two, whose memory is new: trial steps that are refused and
/// searches for feet count where they are made.
void PrintSolverRow(const std::string& solver_name, int m) {
  constexpr int kWarmUp = 2;
  constexpr int kMostIterations = 20;
  const auto problem = FreeLoop(m, ControlPointsFor(m));
  std::string error;
  NameSpec spec;
  CHECK(ParseNameSpec(solver_name, &spec, &error)) << error;
  // Small problems are run again, from the start, until the clock can tell.
  const int rounds = std::max(1, 200'000 / m);
  double seconds = 0.0;
  int iterations = 0;
  for (int round = 0; round < rounds; ++round) {
    const std::unique_ptr<Solver> solver = SolverRegistry::Global().Make(spec, nullptr, &error);
    auto* const stepper = dynamic_cast<Stepper*>(solver.get());
    CHECK(stepper != nullptr) << solver_name << " " << error;
    Objective objective(problem.get(), nullptr);
    IdleContext context;
    Eigen::VectorXd x = objective.start();
    bool ended = stepper->Start(&objective, &context, &x).has_value();
    for (int k = 0; k < kWarmUp && !ended; ++k) ended = stepper->Step(&x).has_value();
    for (int k = 0; k < kMostIterations && !ended; ++k) {
      const double start = CpuSeconds();
      ended = stepper->Step(&x).has_value();
      if (ended) break;  // no whole one
      seconds += CpuSeconds() - start;
      ++iterations;
    }
  }
  std::printf("| `%s` | %d | %d | %d | %.1f |\n", solver_name.c_str(), m, ControlPointsFor(m),
              iterations / rounds, 1e9 * seconds / iterations / m);
  std::fflush(stdout);
}

void WholeIterations() {
  std::printf(
      "| solver | points | control points | iterations | ns per point and iteration |\n"
      "|---|---|---|---|---|\n");
  for (const int m : {1000, 10'000, 100'000, 1'000'000}) PrintSolverRow("lm_schur", m);
  for (const char* solver : {"newton", "foot_newton"}) PrintSolverRow(solver, 100'000);
}

/// Sums, factorization and the parameters' steps: an iteration of lm_schur whose step is taken.
void PartsOfAnIteration() {
  std::printf(
      "\n| points | control points | sums, ns per point | steps | factor | together |\n"
      "|---|---|---|---|---|---|\n");
  for (const int m : {1000, 10'000, 100'000, 1'000'000}) {
    const int n = ControlPointsFor(m);
    const auto problem = FreeLoop(m, n);
    const Objective objective(problem.get(), nullptr);
    FootModel model(*objective.free_view(), 1);
    const Eigen::VectorXd x = objective.start();
    Eigen::VectorXd step, next;
    const int rounds = std::max(3, 3'000'000 / m);
    double parts[3] = {};
    for (int round = -1; round < rounds; ++round) {
      const double t0 = CpuSeconds();
      model.Sum(x, FootModelKind::kTangent, 1e-3);
      const double t1 = CpuSeconds();
      model.Factor(1e-3);
      model.Solve(&step);
      const double t2 = CpuSeconds();
      model.Move(x, step, &next);
      const double t3 = CpuSeconds();
      if (round < 0) continue;  // caches
      parts[0] += t1 - t0;
      parts[1] += t3 - t2;
      parts[2] += t2 - t1;
    }
    for (double& part : parts) part *= 1e9 / rounds / m;
    std::printf("| %d | %d | %.1f | %.1f | %.1f | %.1f |\n", m, n, parts[0], parts[1], parts[2],
                parts[0] + parts[1] + parts[2]);
  }
}

}  // namespace
}  // namespace batten

int main(int argc, char** argv) {
  if (argc > 1) {
    std::fprintf(stderr, "free_iteration_benchmark: found \"%s\"; it takes no arguments\n",
                 argv[1]);
    return 2;
  }
  std::printf(
      "One iteration per data point, one core, closed cubic in the plane; the goal is 20 ns, with "
      "60 at most.\n\n");
  batten::WholeIterations();
  std::printf("\nThe parts of an iteration of `lm_schur`:\n");
  batten::PartsOfAnIteration();
  return 0;
}
