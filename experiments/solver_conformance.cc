#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>

#include "experiments/conformance.h"
#include "experiments/conformance_fits.h"
#include "experiments/fit_report.h"
#include "experiments/guarded_vector.h"
#include "experiments/identity_card.h"
#include "experiments/run.h"
#include "solvers/solver_registry.h"
#include "solvers/stopping_context.h"

namespace batten {
namespace {

constexpr int kNever = StoppingContext::kNever;
constexpr int kFewIterations = 20;

bool SameBits(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return a.size() == b.size() &&
         (a.size() == 0 || std::memcmp(a.data(), b.data(), sizeof(double) * a.size()) == 0);
}

NameSpec Parsed(const std::string& text) {
  NameSpec name;
  std::string error;
  ParseNameSpec(text, &name, &error);
  return name;
}

/// Null with one sentence in `error`.
std::unique_ptr<Solver> Make(const std::string& name, std::string* error) {
  return SolverRegistry::Global().Make(Parsed(name), nullptr, error);
}

/// A problem with the solver as it is written for it.
struct Supported {
  std::string name;
  std::unique_ptr<Problem> problem;
};

std::vector<Supported> SupportedOf(const std::string& solver, std::vector<ExampleProblem> all) {
  std::vector<Supported> supported;
  std::string error;
  for (ExampleProblem& example : all) {
    const std::unique_ptr<Solver> made = Make(solver, &error);
    if (made == nullptr) continue;
    if (!made->WhyUnsupported(Objective(example.problem.get(), nullptr)).empty()) continue;
    supported.push_back({example.name, std::move(example.problem)});
  }
  return supported;
}

std::string UsualName(const std::string& registered) {
  return SolverRegistry::Global().UsualName(registered);
}

CheckVerdict ChecksDescription(const std::string& registered) {
  const SolverInfo& info = *SolverRegistry::Global().Find(registered);
  if (info.summary.empty() || info.summary.find('\n') != std::string::npos) {
    return Failed("its summary is not one line");
  }
  if (info.source.empty()) return Failed("it names no source");
  std::string error;
  const std::unique_ptr<Solver> made = Make(UsualName(registered), &error);
  if (made == nullptr) return Failed(error);
  if (made->Info().name != registered) {
    return Failed("it calls itself " + made->Info().name + ", registered as " + registered);
  }
  for (const OptionInfo& option : info.options) {
    if (option.help.empty()) return Failed("option " + option.name + " has no help");
  }
  return {true, "options: " + std::to_string(info.options.size())};
}

/// All options at their defaults, and each at both ends of its range and at each word.
std::vector<std::string> OptionTexts(const std::vector<OptionInfo>& options) {
  std::vector<std::string> texts = {""};
  for (const OptionInfo& option : options) {
    std::vector<std::string> values = option.words;
    if (option.kind != OptionInfo::Kind::kWord) {
      for (const double value : {option.lowest, option.highest}) {
        if (std::isfinite(value)) values.push_back(NumberText(value));
      }
    }
    for (const std::string& value : values) texts.push_back("/" + option.name + "=" + value);
  }
  return texts;
}

CheckVerdict ChecksOptions(const std::string& registered) {
  const SolverInfo& info = *SolverRegistry::Global().Find(registered);
  const std::string usual = UsualName(registered);
  const std::string wrapped = usual.substr(registered.size());
  std::string error;
  if (Make(registered + "/no_such_option=1" + wrapped, &error) != nullptr) {
    return Failed("it takes an option that it has not announced");
  }
  int num_runs = 0;
  for (const std::string& option : OptionTexts(info.options)) {
    const std::string name = registered + option + wrapped;
    if (Make(name, &error) == nullptr) return Failed(name + ": " + error);
    for (const Supported& row : SupportedOf(name, ExampleProblems())) {
      StoppingContext context(2, kNever);
      Objective objective(row.problem.get(), &context);
      Eigen::VectorXd x = objective.start();
      Make(name, &error)->Minimize(&objective, &context, &x);
      if (!x.allFinite()) return Failed(name + " leaves no numbers" + InText(row.name));
      RunResult run;
      run.solver = Parsed(name);
      run.notes = context.notes();
      const std::string other = OptionsThatDiffer(run);
      if (!other.empty()) return Failed(name + " ran with other options: " + other);
      ++num_runs;
    }
  }
  return {true, std::to_string(num_runs) + " runs"};
}

/// One run under run control.
RunResult RunOf(const Problem& problem, const std::string& solver, RunSpec* spec) {
  constexpr double kOfTheUsual = 5.0;
  constexpr double kOfAVariant = 0.2;  // there may be many, and slow ones
  spec->max_iterations = 500;
  spec->max_seconds = Parsed(solver).options.empty() ? kOfTheUsual : kOfAVariant;
  RunResult result;
  std::string error;
  if (!Run(problem, Parsed(solver), *spec, &result, &error)) result.skipped = error;
  return result;
}

CheckVerdict ChecksDescent(const std::string& solver) {
  const std::vector<Supported> supported = SupportedOf(solver, ExampleProblems());
  if (supported.empty()) return Failed("it takes none of the example problems");
  std::string names;
  for (const Supported& row : supported) {
    RunSpec spec;
    const RunResult result = RunOf(*row.problem, solver, &spec);
    const std::string at = InText(row.name);
    if (!result.x.allFinite() || !std::isfinite(result.energy)) {
      return Failed("it ends where E is no number" + at);
    }
    if (result.outcome.reason == StopReason::kNumericalFailure ||
        result.outcome.reason == StopReason::kNotRun) {
      const std::string& message = result.outcome.message;
      return Failed(std::string("it ends with ") + ToString(result.outcome.reason) + at +
                    (message.empty() ? "" : ": " + message));
    }
    // A start that is the minimum already may be left by a rounding.
    constexpr double kRounding = 1e-12;
    if (result.energy > result.start_energy * (1.0 + kRounding)) {
      return Failed("E rises from " + NumberText(result.start_energy) + " to " +
                    NumberText(result.energy) + at);
    }
    if (result.trace.empty() || result.trace.front().iteration != 0) {
      return Failed("it does not book its start" + at);
    }
    names += (names.empty() ? "" : "; ") + row.name;
  }
  return {true, names};
}

CheckVerdict ChecksClaims(const std::string& solver) {
  int num_audited = 0;
  for (const Supported& row : SupportedOf(solver, ExampleProblems())) {
    RunSpec spec;
    const RunResult result = RunOf(*row.problem, solver, &spec);
    const FitReport report = MeasureFit(*row.problem, result, spec);
    if (!report.audited) continue;
    ++num_audited;
    if (!report.verdict.holds) return Failed(report.verdict.failure + InText(row.name));
    // What only run control may say, it must have said.
    const double target = 2.0 * spec.gradient_tolerance * result.start_gradient_norm;
    if (result.outcome.reason == StopReason::kGradientSmall && result.gradient_norm > target) {
      return Failed("it says gradient_small at |g| = " + NumberText(result.gradient_norm) +
                    InText(row.name));
    }
  }
  return {true, std::to_string(num_audited) + " runs audited"};
}

Outcome MinimizeFrom(const Supported& row, const std::string& solver, StoppingContext* context,
                     Eigen::VectorXd* x) {
  Objective objective(row.problem.get(), context);
  std::string error;
  return Make(solver, &error)->Minimize(&objective, context, x);
}

Eigen::VectorXd StartOf(const Supported& row) {
  return Objective(row.problem.get(), nullptr).start();
}

std::string AskedAfterStop(const StoppingContext& context) {
  return "asks for " + std::to_string(context.asked_after_stop()) + " evaluations and books " +
         std::to_string(context.booked_after_stop()) + " iterates after a stop";
}

CheckVerdict ChecksStopAtIterate(const std::string& solver) {
  int num_runs = 0;
  for (const Supported& row : SupportedOf(solver, ExampleProblems())) {
    for (const int last : {0, 1, 3}) {
      StoppingContext context(last, kNever);
      Eigen::VectorXd x = StartOf(row);
      MinimizeFrom(row, solver, &context, &x);
      const std::string at = InText(row.name + ", stop at iterate " + std::to_string(last));
      if (context.iterates().empty()) return Failed("it books nothing" + at);
      if (context.asked_after_stop() + context.booked_after_stop() > 0) {
        return Failed("it " + AskedAfterStop(context) + at);
      }
      if (!SameBits(x, context.iterates().back())) {
        return Failed("it goes on from the iterate that said stop" + at);
      }
      ++num_runs;
    }
  }
  return {true, std::to_string(num_runs) + " runs"};
}

CheckVerdict ChecksStopAtEvaluation(const std::string& solver) {
  int num_runs = 0;
  for (const Supported& row : SupportedOf(solver, ExampleProblems())) {
    StoppingContext all(kFewIterations, kNever);
    const Eigen::VectorXd start = StartOf(row);
    Eigen::VectorXd x = start;
    MinimizeFrom(row, solver, &all, &x);
    constexpr int kMostRefused = 60;
    const int num_evaluations = std::min(all.num_evaluations(), kMostRefused);
    for (int allowed = 0; allowed < num_evaluations; ++allowed) {
      StoppingContext context(kNever, allowed);
      x = start;
      const Outcome outcome = MinimizeFrom(row, solver, &context, &x);
      const std::string at =
          InText(row.name + ", refused after " + std::to_string(allowed) + " evaluations");
      // Where a library keeps its last point to itself, it may be booked on the way out.
      if (context.asked_after_stop() > 0 || context.booked_after_stop() > 1) {
        return Failed("it " + AskedAfterStop(context) + at);
      }
      const bool booked = !context.iterates().empty();
      if (!SameBits(x, booked ? context.iterates().back() : start)) {
        return Failed("it leaves a point that it has not booked" + at);
      }
      if (outcome.reason != StopReason::kInterrupted) {
        return Failed(std::string("it says ") + ToString(outcome.reason) +
                      " where the run was stopped" + at);
      }
      ++num_runs;
    }
  }
  return {true, std::to_string(num_runs) + " runs"};
}

/// Empty: the same iterates.
std::string WhereDifferent(const StoppingContext& one, const StoppingContext& two) {
  const std::size_t count = std::min(one.iterates().size(), two.iterates().size());
  for (std::size_t i = 0; i < count; ++i) {
    if (!SameBits(one.iterates()[i], two.iterates()[i])) return "at iterate " + std::to_string(i);
  }
  return one.iterates().size() == two.iterates().size() ? "" : "in the number of iterates";
}

CheckVerdict ChecksRepeats(const std::string& solver, int threads) {
  int num_runs = 0;
  std::vector<Supported> supported = SupportedOf(solver, ExampleProblems());
  std::vector<StoppingContext> first;
  // All once and then all again: what a run leaves behind meets another problem first.
  for (const int round : {0, 1}) {
    for (std::size_t p = 0; p < supported.size(); ++p) {
      StoppingContext context(kFewIterations, kNever, round == 0 ? 1 : threads);
      Eigen::VectorXd x = StartOf(supported[p]);
      MinimizeFrom(supported[p], solver, &context, &x);
      ++num_runs;
      if (round == 0) {
        first.push_back(context);
        continue;
      }
      const std::string where = WhereDifferent(first[p], context);
      if (!where.empty()) {
        return Failed("two runs part " + where + InText(supported[p].name));
      }
    }
  }
  return {true, std::to_string(num_runs) + " runs"};
}

CheckVerdict ChecksMemory(const std::string& solver) {
  int num_runs = 0;
  for (const Supported& row : SupportedOf(solver, PageSizedProblems(""))) {
    Eigen::VectorXd ends[2];
    for (const int run : {0, 1}) {
      GuardedVector x(StartOf(row));
      if (!x.works()) return {true, "not tried: this allocator leaves no place for a guard"};
      x.SetNumbersBehind(run == 0 ? 0.0 : std::nan(""));
      StoppingContext context(3, kNever);
      MinimizeFrom(row, solver, &context, x.vector());
      ends[run] = *x.vector();
      ++num_runs;
    }
    if (!SameBits(ends[0], ends[1])) {
      return Failed("what stands behind the end of x changes the result" + InText(row.name));
    }
  }
  return {true, std::to_string(num_runs) + " runs"};
}

/// As it is usually written, and with each other word of its options.
std::vector<std::string> VariantsOf(const std::string& registered, SolverVariants which) {
  const std::string usual = UsualName(registered);
  std::vector<std::string> variants = {usual};
  if (which == SolverVariants::kUsual) return variants;
  for (const OptionInfo& option : SolverRegistry::Global().Find(registered)->options) {
    for (const std::string& word : option.words) {
      if (word == option.default_word) continue;
      variants.push_back(registered + "/" + option.name + "=" + word +
                         usual.substr(registered.size()));
    }
  }
  return variants;
}

ConformanceCheck OfEachVariant(const char* name, const char* what, const std::string& registered,
                               SolverVariants which,
                               std::function<CheckVerdict(const std::string& solver)> check) {
  return {name, what, [registered, which, check = std::move(check)]() -> CheckVerdict {
            CheckVerdict usual;
            std::size_t count = 0;
            for (const std::string& variant : VariantsOf(registered, which)) {
              const bool is_usual = count == 0;
              if (!is_usual && SupportedOf(variant, ExampleProblems()).empty()) continue;
              const CheckVerdict verdict = check(variant);
              if (is_usual) usual = verdict;
              if (!verdict.passed) {
                return is_usual ? verdict : Failed(variant + ": " + verdict.detail);
              }
              ++count;
            }
            if (count > 1) usual.detail += "; likewise of " + std::to_string(count - 1) + " words";
            return usual;
          }};
}

}  // namespace

std::vector<ConformanceCheck> SolverChecks(const std::string& registered, SolverVariants which) {
  const auto each = [&](const char* name, const char* what,
                        std::function<CheckVerdict(const std::string& solver)> check) {
    return OfEachVariant(name, what, registered, which, std::move(check));
  };
  const auto Repeats = [](int threads) {
    return [threads](const std::string& solver) { return ChecksRepeats(solver, threads); };
  };
  return {
      {"description", "says what it is and where it is from, options with help",
       [registered] { return ChecksDescription(registered); }},
      {"options",
       "runs at both ends and with each word of each option, with what was asked, refuses others",
       [registered] { return ChecksOptions(registered); }},
      each("descent", "lowers E on what it takes, and books its start", &ChecksDescent),
      each("claims", "what it says of its end passes the audit", &ChecksClaims),
      each("stop at iterate", "returns at the iterate that says stop, with x as it was booked",
           &ChecksStopAtIterate),
      each("stop at evaluation", "asks for nothing after an evaluation that is refused",
           &ChecksStopAtEvaluation),
      each("repeatability", "gives the same bits twice, with other runs between", Repeats(1)),
      each("threads", "gives the same bits with three threads as with one", Repeats(3)),
      each("memory", "reads nothing behind the end of x", &ChecksMemory),
  };
}

}  // namespace batten
