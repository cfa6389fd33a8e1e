#include "experiments/plugin_faults.h"

#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <functional>
#include <limits>
#include <random>

#include "cost_functions/options.h"
#include "experiments/child_process.h"
#include "experiments/guarded_vector.h"
#include "experiments/taylor_slope.h"
#include "problems/fit_problem.h"
#include "solvers/plugin_loader.h"
#include "solvers/solver_registry.h"
#include "solvers/stopping_context.h"

namespace batten {
namespace {

bool PluginHas(const std::string& kind, const std::string& name) {
  for (const LoadedPlugin& plugin : LoadedPlugins()) {
    for (const PluginName& one : plugin.names) {
      if (one.kind == kind && one.name == name) return true;
    }
  }
  return false;
}

/// The E of one term near a point; not a number where it has none.
class TermAt {
 public:
  TermAt(const BlockFamily& family, Eigen::VectorXd x) : family_(family), x_(std::move(x)) {
    gradient_ = Eigen::VectorXd::Zero(x_.size());
    has_value_ = family_.Evaluate(x_, 0, family_.size(), &energy_, &gradient_) == Status::kOk;
  }
  bool has_value() const { return has_value_; }

  /// A direction along which there is no E tells nothing.
  bool IsWrongAlong(const Eigen::VectorXd& v, double energy_noise) const {
    const double slope = gradient_.dot(v);
    constexpr double kRoundings = 1e3 * std::numeric_limits<double>::epsilon();
    const double noise = energy_noise + kRoundings * (std::abs(energy_) + std::abs(slope));
    const TaylorSlope taylor = MeasureTaylorSlope(
        [&](double h) { return EnergyAt(x_ + h * v) - energy_ - h * slope; }, noise);
    return std::isfinite(taylor.slope) && !IsRightDerivative(taylor);
  }

 private:
  double EnergyAt(const Eigen::VectorXd& x) const {
    double energy = 0.0;
    const Status status = family_.Evaluate(x, 0, family_.size(), &energy, nullptr);
    return status == Status::kOk ? energy : std::numeric_limits<double>::quiet_NaN();
  }

  const BlockFamily& family_;
  Eigen::VectorXd x_;
  Eigen::VectorXd gradient_;
  double energy_ = 0.0;
  bool has_value_ = false;
};

/// Of length 1, without any pattern. Parameters stay where they are on polygons, whose E has kinks
/// in them.
Eigen::VectorXd Direction(const Problem& problem, std::mt19937* random) {
  const CurveFit* const fit = problem.curve_fit();
  const bool moves_all = fit == nullptr || fit->basis().degree() > 1;
  const Eigen::Index size =
      moves_all ? problem.num_variables() : problem.ranges().front().size;  // control points
  Eigen::VectorXd v = Eigen::VectorXd::Zero(problem.num_variables());
  std::uniform_real_distribution<double> entry(-1.0, 1.0);
  for (double& one : v.head(size)) one = entry(*random);
  return v.normalized();
}

/// What rounding does to E, all terms together.
double EnergyNoise(const Problem& problem, const Eigen::VectorXd& x) {
  const Objective objective(&problem, nullptr);
  const Eigen::VectorXd free = problem.elimination().FreeVariables(x);
  double energy = 0.0;
  for (const double part : objective.TermEnergies(free)) energy += part;
  return Objective::EnergyRoundingFloor(energy, objective.ResidualSize(free));
}

bool IsWrongNear(const Problem& problem, const BlockFamily& family, const Eigen::VectorXd& x) {
  std::mt19937 random(1);
  // Ends of runs like to lie at kinks.
  constexpr double kAside = 1e-3;
  const Eigen::VectorXd aside = x + kAside * Direction(problem, &random);
  const TermAt term(family, aside);
  const double noise = EnergyNoise(problem, aside);
  if (!term.has_value() || !std::isfinite(noise)) return false;
  // A kink that one of them meets by chance is not met by the other.
  return term.IsWrongAlong(Direction(problem, &random), noise) &&
         term.IsWrongAlong(Direction(problem, &random), noise);
}

double SecondsOfEvaluation(const BlockFamily& family, const Eigen::VectorXd& x) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  double energy = 0.0;
  family.Evaluate(x, 0, family.size(), &energy, nullptr);
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// And the end; empty where nothing can be put behind x.
std::vector<Eigen::VectorXd> FirstIterates(const Problem& problem, const NameSpec& solver,
                                           const RunSpec& spec, double number_behind) {
  constexpr int kIterates = 3;
  StoppingContext context(kIterates, StoppingContext::kNever, spec.threads);
  Objective objective(&problem, &context, Objective::Options{spec.compile});
  GuardedVector x(objective.start());
  if (!x.works()) return {};
  x.SetNumbersBehind(number_behind);
  std::string error;
  SolverRegistry::Global()
      .Make(solver, nullptr, &error)
      ->Minimize(&objective, &context, x.vector());
  std::vector<Eigen::VectorXd> iterates = context.iterates();
  iterates.push_back(*x.vector());
  return iterates;
}

bool AreSame(const std::vector<Eigen::VectorXd>& a, const std::vector<Eigen::VectorXd>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& one, const auto& two) {
    return one.size() == two.size() &&
           std::memcmp(one.data(), two.data(), sizeof(double) * one.size()) == 0;
  });
}

