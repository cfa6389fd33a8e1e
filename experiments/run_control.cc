#include "experiments/run_control.h"

#include <sys/resource.h>
#include <sys/time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "experiments/kept_rows.h"
#include "problems/constraint_projection.h"
#include "problems/fit_problem.h"
#include "solvers/options_note.h"

namespace batten {
namespace {

double WallNow() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// By getrusage(): under a limit on processor time, as cells of benchmarks have, Linux advances
/// CLOCK_PROCESS_CPUTIME_ID only at its ticks, which most runs are shorter than.
double CpuNow() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

/// FNV-1a over the bits of x, a word at a time.
std::uint64_t HashPoint(const Eigen::VectorXd& x) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &x[i], sizeof(bits));
    hash = (hash ^ bits) * 1099511628211ULL;
    hash ^= hash >> 29;
  }
  return hash;
}

}  // namespace

void Stopwatch::Resume() {
  running_ = true;
  cpu_started_ = CpuNow();
  started_ = WallNow();
}

void Stopwatch::Pause() {
  if (!running_) return;
  seconds_ += WallNow() - started_;
  cpu_seconds_ += CpuNow() - cpu_started_;
  running_ = false;
}

double Stopwatch::SecondsNow() const { return seconds_ + (running_ ? WallNow() - started_ : 0.0); }

RunControl::RunControl(const Problem& problem, const RunSpec& spec, NativeRule rule,
                       RunResult* result)
    : problem_(problem),
      spec_(spec),
      rule_(rule),
      result_(result),
      reporter_(&problem, nullptr, Objective::Options{spec.compile}) {}

bool RunControl::Allow(Evaluation kind, const Eigen::VectorXd* x) {
  if (stop_reason_ != StopReason::kNotRun) {
    ++result_->calls_past_stop;
    return false;
  }
  if (InterruptRequested()) {
    stop_reason_ = StopReason::kInterrupted;
  } else if (watch_.SecondsNow() > spec_.max_seconds) {
    stop_reason_ = StopReason::kTimeLimit;
  }
  if (stop_reason_ != StopReason::kNotRun) return false;
  Counts& counts = result_->counts;
  switch (kind) {
    case Evaluation::kEnergy:
      ++counts.energy_calls;
      break;
    case Evaluation::kGradient:
      ++counts.gradient_calls;
      break;
    case Evaluation::kJacobian:
      ++counts.jacobian_calls;
      break;
    case Evaluation::kProduct:
      ++counts.products;
      break;
    case Evaluation::kProjection:
      ++counts.projections;
      break;
  }
  if (x != nullptr && kind != Evaluation::kProduct) {
    OffTheClock([this, x] {
      const std::uint64_t point = HashPoint(*x);
      points_.insert(point);
      AddToStream(point);
    });
  }
  return true;
}

void RunControl::OffTheClock(const std::function<void()>& work) {
  // Work inside work, as an evaluation there is, must not start the clocks again.
  const bool was_running = watch_.running();
  watch_.Pause();
  work();
  if (was_running) watch_.Resume();
}

void RunControl::Note(const std::string& name, const std::string& value) {
  auto& notes = result_->notes;
  std::pair<std::string, std::string> note(name, value);
  // It goes to terminals as it is.
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  std::replace_if(note.second.begin(), note.second.end(), is_control, ' ');
  // A wrapped solver is run many times: its last word stands, but all options that it ran with.
  const auto known = std::find_if(notes.begin(), notes.end(), [&](const auto& earlier) {
    return name == kOptionsThatRan ? earlier == note : earlier.first == name;
  });
  if (known == notes.end()) {
    notes.push_back(std::move(note));
  } else {
    known->second = std::move(note.second);
  }
}

Status RunControl::Iterate(const Eigen::VectorXd& x) { return BookAndCheck(x, true); }

Status RunControl::IterateOnTheWay(const Eigen::VectorXd& x) { return BookAndCheck(x, false); }

Status RunControl::BookAndCheck(const Eigen::VectorXd& x, bool may_be_the_end) {
  watch_.Pause();
  if (x.size() != reporter_.num_variables()) {
    throw std::logic_error("books " + std::to_string(x.size()) + " variables where there are " +
                           std::to_string(reporter_.num_variables()));
  }
  if (stop_reason_ != StopReason::kNotRun) ++result_->calls_past_stop;
  ++iteration_;
  AddToStream(HashPoint(x));
  Book(x);
  if (stop_reason_ == StopReason::kNotRun) stop_reason_ = CheckStop(row_);
  if (stop_reason_ == StopReason::kNotRun) {
    stop_reason_ = may_be_the_end ? CheckConverged(row_, x) : CheckLimit();
  }
  watch_.Resume();
  return stop_reason_ == StopReason::kNotRun ? Status::kOk : Status::kStop;
}

