// L-BFGS of libLBFGS (Okazaki, after Nocedal's Fortran) as a solver.

#include <lbfgs.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "solvers/options_note.h"
#include "solvers/plugin.h"

namespace {

constexpr char kName[] = "liblbfgs";

struct LineSearch {
  const char* word;
  int code;
};

constexpr LineSearch kLineSearches[] = {
    {"more_thuente", LBFGS_LINESEARCH_MORETHUENTE},
    {"armijo", LBFGS_LINESEARCH_BACKTRACKING_ARMIJO},
    {"wolfe", LBFGS_LINESEARCH_BACKTRACKING_WOLFE},
    {"strong_wolfe", LBFGS_LINESEARCH_BACKTRACKING_STRONG_WOLFE},
};

/// As it stands in what the library is handed: it answers nothing.
std::string RanWith(const lbfgs_parameter_t& parameters) {
  std::string text = std::string(kName) + "/memory=" + std::to_string(parameters.m);
  for (const LineSearch& row : kLineSearches) {
    if (row.code == parameters.linesearch) text += std::string("/line_search=") + row.word;
  }
  return text;
}

/// One run: the library's callbacks get it as `instance`.
struct LibraryRun {
  batten::Objective* objective;
  batten::RunContext* context;
  Eigen::VectorXd booked;  // the last iterate
  Eigen::VectorXd point, gradient;
  bool stopped = false;
  bool is_lost = false;       // the library's next iterate is no number
  std::exception_ptr thrown;  // must not pass through C

  template <typename Work>
  batten::Status Guarded(Work work) {
    batten::Status status = batten::Status::kStop;
    try {
      if (!stopped) status = work();
    } catch (...) {
      thrown = std::current_exception();
    }
    stopped = stopped || status == batten::Status::kStop;
    return status;
  }
};

lbfgsfloatval_t Evaluate(void* instance, const lbfgsfloatval_t* x, lbfgsfloatval_t* g,
                         const int /*n*/, const lbfgsfloatval_t /*step*/) {
  auto* const run = static_cast<LibraryRun*>(instance);
  double energy = 0.0;
  const Eigen::Index size = run->point.size();
  const batten::Status status = run->Guarded([&] {
    run->point = Eigen::Map<const Eigen::VectorXd>(x, size);
    return run->objective->EnergyAndGradient(run->point, &energy, &run->gradient);
  });
  if (status == batten::Status::kOk) {
    std::copy_n(run->gradient.data(), size, g);
    return energy;
  }
  // The library cannot be told to stop here. Where E is infinite its line search gives up by
  // itself, and nobody is asked for anything more.
  std::fill_n(g, size, 0.0);
  return std::numeric_limits<double>::infinity();
}

int BookIterate(void* instance, const lbfgsfloatval_t* x, const lbfgsfloatval_t* /*g*/,
                const lbfgsfloatval_t /*fx*/, const lbfgsfloatval_t /*xnorm*/,
                const lbfgsfloatval_t /*gnorm*/, const lbfgsfloatval_t /*step*/, int /*n*/,
                int /*k*/, int /*ls*/) {
  auto* const run = static_cast<LibraryRun*>(instance);
  // Where neither x nor g changed any more it divides by 0, and its backtracking by Armijo's rule
  // takes what comes of that for a step.
  run->is_lost = !Eigen::Map<const Eigen::VectorXd>(x, run->booked.size()).allFinite();
  if (run->is_lost) return 1;
  const batten::Status status = run->Guarded([&] {
    run->booked = Eigen::Map<const Eigen::VectorXd>(x, run->booked.size());
    // Anything but kOk: leave now.
    return run->context->Iterate(run->booked) == batten::Status::kOk ? batten::Status::kOk
                                                                     : batten::Status::kStop;
  });
  return status == batten::Status::kOk ? 0 : 1;
}

batten::Outcome OutcomeOf(int code) {
  const std::string message = "libLBFGS returned " + std::to_string(code);
  switch (code) {
    case LBFGS_SUCCESS:
    case LBFGS_STOP:
      return {batten::StopReason::kNativeStop, message};
    case LBFGS_ALREADY_MINIMIZED:  // the gradient is exactly zero: its tolerance is 0
      return {batten::StopReason::kSolved, message};
    case LBFGSERR_ROUNDING_ERROR:
    case LBFGSERR_MINIMUMSTEP:
    case LBFGSERR_MAXIMUMSTEP:
    case LBFGSERR_MAXIMUMLINESEARCH:
    case LBFGSERR_WIDTHTOOSMALL:
    case LBFGSERR_OUTOFINTERVAL:
    case LBFGSERR_INCORRECT_TMINMAX:
    case LBFGSERR_INCREASEGRADIENT:
      return {batten::StopReason::kLineSearchEnded, message};
    default:
      return {batten::StopReason::kNumericalFailure, message};
  }
}

class LibLbfgsSolver final : public batten::Solver {
 public:
  static batten::SolverInfo ClassInfo() {
    batten::SolverInfo info;
    info.name = kName;
    info.summary = "L-BFGS of libLBFGS, with four line searches";
    info.source = "Okazaki, libLBFGS 1.10; Liu & Nocedal, Math. Programming 45, 1989";
    info.supports = {"linear constraints", "losses", "weights"};
    std::vector<std::string> words;
    for (const LineSearch& row : kLineSearches) words.emplace_back(row.word);
    info.options = {
        batten::OptionInfo::Integer("memory", 6, 1, 1000, "pairs of steps and changes of g kept"),
        batten::OptionInfo::Word("line_search", "more_thuente", words,
                                 "the library's, by the rule that a step must fulfil")};
    return info;
  }
  explicit LibLbfgsSolver(const batten::OptionValues& options)
      : memory_(options.Integer("memory")), line_search_(options.Word("line_search")) {}
  batten::SolverInfo Info() const override { return ClassInfo(); }
  std::string WhyUnsupported(const batten::Objective& objective) const override {
    const std::string why = batten::WhyNoBounds(objective, kName);
    return why.empty() ? batten::WhyNoOrder(objective.problem(), kName) : why;
  }

