#include "tools/fit_summary.h"

#include <algorithm>

#include "experiments/short_number.h"
#include "problems/data_shortage.h"

namespace batten {
namespace {

/// Six digits for the eye; files have them all.
std::string Short(double value) {
  constexpr int kDigits = 6;
  return std::isfinite(value) ? ShortNumber(value, kDigits) : "unknown";
}

std::string Line(const std::string& name, const std::string& text) {
  std::string line = name;
  line.resize(std::max<size_t>(line.size() + 1, 14), ' ');
  return line + text + "\n";
}

std::string Plural(long count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

/// The rule that made them; where they are free, what they start from.
std::string ParametersText(const CurveFit& fit) {
  const FitSpec& spec = fit.spec();
  if (fit.is_projected()) return "projected: the foot points";
  std::string rule = spec.parameters.has_value() ? ToString(*spec.parameters) : "given";
  if (!fit.has_free_parameters()) return rule;
  std::string start = rule;
  if (spec.start_points.size() > 0) {
    start = "at the feet on the given curve";
  } else if (spec.start == "circle" || spec.start == "ellipse") {
    start = "at the feet on the " + spec.start;
  }
  return "free, start " + start + (spec.hold_ends ? ", ends held" : "") +
         (spec.keep_order ? ", order kept" : "");
}

std::string CurveLines(const std::string& label, const Problem& problem) {
  const CurveFit* fit = problem.curve_fit();
  if (fit == nullptr) return Line("fitted", label);
  const BsplineBasis& basis = fit->basis();
  std::string text = Line("fitted", label + ": " + Plural(fit->data().points.rows(), "point") +
                                        " in " + std::to_string(fit->dimension()) + "-D, " +
                                        (basis.periodic() ? "closed" : "open") +
                                        " curve of degree " + std::to_string(basis.degree()) +
                                        ", " + Plural(basis.num_control_points(), "control point"));
  const FitSpec& spec = fit->spec();
  text += Line("parameters", ParametersText(*fit));
  return text + Line("knots", spec.given_knots.empty() ? ToString(spec.knots) : "given");
}

std::string SolverLines(const RunResult& run) {
  std::string options;
  for (const auto& [name, value] : run.options) {
    options += (options.empty() ? " (" : ", ") + name + "=" + value;
  }
  std::string text = Line("solver", run.solver.ToString() + options + (options.empty() ? "" : ")"));
  text += Line("stopped", std::string(ToString(run.outcome.reason)) + " after " +
                              Plural(run.iterations, "iteration") +
                              (run.outcome.message.empty() ? "" : ": " + run.outcome.message));
  for (const auto& [name, value] : run.notes) text += Line("note", name + ": " + value);
  if (std::isfinite(run.observed_rate)) {
    text += Line("rate", "|g| is " + Short(run.observed_rate) +
                             " times the one before, per iteration near the end");
  }
  return text;
}

std::string EnergyLines(const Problem& problem, const RunResult& run) {
  std::string text =
      Line("energy E", Short(run.energy) + " (start " + Short(run.start_energy) + ")");
  const auto& terms = problem.terms();
  for (std::size_t k = 0; terms.size() > 1 && k < terms.size(); ++k) {
    double energy = 0.0;
    const BlockFamily& family = *terms[k].family;
    if (family.Evaluate(run.x, 0, family.size(), &energy, nullptr) != Status::kOk) energy = NAN;
    text += Line("", terms[k].name + " " + Short(energy * problem.units().energy));
  }
  const CurveFit* fit = problem.curve_fit();
  // Where parameters are free, minima are many anyway.
  if (fit != nullptr && !fit->has_free_parameters() && problem.terms().size() == 1) {
    const std::string shortage = DataShortageText(*fit);
    if (!shortage.empty()) text += Line("", "not the only minimum: " + shortage);
  }
  return text + Line("gradient |g|", Short(run.gradient_norm) + " (start " +
                                         Short(run.start_gradient_norm) + ", rounding floor " +
                                         Short(run.gradient_floor) + ")");
}

std::string ShapeText(const CurveShape& shape) {
  const int loops = shape.num_free_loops;
  return "length " + Short(shape.length) + ", turning " + Short(shape.turning / (2.0 * M_PI)) +
         " x 2 pi, curve to data " + Short(shape.max_distance_to_data) + "; " +
         (loops == 0 ? "no loops" : Plural(loops, "loop")) + " without data";
}

std::string FairnessText(const CurveFairness& fairness) {
  const std::string extrema = "curvature extrema " + std::to_string(fairness.num_curvature_extrema);
  return "bending energy " + Short(fairness.bending_energy) + ", curvature up to " +
         Short(fairness.max_curvature) + ", its variation " + Short(fairness.curvature_variation) +
         ", " + extrema +
         (fairness.num_inflections < 0 ? ""
                                       : ", " + Plural(fairness.num_inflections, "inflection"));
}

std::string ChoiceLines(const FairingChoice& choice) {
  const std::string text = "weight " + Short(choice.weight) + " by " + ToString(choice.rule) +
                           ": " + ScoreName(choice.rule) + " " + Short(choice.chosen.score) + ", " +
                           Short(choice.chosen.trace) + " effective control points, noise " +
                           Short(choice.noise) + "; " +
                           Plural(static_cast<long>(choice.samples.size()), "solve") + " in " +
                           Short(choice.seconds) + " s";
  const std::string warning = FairingChoiceWarning(choice);
  return Line("fairing", text) + (warning.empty() ? "" : Line("", "warning: " + warning));
}

std::string AuditText(const FitReport& report) {
  if (!report.audited) return "none: it does not know all terms of this fit";
  if (!report.verdict.holds) return "FAILED: " + report.verdict.failure;
  const std::string verified = "verified: E " + Short(report.audit.energy);
  if (report.audit.covers_gradient) return verified + ", |g| " + Short(report.audit.gradient_norm);
  return verified + ", constraints missed by " + Short(report.audit.violation) +
         "; |g| is not audited";
}

std::string Ties(int count) {
  return std::to_string(count) + (count == 1 ? " point is" : " points are") +
         " as near to another point of the curve as to the foot";
}

}  // namespace

std::string FitSummary(const std::string& label, const Problem& problem, const RunResult& run,
                       const FitReport& report, const std::vector<std::string>& files) {
  const Counts& counts = run.counts;
  std::string text = CurveLines(label, problem) + SolverLines(run) + EnergyLines(problem, run);
  if (problem.nonlinear_constraints() != nullptr) {
    text += Line("constraints", "missed by " + Short(run.violation) +
                                    " at most; |g| is the gradient of the Lagrangian");
  }
  text += Line("distance", "rms " + Short(report.rms) + ", largest " + Short(report.max) +
                               " (at the parameters)");
  text +=
      Line("", "rms " + Short(report.rms_orthogonal) + ", largest " + Short(report.max_orthogonal) +
                   " (orthogonal), E there " + Short(report.energy_at_foot_points));
  if (report.num_ties.value_or(0) > 0) text += Line("", Ties(*report.num_ties));
  if (report.fairing_choice.has_value()) text += ChoiceLines(*report.fairing_choice);
  if (report.shape.has_value()) text += Line("shape", ShapeText(*report.shape));
  if (report.fairness.has_value()) text += Line("fairness", FairnessText(*report.fairness));
  if (report.audited && report.audit.num_sharing > 0) {
    text += Line("order", std::to_string(report.audit.num_sharing) +
                              " points share a parameter with a neighbour");
  }
  text += Line(
      "calls",
      "E " + std::to_string(counts.energy_calls) + ", g " + std::to_string(counts.gradient_calls) +
          ", Jacobian " + std::to_string(counts.jacobian_calls) + ", products " +
          std::to_string(counts.products) +
          (counts.projections == 0 ? "" : ", projections " + std::to_string(counts.projections)));
  text += Line("time", Short(run.seconds) + " s, of which set-up " + Short(run.setup_seconds) +
                           " s; processor " + Short(run.cpu_seconds) + " s");
  text += Line("audit", AuditText(report));
  for (const std::string& file : files) text += Line("written", file);
  return text;
}

bool ReachedTarget(const RunResult& run, const RunSpec& spec, const FitReport& report) {
  const StopReason reason = run.outcome.reason;
  if (IsSuccess(reason)) return true;
  if (reason == StopReason::kNativeStop && spec.mode == Mode::kNative) return true;
  if (reason != StopReason::kLineSearchEnded && reason != StopReason::kNativeStop) return false;
  const double asked = spec.mode == Mode::kRace ? spec.gradient_tolerance * run.start_gradient_norm
                                                : spec.native_gradient;
  Claim claim = ClaimOf(run, spec);
  claim.minimum = true;
  claim.gradient_target = std::max(asked, run.line_search_floor);
  if (report.audited && report.audit.covers_gradient) return Verify(claim, report.audit).holds;
  return run.gradient_norm <= claim.gradient_target;
}

std::string NotReachedMessage(const RunResult& run, const RunSpec& spec) {
  std::string text = run.solver.ToString() +
                     " did not reach what was asked: " + ToString(run.outcome.reason) + " after " +
                     Plural(run.iterations, "iteration") + " at |g| = " + Short(run.gradient_norm);
  if (spec.mode == Mode::kRace) {
    const double asked =
        std::max(spec.gradient_tolerance * run.start_gradient_norm, run.line_search_floor);
    // At ends far from the data all of |g| may be rounding, which is no reason to be content.
    text += run.gradient_norm > run.gradient_floor
                ? "; asked: at most " + Short(std::max(asked, run.gradient_floor))
                : "; asked: at most " + Short(asked) + ", where rounding alone makes up to " +
                      Short(run.gradient_floor);
  }
  return text;
}

}  // namespace batten