void RunControl::AddToStream(std::uint64_t point) {
  if (result_->stream_points > 0 && point == last_point_) return;
  last_point_ = point;
  ++result_->stream_points;
  result_->stream_hash = (result_->stream_hash ^ point) * 1099511628211ULL;
  constexpr long kFirstPrefix = 4;
  if (result_->stream_points == kFirstPrefix << result_->stream_prefixes.size()) {
    result_->stream_prefixes.push_back(result_->stream_hash);
  }
}

void RunControl::Book(const Eigen::VectorXd& x) {
  if (iteration_ == 0) result_->setup_seconds = watch_.seconds();
  const Units& units = problem_.units();
  double energy = 0.0;
  Eigen::VectorXd gradient;
  const double norm = Evaluate(x, &energy, &gradient, &row_.violation);
  const bool is_held = row_.violation <= kConstraintTolerance;
  row_.iteration = iteration_;
  row_.counts = result_->counts;
  row_.counts.distinct_points = static_cast<long>(points_.size());
  row_.seconds = watch_.seconds();
  row_.cpu_seconds = watch_.cpu_seconds();
  row_.energy = energy * units.energy;
  row_.gradient_norm = norm * units.gradient;
  row_.violation *= units.length;
  is_held_ = is_held;
  row_.step_norm = last_x_.size() == x.size() ? StepNorm(x) * units.length : 0.0;
  row_.term_energies.clear();
  if (spec_.keep_trace && problem_.terms().size() > 1) {
    row_.term_energies = reporter_.TermEnergies(x);
    for (double& part : row_.term_energies) part *= units.energy;
  }
  if (iteration_ == 0) {
    result_->start_energy = row_.energy;
    result_->start_gradient_norm = row_.gradient_norm;
    result_->gradient_floor = reporter_.GradientRoundingFloor(x) * units.gradient;
  }
  last_x_ = x;
  if (spec_.keep_trace) result_->trace.push_back(row_);
  if (spec_.keep_iterates || most_iterates_ > 0) KeepIterate(x);
  if (spec_.progress) spec_.progress(row_);
}

void RunControl::KeepIterate(const Eigen::VectorXd& x) {
  auto& kept = result_->iterates;
  kept.push_back({iteration_, reporter_.Expand(x)});
  if (most_iterates_ == 0 || kept.size() <= most_iterates_) return;
  std::vector<double> iterations;
  for (const auto& iterate : kept) iterations.push_back(iterate.iteration);
  kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(LeastMissed(iterations)));
}

double RunControl::StepNorm(const Eigen::VectorXd& x) const {
  const Eigen::VectorXd before = reporter_.Expand(last_x_);
  const Eigen::VectorXd now = reporter_.Expand(x);
  if (problem_.curve_fit() == nullptr) return (now - before).cwiseAbs().maxCoeff();
  const int d = problem_.curve_fit()->dimension();
  const Eigen::Index end = problem_.ranges().front().size;  // of the control points
  double largest = 0.0;
  for (Eigen::Index j = 0; j + d <= end; j += d) {
    largest = std::max(largest, (now.segment(j, d) - before.segment(j, d)).norm());
  }
  return largest;
}

StopReason RunControl::CheckStop(const TraceRow& row) {
  if (InterruptRequested()) return StopReason::kInterrupted;
  if (!std::isfinite(row.energy) || !std::isfinite(row.gradient_norm)) {
    return iteration_ == 0 ? StopReason::kNumericalFailure : StopReason::kDiverged;
  }
  // A method that converges may rise at first, but not by ten digits.
  constexpr double kDiverged = 1e10;
  // A start at a minimum of E that misses constraints has hardly a gradient to compare with;
  // inside, where data are of size 1, other gradients are of about that size.
  double usual = result_->start_gradient_norm;
  if (problem_.nonlinear_constraints() != nullptr)
    usual = std::max(usual, problem_.units().gradient);
  if (row.gradient_norm > kDiverged * usual &&
      row.gradient_norm > kDiverged * result_->gradient_floor) {
    return StopReason::kDiverged;
  }
  return StopReason::kNotRun;
}

StopReason RunControl::CheckConverged(const TraceRow& row, const Eigen::VectorXd& x) {
  if (rule_ == NativeRule::kDirect) return StopReason::kNotRun;
  if (!is_held_) return CheckLimit();
  const StopReason reason = ConvergedReason(row, x);
  if (reason == StopReason::kNotRun) return CheckLimit();
  // Steps that are small are so whatever g is.
  const bool holds = reason == StopReason::kStepSmall || !IsDrawnBack(row, x);
  return holds ? reason : CheckLimit();
}

/// Parameters past an end have no share in |g|, though E may fall where they move back: whether |g|
/// there no longer ends the run.
bool RunControl::IsDrawnBack(const TraceRow& row, const Eigen::VectorXd& x) {
  Eigen::VectorXd seated = x;
  if (!reporter_.Seat(&seated)) return false;
  double energy = 0.0, violation = 0.0;
  Eigen::VectorXd gradient;
  TraceRow there = row;
  there.gradient_norm =
      Evaluate(seated, &energy, &gradient, &violation) * problem_.units().gradient;
  return ConvergedReason(there, seated) == StopReason::kNotRun;
}

