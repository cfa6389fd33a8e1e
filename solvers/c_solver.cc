#include "solvers/c_solver.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>

namespace batten {
namespace {

using MinimizeFunction = int (*)(const batten_run*, double*);
using ConstMap = Eigen::Map<const Eigen::VectorXd>;

int CodeOf(Status status) {
  switch (status) {
    case Status::kOk:
      return BATTEN_OK;
    case Status::kStop:
      return BATTEN_STOP;
    case Status::kNonFinite:
      return BATTEN_NON_FINITE;
  }
  return BATTEN_STOP;
}

/// What stands behind `self` of a batten_run.
struct CRun {
  Objective* objective;
  RunContext* context;
  const OptionValues* options;
  bool stopped = false;
  std::exception_ptr thrown;  // by a callback: it must not pass through C
  Eigen::VectorXd x, v, result;

  /// Calls `evaluate`; where it throws, the solver is told to stop.
  template <typename Evaluate>
  int Guarded(Evaluate evaluate) noexcept {
    Status status = Status::kStop;
    try {
      status = evaluate();
    } catch (...) {
      thrown = std::current_exception();
    }
    stopped = stopped || status == Status::kStop;
    return CodeOf(status);
  }
  void SetX(const double* from) { x = ConstMap(from, objective->num_variables()); }
  void Give(double* to) const { std::copy_n(result.data(), result.size(), to); }
};

CRun* Of(void* self) { return static_cast<CRun*>(self); }

int Energy(void* self, const double* x, double* energy) {
  CRun* const run = Of(self);
  return run->Guarded([&] {
    run->SetX(x);
    return run->objective->Energy(run->x, energy);
  });
}

int EnergyAndGradient(void* self, const double* x, double* energy, double* gradient) {
  CRun* const run = Of(self);
  return run->Guarded([&] {
    run->SetX(x);
    const Status status = run->objective->EnergyAndGradient(run->x, energy, &run->result);
    if (status == Status::kOk) run->Give(gradient);
    return status;
  });
}

int Gradient(void* self, const double* x, double* gradient) {
  CRun* const run = Of(self);
  return run->Guarded([&] {
    run->SetX(x);
    const Status status = run->objective->Gradient(run->x, &run->result);
    if (status == Status::kOk) run->Give(gradient);
    return status;
  });
}

int HessianTimes(void* self, const double* x, const double* v, double* product) {
  CRun* const run = Of(self);
  return run->Guarded([&] {
    run->SetX(x);
    run->v = ConstMap(v, run->objective->num_variables());
    const Status status = run->objective->HessianTimes(run->x, run->v, &run->result);
    if (status == Status::kOk) run->Give(product);
    return status;
  });
}

double Dot(void* self, const double* a, const double* b) {
  const Eigen::Index size = Of(self)->objective->num_variables();
  return ConstMap(a, size).dot(ConstMap(b, size));
}

double Norm(void* self, const double* a) {
  return ConstMap(a, Of(self)->objective->num_variables()).norm();
}

int Iterate(void* self, const double* x) {
  CRun* const run = Of(self);
  return run->Guarded([&] {
    run->SetX(x);
    // Anything but kOk: return now.
    return run->context->Iterate(run->x) == Status::kOk ? Status::kOk : Status::kStop;
  });
}

void Note(void* self, const char* name, const char* value) {
  CRun* const run = Of(self);
  run->Guarded([&] {
    run->context->Note(name, value);
    return Status::kOk;
  });
}

double Number(void* self, const char* option) {
  double number = std::numeric_limits<double>::quiet_NaN();
  Of(self)->Guarded([&] {
    number = Of(self)->options->Real(option);
    return Status::kOk;
  });
  return number;
}

const char* Word(void* self, const char* option) {
  const char* word = "";
  Of(self)->Guarded([&] {
    word = Of(self)->options->Word(option).c_str();
    return Status::kOk;
  });
  return word;
}

batten_run RunOf(CRun* run) {
  batten_run c = {};
  c.self = run;
  c.size = run->objective->num_variables();
  c.seed = run->context->seed();
  c.threads = run->context->threads();
  c.is_quadratic = run->objective->is_quadratic() ? 1 : 0;
  c.energy = &Energy;
  c.energy_and_gradient = &EnergyAndGradient;
  c.gradient = &Gradient;
  c.hessian_times = &HessianTimes;
  c.dot = &Dot;
  c.norm = &Norm;
  c.iterate = &Iterate;
  c.note = &Note;
  c.number = &Number;
  c.word = &Word;
  return c;
}

Outcome OutcomeOf(int reason) {
  switch (reason) {
    case BATTEN_SOLVED:
      return {StopReason::kSolved, ""};
    case BATTEN_LINE_SEARCH_ENDED:
      return {StopReason::kLineSearchEnded, ""};
    case BATTEN_NATIVE_STOP:
      return {StopReason::kNativeStop, ""};
    case BATTEN_STALLED:
      return {StopReason::kStalled, ""};
    case BATTEN_NUMERICAL_FAILURE:
      return {StopReason::kNumericalFailure, ""};
    default:
      return {StopReason::kNumericalFailure,
              "the plugin returned " + std::to_string(reason) + ", which is no reason"};
  }
}

class CSolver final : public Solver {
 public:
  CSolver(SolverInfo info, OptionValues options, MinimizeFunction minimize)
      : info_(std::move(info)), options_(std::move(options)), minimize_(minimize) {}
  SolverInfo Info() const override { return info_; }
  std::string WhyUnsupported(const Objective& objective) const override {
    const std::string why = WhyNoBounds(objective, info_.name);
    return why.empty() ? WhyNoOrder(objective.problem(), info_.name) : why;
  }

