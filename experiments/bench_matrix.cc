#include "experiments/bench_matrix.h"

#include <dlfcn.h>

#include <algorithm>
#include <random>
#include <sstream>

#include "experiments/content_hash.h"
#include "solvers/needed_libraries.h"
#include "solvers/plugin_loader.h"
#include "solvers/solver_registry.h"

namespace batten {
namespace {

bool MatchesAny(const std::vector<std::string>& patterns, const std::string& text) {
  return patterns.empty() ||
         std::any_of(patterns.begin(), patterns.end(),
                     [&text](const std::string& pattern) { return MatchesPattern(pattern, text); });
}

bool Excludes(const BenchSuite& suite, const BenchExclusion& exclusion, std::size_t problem,
              std::size_t terms, std::size_t solver) {
  return MatchesAny(exclusion.problems, suite.problems[problem].label) &&
         MatchesAny(exclusion.terms, suite.terms[terms].label) &&
         MatchesAny(exclusion.solvers, suite.solvers[solver].ToString());
}

bool IsExcluded(const BenchSuite& suite, std::size_t problem, std::size_t terms,
                std::size_t solver) {
  return std::any_of(suite.exclusions.begin(), suite.exclusions.end(),
                     [&](const BenchExclusion& exclusion) {
                       return Excludes(suite, exclusion, problem, terms, solver);
                     });
}

/// Choices of terms before `terms` that are the same on this problem.
std::vector<std::size_t> SameBefore(const BenchSuite& suite, std::size_t problem,
                                    std::size_t terms) {
  const auto identity = [&](std::size_t choice) {
    return TermsIdentity(suite.problems[problem], suite.terms[choice]);
  };
  std::vector<std::size_t> same;
  for (std::size_t before = 0; before < terms; ++before) {
    if (identity(before) == identity(terms)) same.push_back(before);
  }
  return same;
}

/// Cells of one problem with one choice of terms in one repetition; `same`: earlier choices that
/// are the same there, whose cells are not run again.
void AddCells(const BenchSuite& suite, const std::vector<std::size_t>& same, BenchCell cell,
              std::vector<BenchCell>* cells) {
  for (std::size_t solver = 0; solver < suite.solvers.size(); ++solver) {
    const bool runs_before = std::any_of(same.begin(), same.end(), [&](std::size_t before) {
      return !IsExcluded(suite, cell.problem, before, solver);
    });
    if (runs_before || IsExcluded(suite, cell.problem, cell.terms, solver)) continue;
    for (const int seed : suite.seeds.solver) {
      cell.solver = solver;
      cell.seeds.solver = seed;
      cells->push_back(cell);
    }
  }
}

std::vector<BenchCell> OneRepetition(const BenchSuite& suite) {
  std::vector<BenchCell> cells;
  int instance = 0;
  for (std::size_t p = 0; p < suite.problems.size(); ++p) {
    const BenchProblem& problem = suite.problems[p];
    const std::vector<int> none = {0};
    const std::vector<int>& data = UsesDataSeed(problem) ? suite.seeds.data : none;
    const bool starts = UsesStartSeed(problem) && !suite.seeds.start.empty();
    const std::vector<int>& start = starts ? suite.seeds.start : none;
    for (std::size_t t = 0; t < suite.terms.size(); ++t) {
      const std::vector<std::size_t> same = SameBefore(suite, p, t);
      for (const int data_seed : data) {
        for (const int start_seed : start) {
          BenchCell cell;
          cell.problem = p;
          cell.terms = t;
          cell.seeds.data = data_seed;
          cell.seeds.start = start_seed;
          cell.instance = instance++;
          AddCells(suite, same, cell, &cells);
        }
      }
    }
  }
  return cells;
}

/// Fisher and Yates: std::shuffle differs between libraries.
void Shuffle(std::mt19937_64* random, std::vector<BenchCell>* cells) {
  for (std::size_t i = cells->size(); i > 1; --i) {
    std::swap((*cells)[i - 1], (*cells)[(*random)() % i]);
  }
}

void AddSpec(const FitSpec& spec, std::ostream* text) {
  *text << spec.name << ' ' << spec.degree << ' ' << spec.closed << ' ' << spec.control_points
        << ' ' << (spec.parameters.has_value() ? ToString(*spec.parameters) : "given") << ' '
        << ToString(spec.knots) << ' ' << static_cast<int>(spec.ends) << ' ' << spec.start << ' '
        << ToString(spec.parameter_kind) << ' ' << spec.hold_ends << spec.keep_order << ' ';
  for (const double knot : spec.given_knots) *text << NumberText(knot) << ' ';
  if (spec.domain.has_value()) {
    *text << NumberText(spec.domain->first) << ' ' << NumberText(spec.domain->second) << ' ';
  }
  if (spec.guard.has_value()) *text << spec.guard->ToString() << ' ';
  for (const NameSpec& constraint : spec.constraints) *text << constraint.ToString() << ' ';
  if (!spec.span_weights.empty()) *text << "span_weights ";
  for (const double weight : spec.span_weights) *text << NumberText(weight) << ' ';
}

void AddProblem(const BenchProblem& problem, const BenchTerms& terms, std::ostream* text) {
  AddSpec(problem.entry.spec, text);
  if (problem.truth.has_value()) {
    *text << problem.truth->shape << ' ' << problem.truth->points << ' '
          << NumberText(problem.truth->noise) << ' ';
  }
  for (const NameSpec& term : TermsOf(problem, terms)) *text << term.ToString() << ' ';
}

void AddRule(const BenchSuite& suite, std::ostream* text) {
  const RunSpec& run = suite.run;
  const BenchLimits& limits = suite.limits;
  *text << ToString(run.mode) << ' ' << NumberText(run.gradient_tolerance) << ' '
        << run.max_iterations << ' ' << NumberText(run.max_seconds) << ' '
        << NumberText(run.native_step) << ' ' << NumberText(run.native_gradient) << ' '
        << run.threads << ' ' << run.compile << ' ' << NumberText(limits.cpu_seconds) << ' '
        << NumberText(limits.wall_seconds) << ' ' << limits.memory_mb << ' ' << suite.warm_up
        << ' ';
}

/// Whether the program itself is linked with it, as with the C library: those are of the machine,
/// and their files, like those of the program's other libraries, are in no key.
bool IsOfTheProgram(const std::string& library) {
  static const auto& own =
      *new std::vector<std::string>(NeededLibraries(dlopen(nullptr, RTLD_LAZY)));
  return std::find(own.begin(), own.end(), library) != own.end();
}

std::string Hashed(const BenchProblem& problem, const std::string& text) {
  ContentHash hash;
  hash.Add(ProgramDigits());
  for (const LoadedPlugin& plugin : LoadedPlugins()) {
    hash.Add(plugin.sha256);
    for (const std::string& library : plugin.libraries) {
      if (!IsOfTheProgram(library)) hash.Add(FileDigits(library));
    }
  }
  hash.Add(FileDigits(problem.entry.data_path));
  hash.Add(text);
  return hash.Digits();
}

}  // namespace

std::vector<BenchCell> BenchMatrix(const BenchSuite& suite) {
  const std::vector<BenchCell> once = OneRepetition(suite);
  std::mt19937_64 random(static_cast<std::uint64_t>(suite.order_seed));
  std::vector<BenchCell> cells;
  for (int repetition = 1; repetition <= suite.repetitions; ++repetition) {
    std::vector<BenchCell> these = once;
    for (BenchCell& cell : these) cell.repetition = repetition;
    if (suite.shuffled) Shuffle(&random, &these);
    cells.insert(cells.end(), these.begin(), these.end());
  }
  return cells;
}

std::vector<std::string> RepeatedTerms(const BenchSuite& suite) {
  std::vector<std::string> sentences;
  for (std::size_t p = 0; p < suite.problems.size(); ++p) {
    for (std::size_t t = 0; t < suite.terms.size(); ++t) {
      const std::vector<std::size_t> same = SameBefore(suite, p, t);
      if (same.empty()) continue;
      sentences.push_back(suite.problems[p].label + " | " + suite.terms[t].label +
                          ": left out, the same problem as with terms " +
                          suite.terms[same.front()].label);
    }
  }
  return sentences;
}

std::vector<BenchCell> ShardOf(const std::vector<BenchCell>& cells, int shard, int num_shards) {
  std::vector<BenchCell> part;
  std::copy_if(cells.begin(), cells.end(), std::back_inserter(part),
               [&](const BenchCell& cell) { return cell.instance % num_shards == shard - 1; });
  return part;
}

bool KeepsIterates(const BenchSuite& suite, const BenchCell& cell) {
  return suite.keep_iterates != 0 && cell.repetition == 1;
}

std::string CellText(const BenchSuite& suite, const BenchCell& cell) {
  std::string text = suite.problems[cell.problem].label + " | " + suite.terms[cell.terms].label +
                     " | " + suite.solvers[cell.solver].ToString() + " | ";
  if (cell.seeds.data > 0) text += "data " + std::to_string(cell.seeds.data) + " ";
  if (cell.seeds.start > 0) text += "start " + std::to_string(cell.seeds.start) + " ";
  return text + "seed " + std::to_string(cell.seeds.solver) + " | repetition " +
         std::to_string(cell.repetition);
}

std::string InstanceKey(const BenchSuite& suite, const BenchCell& cell) {
  const BenchProblem& problem = suite.problems[cell.problem];
  std::ostringstream text;
  AddProblem(problem, suite.terms[cell.terms], &text);
  text << suite.terms[cell.terms].label << ' ' << suite.run.compile << ' ' << cell.seeds.data << ' '
       << cell.seeds.start;
  return Hashed(problem, text.str());
}

std::string BenchCellKey(const BenchSuite& suite, const BenchCell& cell) {
  ContentHash hash;
  std::ostringstream text;
  AddRule(suite, &text);
  text << SolverIdentity(suite.solvers[cell.solver]) << ' ' << suite.solvers[cell.solver].ToString()
       << ' ' << cell.seeds.solver << ' ' << cell.repetition;
  if (KeepsIterates(suite, cell)) text << " iterates " << suite.keep_iterates;
  hash.Add(InstanceKey(suite, cell) + text.str());
  return hash.Digits();
}

std::string SuiteHash(const BenchSuite& suite) {
  std::ostringstream text;
  text << suite.name << ' ' << suite.repetitions << ' ' << suite.shuffled << suite.order_seed
       << ' ';
  for (const double gap : suite.gap_targets) text << NumberText(gap) << ' ';
  text << suite.keep_iterates << ' ';
  AddRule(suite, &text);
  ContentHash hash;
  hash.Add(text.str());
  // The matrix says the rest, but for the program and the order.
  BenchSuite once = suite;
  once.repetitions = 1;
  once.shuffled = false;
  for (const BenchCell& cell : BenchMatrix(once)) {
    std::ostringstream problem;
    AddProblem(suite.problems[cell.problem], suite.terms[cell.terms], &problem);
    hash.Add(problem.str() + CellText(suite, cell));
  }
  for (const BenchProblem& problem : suite.problems) hash.Add(FileDigits(problem.entry.data_path));
  return hash.Digits();
}

std::string SolverIdentity(const NameSpec& solver) {
  OptionValues options;
  std::string ignored;
  if (SolverRegistry::Global().Make(solver, &options, &ignored) == nullptr) return "";
  std::string text = solver.name;
  for (const auto& [name, value] : options.ToText()) text += "/" + name + "=" + value;
  return solver.wrapped == nullptr ? text : text + ":" + SolverIdentity(*solver.wrapped);
}

}  // namespace batten