constexpr char kSame[] = "same";
constexpr char kDiffers[] = "differs";

std::string CompareBehind(const Problem& problem, const NameSpec& solver, const RunSpec& spec) {
  const auto first = FirstIterates(problem, solver, spec, 0.0);
  const bool is_steady = AreSame(first, FirstIterates(problem, solver, spec, 0.0));
  const bool is_same = AreSame(first, FirstIterates(problem, solver, spec, std::nan("")));
  if (first.empty()) return "";
  if (is_same) return kSame;
  return is_steady ? kDiffers : "";
}

/// Evaluations and iterates asked for after a stop at an iterate, or at an evaluation: the more.
std::string CountPastStop(const Problem& problem, const NameSpec& solver, const RunSpec& spec) {
  constexpr int kIterates = 1;
  constexpr int kEvaluations = 3;
  int most = 0;
  for (const auto& [iterates, evaluations] :
       {std::pair{kIterates, StoppingContext::kNever}, {StoppingContext::kNever, kEvaluations}}) {
    StoppingContext context(iterates, evaluations, spec.threads);
    Objective objective(&problem, &context, Objective::Options{spec.compile});
    Eigen::VectorXd x = objective.start();
    std::string error;
    SolverRegistry::Global().Make(solver, nullptr, &error)->Minimize(&objective, &context, &x);
    most = std::max(most, context.asked_after_stop() + context.booked_after_stop());
  }
  return std::to_string(most);
}

/// What `work` answers in a process of its own within `max_seconds`; nothing where none can be
/// made.
std::optional<ChildEnd> Ask(const RunSpec& spec, double max_seconds,
                            const std::function<std::string()>& work) {
  ChildLimits limits;
  limits.wall_seconds = max_seconds;
  limits.cpu_seconds = std::max(1.0, max_seconds * spec.threads);
  return RunInChild(limits, work);
}

}  // namespace

bool IsOfPlugin(const NameSpec& solver) {
  return PluginHas("solver", solver.name) ||
         (solver.wrapped != nullptr && IsOfPlugin(*solver.wrapped));
}

bool HasTermOfPlugin(const std::vector<NameSpec>& terms) {
  return std::any_of(terms.begin(), terms.end(),
                     [](const NameSpec& term) { return PluginHas("term", term.name); });
}

std::string WhyNoReturn(const std::function<void()>& work) {
  ChildLimits limits;
  limits.wall_seconds = 10.0;
  limits.cpu_seconds = 2.0 * limits.wall_seconds;
  const std::optional<ChildEnd> end = RunInChild(limits, [&work] {
    work();
    return std::string();
  });
  return end.has_value() ? end->message : "";
}

std::optional<std::vector<std::string>> TermsWithWrongGradient(
    const Problem& problem, const std::vector<Eigen::VectorXd>& points, double max_seconds) {
  constexpr double kEvaluations = 50.0;  // gradients count for more than one
  std::vector<std::string> wrong;
  for (const Problem::TermInstance& term : problem.terms()) {
    if (!PluginHas("term", term.name.substr(0, term.name.find('/')))) continue;
    const double seconds = kEvaluations * SecondsOfEvaluation(*term.family, points.front());
    if (seconds * static_cast<double>(points.size()) > max_seconds) return std::nullopt;
    if (std::any_of(points.begin(), points.end(), [&](const Eigen::VectorXd& x) {
          return x.allFinite() && IsWrongNear(problem, *term.family, x);
        })) {
      wrong.push_back(term.name);
    }
  }
  return wrong;
}

std::optional<bool> ReadsPastX(const Problem& problem, const NameSpec& solver, const RunSpec& spec,
                               double max_seconds) {
  const std::optional<ChildEnd> asked =
      Ask(spec, max_seconds, [&] { return CompareBehind(problem, solver, spec); });
  if (!asked.has_value()) return std::nullopt;
  const ChildEnd& end = *asked;
  const int signal = WIFSIGNALED(end.wait_status) ? WTERMSIG(end.wait_status) : 0;
  if (signal == SIGSEGV || signal == SIGBUS) return true;
  if (end.answer == kSame) return false;
  if (end.answer == kDiffers) return true;
  return std::nullopt;
}

std::optional<int> CallsPastStop(const Problem& problem, const NameSpec& solver,
                                 const RunSpec& spec, double max_seconds) {
  const std::optional<ChildEnd> end =
      Ask(spec, max_seconds, [&] { return CountPastStop(problem, solver, spec); });
  double count = 0.0;
  if (!end.has_value() || !ParseNumber(end->answer, &count)) return std::nullopt;
  return static_cast<int>(count);
}

}  // namespace batten
