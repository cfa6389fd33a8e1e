#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "cost_functions/options.h"
#include "experiments/comparison_tables.h"
#include "experiments/short_number.h"
#include "problems/catalogue.h"
#include "problems/fit_problem.h"

namespace batten {
namespace {

/// Notes carry numbers that read back to the same double; people want three digits.
std::string ShortWords(const std::string& text) {
  std::string result;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    double value = 0.0;
    const bool is_long_number = word.size() > 5 && ParseNumber(word, &value);
    result += (begin == 0 ? "" : " ") + (is_long_number ? ShortNumber(value, 3) : word);
    begin = end + 1;
  }
  return result;
}

std::string RuleOfTheRuns(const ComparisonSpec& spec) {
  const RunSpec& run = spec.run;
  std::string text = ToString(run.mode) + std::string(": stop ");
  if (run.mode == Mode::kRace) {
    if (run.gradient_tolerance > 0.0) {
      text += "when |g| <= " + NumberText(run.gradient_tolerance) + " |g(start)|, ";
    }
  } else {
    text += "by each method's own rule (largest step < " + NumberText(run.native_step) +
            ", or |g| < " + NumberText(run.native_gradient) + "), ";
  }
  text += "at the rounding floor, after " + std::to_string(run.max_iterations) + " iterations or " +
          NumberText(run.max_seconds) + " s. Times: ";
  text += spec.repetitions == 1
              ? "of one run."
              : "medians of " + std::to_string(spec.repetitions) + " interleaved repetitions.";
  return text;
}

std::string AboutProblem(const Problem& problem, double minimum_energy, bool unique) {
  std::string text = problem.name() + ": ";
  if (const CurveFit* fit = problem.curve_fit()) {
    text += std::to_string(fit->data().points.rows()) + " points, " +
            std::to_string(fit->basis().num_control_points()) + " control points, " +
            (fit->basis().periodic() ? "closed" : "open") + ", degree " +
            std::to_string(fit->basis().degree()) + ", dimension " +
            std::to_string(fit->dimension());
  } else {
    text += std::to_string(problem.num_variables()) + " variables";
  }
  if (std::isnan(minimum_energy)) return text + "; no direct answer";
  text += "; E* = " + ShortNumber(minimum_energy, 7);
  return unique ? text
                : text + "; the minimum is not unique: distances are those of A P, row by row";
}

/// Methods that stop by rules of their own reach different accuracies: how different.
std::string SpreadOfAccuracy(const ComparisonResult& result, int problem) {
  const ComparisonRow* best = nullptr;
  const ComparisonRow* worst = nullptr;
  for (const ComparisonRow& row : result.rows) {
    if (row.problem_index != problem || std::isnan(row.gap)) continue;
    if (best == nullptr || row.gap < best->gap) best = &row;
    if (worst == nullptr || row.gap > worst->gap) worst = &row;
  }
  if (best == nullptr || best == worst) return "";
  return best->problem + ": ends of different accuracy, from gap " + ShortNumber(best->gap, 2) +
         " (" + best->solver + ") to " + ShortNumber(worst->gap, 2) + " (" + worst->solver +
         "): these times do not compare";
}

/// Where ends lead to different minima: to which, and who leads there.
std::string Basins(const ComparisonResult& result, int problem) {
  std::map<int, std::string> solvers;
  std::map<int, double> energies;
  std::string name;
  const char* which = "E at feet";
  for (const ComparisonRow& row : result.rows) {
    if (row.problem_index != problem || !row.basin.has_value()) continue;
    name = row.problem;
    std::string& text = solvers[*row.basin];
    text += (text.empty() ? "" : " ") + row.solver;
    const bool moves = row.parameter_kind != ParameterKind::kFixed;
    if (!moves) which = "E";
    const double energy = moves ? row.report.energy_at_foot_points : row.run.energy;
    const auto [place, is_new] = energies.emplace(*row.basin, energy);
    if (!is_new) place->second = std::min(place->second, energy);
  }
  if (solvers.size() < 2) return "";
  std::string text = name + ": " + std::to_string(solvers.size()) +
                     " minima; times compare within one basin only:";
  for (const auto& [basin, names] : solvers) {
    text += (basin == solvers.begin()->first ? " " : "; ") + std::to_string(basin) + " (" + which +
            " " + ShortNumber(energies[basin], 7) + "): " + names;
  }
  return text;
}

std::string AboveBestKnown(const ComparisonResult& result, std::size_t problem) {
  if (problem >= result.spec.problems.size()) return "";
  double lowest = std::numeric_limits<double>::infinity();
  for (const ComparisonRow& row : result.rows) {
    if (row.problem_index != static_cast<int>(problem) || !row.run.skipped.empty()) continue;
    lowest = std::min(lowest, row.report.energy_at_foot_points);
  }
  return BesideBestKnown(result.spec.problems[problem], lowest);
}

/// Whether a message is the warning, or ends with it behind its own text.
bool RepeatsWarning(const std::string& message, const std::string& warning) {
  return message == warning || EndsWith(message, "; " + warning);
}

/// What the solver had to say, with the observed rate beside a predicted one.
std::string RowNote(const ComparisonRow& row) {
  std::string text;
  bool tells_rate = false;
  for (const auto& [name, value] : row.run.notes) {
    // A warning that turned out true stands in the message, too.
    if (!RepeatsWarning(row.run.outcome.message, value)) {
      text += (text.empty() ? "" : ", ") + name + ": " + ShortWords(value);
    }
    tells_rate = tells_rate || name.find("spectral radius") != std::string::npos ||
                 name.find("rate") != std::string::npos;
  }
  if (tells_rate && std::isfinite(row.run.observed_rate)) {
    text += ", observed rate " + ShortNumber(row.run.observed_rate, 3);
  }
  if (!row.run.outcome.message.empty()) {
    text += (text.empty() ? "" : "; ") + ShortWords(row.run.outcome.message);
  }
  return text;
}

}  // namespace