 private:
  Outcome DoMinimize(Objective* objective, RunContext* context, Eigen::VectorXd* x) override {
    CRun run = {objective, context, &options_, false, nullptr, {}, {}, {}};
    const batten_run c = RunOf(&run);
    const int reason = minimize_(&c, x->data());
    if (run.thrown != nullptr) std::rethrow_exception(run.thrown);
    if (run.stopped) return {context->stop_reason(), ""};
    return OutcomeOf(reason);
  }

  SolverInfo info_;
  OptionValues options_;
  MinimizeFunction minimize_;
};

std::vector<std::string> SplitWords(const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

/// False, with why, for an option that OptionInfo would not take.
bool MakeOption(const batten_option& c, OptionInfo* option, std::string* why) {
  if (c.name == nullptr || c.help == nullptr) {
    *why = "has an option without name or help";
    return false;
  }
  if (c.words != nullptr) {
    const std::vector<std::string> words = SplitWords(c.words);
    const std::string usual = c.default_word == nullptr ? "" : c.default_word;
    if (std::count(words.begin(), words.end(), usual) != 1) {
      *why = std::string("has an option ") + c.name + " whose default is not one of its words";
      return false;
    }
    *option = OptionInfo::Word(c.name, usual, words, c.help);
    return true;
  }
  if (!(c.lowest <= c.default_number && c.default_number <= c.highest)) {
    *why = std::string("has an option ") + c.name + " whose default is not in its range";
    return false;
  }
  constexpr double kLargest = 2147483647.0;
  if (c.is_integer != 0 && (std::abs(c.lowest) > kLargest || std::abs(c.highest) > kLargest ||
                            c.default_number != std::trunc(c.default_number))) {
    *why = std::string("has an option ") + c.name + " that is no integer of 32 bits";
    return false;
  }
  *option =
      c.is_integer != 0
          ? OptionInfo::Integer(c.name, static_cast<int>(c.default_number),
                                static_cast<int>(c.lowest), static_cast<int>(c.highest), c.help)
          : OptionInfo::Real(c.name, c.default_number, c.lowest, c.highest, c.help);
  return true;
}

/// What stands behind `self` of a batten_host.
struct CHost {
  PluginRegistry* registry;
  std::string why;
};

bool MakeEntry(const batten_solver& c, SolverEntry* entry, std::string* why) {
  if (c.struct_size != sizeof(batten_solver)) {
    *why = "has a size of " + std::to_string(c.struct_size) +
           "; allowed: " + std::to_string(sizeof(batten_solver));
    return false;
  }
  if (c.name == nullptr || c.summary == nullptr || c.source == nullptr || c.minimize == nullptr) {
    *why = "lacks name, summary, source or minimize";
    return false;
  }
  SolverInfo info;
  info.name = c.name;
  info.summary = c.summary;
  info.source = c.source;
  info.supports = {"linear constraints", "losses", "weights"};
  if (c.num_options > 0 && c.options == nullptr) {
    *why = "has " + std::to_string(c.num_options) + " options, but no list of them";
    return false;
  }
  for (std::uint32_t i = 0; i < c.num_options; ++i) {
    OptionInfo option;
    if (!MakeOption(c.options[i], &option, why)) return false;
    info.options.push_back(std::move(option));
  }
  const MinimizeFunction minimize = c.minimize;
  *entry = {info, [info, minimize](const OptionValues& options, std::unique_ptr<Solver>) {
              return std::make_unique<CSolver>(info, options, minimize);
            }};
  return true;
}

void AddSolver(void* self, const batten_solver* solver) {
  auto* const host = static_cast<CHost*>(self);
  SolverEntry entry;
  std::string why;
  if (solver == nullptr) {
    host->why = "registers no solver";
  } else if (MakeEntry(*solver, &entry, &why)) {
    host->registry->Add(std::move(entry));
  } else if (host->why.empty()) {
    const std::string name = solver->name == nullptr ? "" : std::string(solver->name) + " ";
    host->why = "its solver " + name + why;
  }
}

}  // namespace

std::string RegisterCSolvers(void (*add)(const batten_host*), PluginRegistry* registry) {
  CHost host = {registry, ""};
  const batten_host c = {&host, &AddSolver};
  add(&c);
  return host.why;
}

}  // namespace batten
