// Large fits with free parameters from a circle: iterations, seconds and memory to gaps of 1e-6 and
// 1e-10 to the lowest E that any of the methods finds, without a guard against loops and with one.
// Each run has a process of its own, so that its peak memory is its own. Prints a Markdown table.
//   large_free_benchmark [SECONDS] [THREADS] [METHOD...]
// most seconds per run (120), threads (2), methods (all of kMethods: 24 runs)

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "benchmarks/noisy_loop.h"
#include "experiments/fit_report.h"
#include "problems/fit_guard.h"

namespace batten {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

constexpr const char* kMethods[] = {"foot_newton", "newton",       "lm_schur",
                                    "tdm",         "anderson:pdm", "lbfgs"};

struct Case {
  int points;
  int control_points;
  const char* guard;  // empty: none
};

/// What a child process sends back, in this order; then `rows` trace rows.
struct Summary {
  double start_energy = 0.0;
  double energy_at_foot_points = 0.0;
  int loops = 0;
  int rows = 0;
  char stop[32] = {};
};

struct Row {
  int iteration = 0;
  double seconds = 0.0;
  double energy = 0.0;
};

struct Measured {
  std::string solver;
  Summary summary;
  std::vector<Row> trace;
  double peak_mebibytes = 0.0;
};

std::unique_ptr<Problem> LoopFromCircle(const Case& which) {
  DataSet data = MakeNoisyLoop(which.points);
  data.parameters.reset();
  FitSpec spec;
  spec.closed = true;
  spec.control_points = which.control_points;
  spec.parameter_kind = ParameterKind::kFree;
  spec.start = "circle";
  std::string error;
  if (*which.guard != '\0') {
    spec.guard.emplace();
    spec.guard->name = which.guard;
  }
  std::unique_ptr<Problem> problem = MakeFitProblem(std::move(data), spec, &error);
  CHECK(problem != nullptr) << error;
  return problem;
}

void WriteAll(int pipe, const void* bytes, std::size_t count) {
  const char* next = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t written = write(pipe, next, count);
    CHECK_GT(written, 0);
    next += written;
    count -= static_cast<std::size_t>(written);
  }
}

bool ReadAll(int pipe, void* bytes, std::size_t count) {
  char* next = static_cast<char*>(bytes);
  while (count > 0) {
    const ssize_t got = read(pipe, next, count);
    if (got <= 0) return false;
    next += got;
    count -= static_cast<std::size_t>(got);
  }
  return true;
}

void RunInChild(const Case& which, const std::string& solver, double most_seconds, int threads,
                int pipe) {
  const auto problem = LoopFromCircle(which);
  RunSpec spec;
  spec.gradient_tolerance = 0.0;
  spec.max_iterations = 1'000'000;
  spec.max_seconds = most_seconds;
  spec.threads = threads;
  NameSpec name;
  std::string error;
  RunResult run;
  CHECK(ParseNameSpec(solver, &name, &error) && Run(*problem, name, spec, &run, &error)) << error;
  CHECK(run.skipped.empty()) << run.skipped;
  // The peak of the run: what measures the end comes after it.
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const double mebibytes = static_cast<double>(usage.ru_maxrss) / 1024.0;
  const FitReport report = MeasureFit(*problem, run, spec);
  Summary summary;
  summary.start_energy = run.start_energy;
  summary.energy_at_foot_points = report.energy_at_foot_points;
  summary.loops = report.shape->num_free_loops;
  summary.rows = static_cast<int>(run.trace.size());
  std::snprintf(summary.stop, sizeof(summary.stop), "%s", ToString(run.outcome.reason));
  WriteAll(pipe, &summary, sizeof(summary));
  WriteAll(pipe, &mebibytes, sizeof(mebibytes));
  for (const TraceRow& row : run.trace) {
    const Row sent = {row.iteration, row.seconds, row.energy};
    WriteAll(pipe, &sent, sizeof(sent));
  }
}

Measured RunAlone(const Case& which, const std::string& solver, double most_seconds, int threads) {
  Measured measured;
  measured.solver = solver;
  int pipe_ends[2];
  CHECK_EQ(pipe(pipe_ends), 0);
  std::fflush(stdout);
  const pid_t child = fork();
  CHECK_GE(child, 0);
  if (child == 0) {
    close(pipe_ends[0]);
    RunInChild(which, solver, most_seconds, threads, pipe_ends[1]);
    _exit(0);
  }
  close(pipe_ends[1]);
  CHECK(ReadAll(pipe_ends[0], &measured.summary, sizeof(Summary))) << solver << " ended early";
  CHECK(ReadAll(pipe_ends[0], &measured.peak_mebibytes, sizeof(double)));
  measured.trace.resize(static_cast<std::size_t>(measured.summary.rows));
  CHECK(ReadAll(pipe_ends[0], measured.trace.data(), measured.trace.size() * sizeof(Row)));
  close(pipe_ends[0]);
  waitpid(child, nullptr, 0);
  return measured;
}