/// kNotRun: it has not converged.
StopReason RunControl::ConvergedReason(const TraceRow& row, const Eigen::VectorXd& x) {
  if (spec_.mode == Mode::kRace) {
    if (row.gradient_norm <= spec_.gradient_tolerance * result_->start_gradient_norm) {
      return StopReason::kGradientSmall;
    }
  } else if (rule_ == NativeRule::kStep) {
    if (iteration_ > 0 && row.step_norm < spec_.native_step) return StopReason::kStepSmall;
  } else if (row.gradient_norm < spec_.native_gradient) {
    return StopReason::kGradientSmall;
  }
  // The floor belongs to the point; near the one of the start it is looked at again.
  constexpr double kNear = 16.0;
  if (row.gradient_norm <= kNear * result_->gradient_floor) {
    result_->gradient_floor = reporter_.GradientRoundingFloor(x) * problem_.units().gradient;
    if (row.gradient_norm <= result_->gradient_floor) return StopReason::kRoundingFloor;
  }
  return StopReason::kNotRun;
}

StopReason RunControl::CheckLimit() const {
  if (iteration_ >= spec_.max_iterations) return StopReason::kIterationLimit;
  if (watch_.seconds() > spec_.max_seconds) return StopReason::kTimeLimit;
  return StopReason::kNotRun;
}

/// |g|, as inside. NaN where E or g has no value; so is E where it has none itself.
double RunControl::Evaluate(const Eigen::VectorXd& x, double* energy, Eigen::VectorXd* gradient,
                            double* violation) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  *energy = kNan;
  *violation = 0.0;
  if (!x.allFinite()) return kNan;
  if (reporter_.EnergyAndGradient(x, energy, gradient) != Status::kOk) {
    // A sum over some of the terms is no E.
    if (reporter_.Energy(x, energy) != Status::kOk) *energy = kNan;
    return kNan;
  }
  if (problem_.nonlinear_constraints() == nullptr) return gradient->norm();
  const Eigen::VectorXd all = reporter_.Expand(x);
  *violation = MeasureViolation(problem_, all).largest;
  LagrangianGradient lagrangian;
  if (!MakeLagrangianGradient(problem_, all, *gradient, &lagrangian)) return kNan;
  gradient->swap(lagrangian.gradient);
  return gradient->norm();
}

/// For runs that ended before their set-up was done.
void RunControl::BookStart() {
  Eigen::VectorXd gradient;
  double violation = 0.0;
  const double norm = Evaluate(reporter_.start(), &result_->start_energy, &gradient, &violation);
  result_->start_energy *= problem_.units().energy;
  result_->start_gradient_norm = norm * problem_.units().gradient;
}

/// The step that is best along -g lowers E by |g|^2 / (2 q), q = g'Hg / g'g.
double RunControl::LineSearchFloor(const Eigen::VectorXd& x, double energy,
                                   const Eigen::VectorXd& gradient) {
  const double squared_norm = gradient.squaredNorm();
  Eigen::VectorXd product;
  if (squared_norm == 0.0) return 0.0;
  if (reporter_.HessianTimes(x, gradient, &product) != Status::kOk) return 0.0;
  const double curvature = gradient.dot(product) / squared_norm;
  // Both ends of the step carry the rounding, and the best step falls by |g|^2 / (2 curvature).
  const double noise = 2.0 * Objective::EnergyRoundingFloor(energy, reporter_.ResidualSize(x));
  return curvature > 0.0 ? std::sqrt(2.0 * curvature * noise) : 0.0;
}

void RunControl::Finish(const Eigen::VectorXd& x) {
  watch_.Pause();
  const Units& units = problem_.units();
  double energy = 0.0;
  Eigen::VectorXd gradient;
  const double norm = Evaluate(x, &energy, &gradient, &result_->violation);
  result_->violation *= units.length;
  if (iteration_ < 0) BookStart();
  result_->x = reporter_.Expand(x);
  result_->energy = energy * units.energy;
  result_->gradient_norm = norm * units.gradient;
  const bool finite = !std::isnan(norm);
  if (finite) result_->gradient_floor = reporter_.GradientRoundingFloor(x) * units.gradient;
  const StopReason reason = result_->outcome.reason;
  if (finite && (reason == StopReason::kLineSearchEnded || reason == StopReason::kNativeStop)) {
    result_->line_search_floor = LineSearchFloor(x, energy, gradient) * units.gradient;
  }
  result_->iterations = std::max(iteration_, 0);
  result_->counts.distinct_points = static_cast<long>(points_.size());
  result_->seconds = watch_.seconds();
  result_->cpu_seconds = watch_.cpu_seconds();
}

}  // namespace batten