std::string BesideBestKnown(const std::string& problem, double lowest) {
  CatalogueEntry entry;
  std::string ignored;
  if (!std::isfinite(lowest) || !FindProblem(problem, &entry, &ignored) ||
      entry.spec.parameter_kind == ParameterKind::kFixed || !(entry.reference_energy > 0.0)) {
    return "";
  }
  // The last digits are those of the rounding floor that the ends were polished to.
  constexpr double kEqual = 1e-8;
  const double excess = lowest / entry.reference_energy - 1.0;
  const std::string text = entry.name + ": best known E at feet " +
                           ShortNumber(entry.reference_energy, 7) + ", the lowest of these runs ";
  if (std::abs(excess) <= kEqual) return text + "equals it";
  return text + ShortNumber(lowest, 7) + ", " + ShortNumber(100.0 * std::abs(excess), 3) + " % " +
         (excess > 0.0 ? "above" : "below, which is news");
}

std::vector<std::string> ComparisonNotes(const ComparisonResult& result) {
  std::vector<std::string> notes = {RuleOfTheRuns(result.spec)};
  for (std::size_t i = 0; i < result.problems.size(); ++i) {
    bool unique = true;
    for (const ComparisonRow& row : result.rows) {
      if (row.problem_index == static_cast<int>(i)) unique = unique && row.unique_minimum;
    }
    notes.push_back(AboutProblem(*result.problems[i], result.minimum_energies[i], unique));
    const std::string basins = Basins(result, static_cast<int>(i));
    if (!basins.empty()) notes.push_back(basins);
    const std::string above = AboveBestKnown(result, i);
    if (!above.empty()) notes.push_back(above);
    if (result.spec.run.mode == Mode::kNative) {
      const std::string spread = SpreadOfAccuracy(result, static_cast<int>(i));
      if (!spread.empty()) notes.push_back(spread);
    }
  }
  for (const ComparisonRow& row : result.rows) {
    const std::string text = RowNote(row);
    const std::string name = row.problem + ", " + row.solver + ": ";
    if (row.run.skipped.empty() && !text.empty()) notes.push_back(name + text);
    if (row.report.audited && !row.report.verdict.holds) {
      notes.push_back(name + "NOT VERIFIED: " + row.report.verdict.failure);
    }
  }
  for (const std::string& disagreement : result.disagreements) {
    notes.push_back("DISAGREES: " + disagreement);
  }
  if (result.interrupted) notes.push_back("interrupted: rows are missing");
  return notes;
}

}  // namespace batten
