// Local algorithms of NLopt (Johnson) as a solver.

#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "solvers/options_note.h"
#include "solvers/plugin.h"

namespace {

constexpr char kName[] = "nlopt";

struct Algorithm {
  const char* word;
  nlopt_algorithm code;
  Eigen::Index most_variables;  // its memory or time grows with their square, or faster
};

constexpr Eigen::Index kAny = std::numeric_limits<Eigen::Index>::max();
constexpr Algorithm kAlgorithms[] = {
    {"lbfgs", NLOPT_LD_LBFGS, kAny},
    {"var1", NLOPT_LD_VAR1, kAny},
    {"var2", NLOPT_LD_VAR2, kAny},
    {"tnewton", NLOPT_LD_TNEWTON, kAny},
    {"tnewton_restart", NLOPT_LD_TNEWTON_RESTART, kAny},
    {"tnewton_precond", NLOPT_LD_TNEWTON_PRECOND, kAny},
    {"tnewton_precond_restart", NLOPT_LD_TNEWTON_PRECOND_RESTART, kAny},
    {"mma", NLOPT_LD_MMA, kAny},
    {"ccsaq", NLOPT_LD_CCSAQ, kAny},
    {"slsqp", NLOPT_LD_SLSQP, 1000},
    {"bobyqa", NLOPT_LN_BOBYQA, 200},
    {"neldermead", NLOPT_LN_NELDERMEAD, 1000},
    {"sbplx", NLOPT_LN_SBPLX, 1000},
};

const Algorithm& Find(const std::string& word) {
  return *std::find_if(std::begin(kAlgorithms), std::end(kAlgorithms),
                       [&word](const Algorithm& row) { return word == row.word; });
}

/// As NLopt itself answers.
std::string RanWith(nlopt_opt optimizer) {
  const nlopt_algorithm code = nlopt_get_algorithm(optimizer);
  std::string text = kName;
  for (const Algorithm& row : kAlgorithms) {
    if (row.code == code) text += std::string("/algorithm=") + row.word;
  }
  return text + "/memory=" + std::to_string(nlopt_get_vector_storage(optimizer));
}

/// One run: the library's callback gets it as `data`.
struct LibraryRun {
  batten::Objective* objective;
  batten::RunContext* context;
  nlopt_opt optimizer;
  Eigen::VectorXd booked;  // the last iterate
  double booked_energy;
  Eigen::VectorXd point, gradient;
  bool stopped = false;
  std::exception_ptr thrown;  // must not pass through C
};

/// E, and g where the algorithm asks for it. NLopt does not say when an iteration is over: what
/// lowers E below all before it is booked as one.
batten::Status EvaluateAndBook(const double* x, double* gradient, double* energy, LibraryRun* run) {
  run->point = Eigen::Map<const Eigen::VectorXd>(x, run->point.size());
  const batten::Status status =
      gradient == nullptr ? run->objective->Energy(run->point, energy)
                          : run->objective->EnergyAndGradient(run->point, energy, &run->gradient);
  if (status != batten::Status::kOk) return status;
  if (gradient != nullptr) std::copy_n(run->gradient.data(), run->gradient.size(), gradient);
  if (!(*energy < run->booked_energy)) return status;
  run->booked = run->point;
  run->booked_energy = *energy;
  // Anything but kOk: leave now.
  return run->context->Iterate(run->booked) == batten::Status::kOk ? batten::Status::kOk
                                                                   : batten::Status::kStop;
}

double Evaluate(unsigned n, const double* x, double* gradient, void* data) {
  auto* const run = static_cast<LibraryRun*>(data);
  double energy = HUGE_VAL;
  batten::Status status = batten::Status::kStop;
  try {
    if (!run->stopped) status = EvaluateAndBook(x, gradient, &energy, run);
  } catch (...) {
    run->thrown = std::current_exception();
  }
  if (status == batten::Status::kOk) return energy;
  if (gradient != nullptr) std::fill_n(gradient, n, 0.0);
  if (status == batten::Status::kStop) {
    run->stopped = true;
    nlopt_force_stop(run->optimizer);
  }
  return HUGE_VAL;
}

/// Of the library that is loaded.
std::string Version() {
  int major = 0, minor = 0, bugfix = 0;
  nlopt_version(&major, &minor, &bugfix);
  return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(bugfix);
}

batten::Outcome OutcomeOf(nlopt_result result) {
  const std::string message = std::string("NLopt says ") + nlopt_result_to_string(result);
  const bool is_failure = result == NLOPT_OUT_OF_MEMORY || result == NLOPT_INVALID_ARGS;
  return {is_failure ? batten::StopReason::kNumericalFailure : batten::StopReason::kNativeStop,
          message};
}

class NloptSolver final : public batten::Solver {
 public:
  static batten::SolverInfo ClassInfo() {
    batten::SolverInfo info;
    info.name = kName;
    info.summary = "local algorithms of NLopt; an iteration is an evaluation that lowers E";
    info.source = "Johnson, The NLopt nonlinear-optimization package, 2.7.1";
    info.supports = {"linear constraints", "losses", "weights"};
    std::vector<std::string> words;
    for (const Algorithm& row : kAlgorithms) words.emplace_back(row.word);
    info.options = {batten::OptionInfo::Word("algorithm", "lbfgs", words,
                                             "of the library's; the last three "
                                             "use no gradient"),
                    batten::OptionInfo::Integer("memory", 10, 1, 1000,
                                                "vectors that lbfgs, var and tnewton keep")};
    return info;
  }
  explicit NloptSolver(const batten::OptionValues& options)
      : algorithm_(Find(options.Word("algorithm"))), memory_(options.Integer("memory")) {}
  batten::SolverInfo Info() const override { return ClassInfo(); }
  std::string WhyUnsupported(const batten::Objective& objective) const override {
    std::string why = batten::WhyNoBounds(objective, kName);
    if (why.empty()) why = batten::WhyNoOrder(objective.problem(), kName);
    if (why.empty() && objective.num_variables() > algorithm_.most_variables) {
      why = std::string(kName) + "/algorithm=" + algorithm_.word + " takes at most " +
            std::to_string(algorithm_.most_variables) + " variables, here are " +
            std::to_string(objective.num_variables()) + "; use nlopt/algorithm=lbfgs";
    }
    return why;
  }