 private:
  lbfgs_parameter_t Parameters() const {
    lbfgs_parameter_t parameters;
    lbfgs_parameter_init(&parameters);
    parameters.m = memory_;
    parameters.epsilon = 0.0;  // the run is stopped from outside
    parameters.past = 0;
    parameters.max_iterations = 0;
    for (const LineSearch& row : kLineSearches) {
      if (line_search_ == row.word) parameters.linesearch = row.code;
    }
    return parameters;
  }

  batten::Outcome DoMinimize(batten::Objective* objective, batten::RunContext* context,
                             Eigen::VectorXd* x) override {
    LibraryRun run = {objective, context, *x, *x, *x, false, false, nullptr};
    if (context->Iterate(*x) != batten::Status::kOk) return {context->stop_reason(), ""};
    lbfgs_parameter_t parameters = Parameters();
    context->Note("algorithm that ran", "libLBFGS L-BFGS m=" + std::to_string(parameters.m) +
                                            " line search " + line_search_ + " (code " +
                                            std::to_string(parameters.linesearch) + ")");
    context->Note(batten::kOptionsThatRan, RanWith(parameters));
    const auto size = static_cast<int>(x->size());
    // Of the library's own alignment.
    const std::unique_ptr<lbfgsfloatval_t, void (*)(lbfgsfloatval_t*)> variables(lbfgs_malloc(size),
                                                                                 &lbfgs_free);
    if (variables == nullptr) return {batten::StopReason::kNumericalFailure, "out of memory"};
    std::copy_n(x->data(), size, variables.get());
    const int code =
        lbfgs(size, variables.get(), nullptr, &Evaluate, &BookIterate, &run, &parameters);
    *x = run.booked;
    if (run.thrown != nullptr) std::rethrow_exception(run.thrown);
    if (run.stopped) return {context->stop_reason(), ""};
    if (run.is_lost) {
      return {batten::StopReason::kLineSearchEnded,
              "libLBFGS had no direction from here: s'y is 0"};
    }
    return OutcomeOf(code);
  }

  int memory_;
  std::string line_search_;
};

}  // namespace

BATTEN_PLUGIN(registry) { registry->AddSolver<LibLbfgsSolver>(); }