/// "605 (58 s)", or "-" where the gap is not reached, or no minimum is known.
std::string Reached(const Measured& measured, double minimum, double gap) {
  const double start = measured.summary.start_energy;
  if (std::isnan(minimum)) return "-";
  for (const Row& row : measured.trace) {
    if (row.energy - minimum > gap * (start - minimum)) continue;
    char text[64];
    std::snprintf(text, sizeof(text), "%d (%.3g s)", row.iteration, row.seconds);
    return text;
  }
  return "-";
}

void Measure(const Case& which, const std::vector<std::string>& methods, double most_seconds,
             int threads) {
  std::vector<Measured> all;
  double minimum = kInfinity;
  bool is_end = false;
  for (const std::string& solver : methods) {
    all.push_back(RunAlone(which, solver, most_seconds, threads));
    const double end = all.back().trace.back().energy;
    if (end < minimum) is_end = std::string(all.back().summary.stop) != "time_limit";
    minimum = std::min(minimum, end);
  }
  // Where the time cut the lowest run off, nobody knows how far down it goes.
  if (!is_end) minimum = std::nan("");
  for (const Measured& one : all) {
    const Row& last = one.trace.back();
    std::printf("| %d | %d | %s | `%s` | %s | %s | %d | %.3g | %s | %.10g | %d | %.0f |\n",
                which.points, which.control_points, *which.guard == '\0' ? "none" : which.guard,
                one.solver.c_str(), Reached(one, minimum, 1e-6).c_str(),
                Reached(one, minimum, 1e-10).c_str(), last.iteration, last.seconds,
                one.summary.stop, one.summary.energy_at_foot_points, one.summary.loops,
                one.peak_mebibytes);
  }
  std::fflush(stdout);
}

[[noreturn]] void Fail(const std::string& why) {
  std::fprintf(stderr,
               "large_free_benchmark: %s; usage: large_free_benchmark [SECONDS [THREADS "
               "[SOLVER...]]]\n",
               why.c_str());
  std::exit(2);
}

double PositiveNumber(const char* text, const std::string& what) {
  char* end = nullptr;
  const double value = std::strtod(text, &end);
  if (*text == '\0' || *end != '\0' || !(value > 0.0) || !std::isfinite(value)) {
    Fail(what + ": found \"" + text + "\"; allowed: numbers above 0");
  }
  return value;
}

void CheckMethod(const std::string& method) {
  NameSpec name;
  std::string error;
  if (!ParseNameSpec(method, &name, &error) ||
      SolverRegistry::Global().Make(name, nullptr, &error) == nullptr) {
    Fail(error);
  }
}

}  // namespace
}  // namespace batten

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? batten::PositiveNumber(argv[1], "SECONDS") : 120.0;
  constexpr double kMostThreads = 1024.0;
  const int threads = argc > 2 ? static_cast<int>(std::ceil(std::min(
                                     batten::PositiveNumber(argv[2], "THREADS"), kMostThreads)))
                               : 2;
  std::vector<std::string> methods(argv + std::min(argc, 3), argv + argc);
  for (const std::string& method : methods) batten::CheckMethod(method);
  if (methods.empty()) methods.assign(std::begin(batten::kMethods), std::end(batten::kMethods));
  std::printf(
      "# Large fits with free parameters\n\nA closed cubic from a circle around a noisy loop, %d "
      "threads, at most %g s a run. Gaps are to the lowest E of the same problem in "
      "this table, if the run that has it was not cut off.\n\n"
      "| points | control points | guard | method | iterations to gap 1e-6 | to 1e-10 | iterations "
      "in all | seconds | end | E at feet | free loops | peak MiB |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|\n",
      threads, seconds);
  using batten::Case;
  for (const Case which : {Case{100'000, 100, ""}, Case{100'000, 100, "bending"},
                           Case{1'000'000, 1000, ""}, Case{1'000'000, 1000, "bending"}}) {
    batten::Measure(which, methods, seconds, threads);
  }
  return 0;
}