 private:
  batten::Outcome DoMinimize(batten::Objective* objective, batten::RunContext* context,
                             Eigen::VectorXd* x) override {
    if (context->Iterate(*x) != batten::Status::kOk) return {context->stop_reason(), ""};
    const std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> optimizer(
        nlopt_create(algorithm_.code, static_cast<unsigned>(x->size())), &nlopt_destroy);
    if (optimizer == nullptr) return {batten::StopReason::kNumericalFailure, "out of memory"};
    // By what the library answers, not by what it was asked for.
    const nlopt_algorithm made = nlopt_get_algorithm(optimizer.get());
    context->Note("algorithm that ran", "NLopt " + Version() + ": " + nlopt_algorithm_name(made));
    if (made != algorithm_.code) {
      return {batten::StopReason::kNumericalFailure, "NLopt made another algorithm"};
    }
    LibraryRun run = {objective, context, optimizer.get(), *x, HUGE_VAL, *x, *x, false, nullptr};
    nlopt_set_min_objective(optimizer.get(), &Evaluate, &run);
    nlopt_set_vector_storage(optimizer.get(), static_cast<unsigned>(memory_));
    context->Note(batten::kOptionsThatRan, RanWith(optimizer.get()));
    Eigen::VectorXd end = *x;
    double energy = 0.0;
    const nlopt_result result = nlopt_optimize(optimizer.get(), end.data(), &energy);
    *x = run.booked;
    if (run.thrown != nullptr) std::rethrow_exception(run.thrown);
    if (run.stopped) return {context->stop_reason(), ""};
    return OutcomeOf(result);
  }

  const Algorithm& algorithm_;
  int memory_;
};

}  // namespace

BATTEN_PLUGIN(registry) { registry->AddSolver<NloptSolver>(); }
