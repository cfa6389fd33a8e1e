#include "experiments/end_notes.h"

#include <cmath>

#include "cost_functions/term.h"
#include "experiments/comparison_reference.h"
#include "experiments/short_number.h"
#include "problems/fit_problem.h"

namespace batten {

void NoteDistanceFromMinimum(const Problem& problem, RunResult* run) {
  constexpr double kFar = 1e-6;
  const bool is_direct_answer = run->solver.name == "banded_qr";
  if (is_direct_answer || !IsSuccess(run->outcome.reason) || !run->x.allFinite()) return;
  const DirectReference direct(problem);
  if (!direct.known() || !direct.unique()) return;
  const double distance = direct.Distance(run->x);
  if (!(distance > kFar)) return;
  // The native rule of steps does not look at |g|.
  const std::string why =
      run->outcome.reason == StopReason::kStepSmall
          ? ", though they hardly move: E is ill-conditioned, or the method goes to a limit of its "
            "own; banded_qr goes to the minimum"
          : ", though |g| is small: E is ill-conditioned; banded_qr keeps more digits";
  run->notes.emplace_back("far from the minimum", "control points are up to " +
                                                      ShortNumber(distance, 2) +
                                                      " of the data's size away from it" + why);
}

void NoteErrorsOfRules(const Problem& problem, const CurveFairness& fairness, RunResult* run) {
  constexpr double kMuch = 0.01;
  const CurveFit* const fit = problem.curve_fit();
  if (fit == nullptr || !run->x.allFinite() || !fit->spec().span_weights.empty()) return;
  const Objective objective(&problem, nullptr);
  const std::vector<double> energies =
      objective.TermEnergies(problem.elimination().FreeVariables(run->x));
  for (std::size_t k = 0; k < energies.size(); ++k) {
    NameSpec name;
    const Term* term = nullptr;
    OptionValues options;
    std::string ignored;
    if (!ParseNameSpec(problem.terms()[k].name, &name, &ignored) || name.name != "curve_fairing" ||
        !TermRegistry::Global().Resolve(name, &term, &options, &ignored) ||
        options.Word("measure") != "bending" || problem.terms()[k].family->loss() != nullptr) {
      continue;
    }
    const double unit = options.Word("units") == "source" ? 1.0 : std::pow(fit->size(), 3);
    const double rule = energies[k] * problem.units().energy / (options.Real("weight") * unit);
    const double integral = fairness.bending_energy;
    if (!(std::abs(rule - integral) > kMuch * std::abs(integral))) continue;
    run->notes.emplace_back(
        "curve_fairing", "its sum over " + std::to_string(options.Integer("points")) +
                             " points a span is " + ShortNumber(rule, 3) +
                             ", the integral of the squared curvature " + ShortNumber(integral, 3) +
                             ": the curve bends sharply between these points; more points "
                             "or more weight see it");
  }
}

}  // namespace batten
