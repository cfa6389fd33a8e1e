#ifndef BATTEN_BENCHMARKS_NOISY_LOOP_H_
#define BATTEN_BENCHMARKS_NOISY_LOOP_H_

#include <glog/logging.h>

#include <cmath>
#include <cstdint>
#include <ctime>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>

#include "problems/fit_problem.h"
#include "problems/objective.h"
#include "solvers/run_context.h"
#include "solvers/solver_registry.h"

namespace batten {

/// CPU time of this process. What runs in one thread is measured by it: without neighbours it is
/// the time on the wall, with some it does not count the time they were given.
inline double CpuSeconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Time on the wall, for what runs in several threads.
inline double WallSeconds() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Uniform on [-1, 1): SplitMix64 (Steele, Lea and Flood, OOPSLA 2014) at place `index`.
inline double Noise(std::uint64_t index) {
  std::uint64_t z = (index + 1) * 0x9E3779B97F4A7C15ULL;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  z ^= z >> 31;
  return static_cast<double>(z >> 11) * std::exp2(-52.0) - 1.0;
}

/// Two parabolas in place of a sine of period 1: no library's sine, so that peers.py makes the same
/// bits.
inline double Wave(double turns) {
  const double w = 2.0 * (turns - std::floor(turns)) - 1.0;
  return 4.0 * w * (std::abs(w) - 1.0);
}

/// Points in order around a loop, with noise and with their parameters on [0, 1), the first at 0.
/// peers.py makes the same ones in loop_data().
inline DataSet MakeNoisyLoop(int num_points) {
  DataSet data;
  data.name = "noisy_loop";
  data.points.resize(num_points, 2);
  data.parameters = Eigen::VectorXd(num_points);
  for (int i = 0; i < num_points; ++i) {
    const std::uint64_t index = 3 * static_cast<std::uint64_t>(i);
    const double t = i == 0 ? 0.0 : (i + 0.4 * Noise(index)) / num_points;
    (*data.parameters)[i] = t;
    data.points(i, 0) = 3.0 * Wave(t + 0.25) + 0.5 * Wave(5.0 * t) + 0.01 * Noise(index + 1);
    data.points(i, 1) = 2.0 * Wave(t) + 0.4 * Wave(7.0 * t) + 0.01 * Noise(index + 2);
  }
  return data;
}

/// A spline on uniform knots over [0, 1], at the parameters that came with the data.
inline std::unique_ptr<Problem> MakeLoopFit(DataSet data, int control_points, bool closed,
                                            int degree = 3) {
  FitSpec spec;
  spec.degree = degree;
  spec.closed = closed;
  spec.control_points = control_points;
  spec.parameters.reset();
  spec.domain = {0.0, 1.0};
  std::string error;
  std::unique_ptr<Problem> problem = MakeFitProblem(std::move(data), std::move(spec), &error);
  CHECK(problem != nullptr) << error;
  return problem;
}

/// The fit of MakeNoisyLoop(num_points), made at the first call and kept until the program ends.
inline const Problem& LoopFit(int num_points, int control_points, bool closed, int degree = 3) {
  using Key = std::tuple<int, int, bool, int>;
  static auto& kept = *new std::map<Key, std::unique_ptr<Problem>>();
  std::unique_ptr<Problem>& problem = kept[Key(num_points, control_points, closed, degree)];
  if (problem == nullptr) {
    problem = MakeLoopFit(MakeNoisyLoop(num_points), control_points, closed, degree);
  }
  return *problem;
}

/// Run control without control: never stops a solver, books nothing, costs nothing.
class IdleContext final : public RunContext {
 public:
  explicit IdleContext(int threads = 1) : threads_(threads) {}
  Status Iterate(const Eigen::VectorXd& /*x*/) override { return Status::kOk; }
  StopReason stop_reason() const override { return StopReason::kNotRun; }
  void Note(const std::string& /*name*/, const std::string& /*value*/) override {}
  void OffTheClock(const std::function<void()>& work) override { work(); }
  std::uint64_t seed() const override { return 1; }
  int threads() const override { return threads_; }

 private:
  int threads_;
};

/// The end of a direct solver alone, from the problem's start: rows are streamed, nothing is left
/// from a call before. `message`, if not null: what it says of its end.
inline Eigen::VectorXd SolveAlone(const Problem& problem, const std::string& solver_name,
                                  int threads = 1, std::string* message = nullptr) {
  std::string error;
  const std::unique_ptr<Solver> solver =
      SolverRegistry::Global().Make({solver_name, {}, nullptr}, nullptr, &error);
  CHECK(solver != nullptr) << error;
  Objective objective(&problem, nullptr);
  IdleContext context(threads);
  Eigen::VectorXd x = objective.start();
  const Outcome outcome = solver->Minimize(&objective, &context, &x);
  CHECK(outcome.reason == StopReason::kSolved) << outcome.message;
  if (message != nullptr) *message = outcome.message;
  return x;
}

}  // namespace batten

#endif  // BATTEN_BENCHMARKS_NOISY_LOOP_H_
