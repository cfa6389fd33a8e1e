#include <gflags/gflags.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "experiments/atomic_file.h"
#include "experiments/plot.h"
#include "experiments/replay.h"
#include "experiments/short_number.h"
#include "problems/catalogue.h"
#include "tools/command.h"
#include "tools/interrupts.h"
#include "tools/run_flags.h"

DECLARE_string(problem);
DECLARE_string(solver);
DECLARE_string(out);
DECLARE_int32(repetitions);
DEFINE_string(against, "",
              "A second solver: where the points at which the two evaluate part. Not given: "
              "the solver against itself.");

namespace batten {
namespace {

constexpr double kTolerances[] = {0.0, 1e-15, 1e-12, 1e-8};

bool OneSolver(const std::string& flag, const std::string& text, NameSpec* solver,
               std::string* error) {
  std::vector<NameSpec> solvers;
  if (!SolversFromFlag(flag, text, &solvers, error)) return false;
  if (solvers.size() == 1) {
    *solver = solvers.front();
    return true;
  }
  *error = RefusedFlag(flag, text, "one solver");
  return false;
}

std::string ValueText(const std::string& name, const ValueAtPoint& value) {
  return name + " E = " + ShortNumber(value.energy, 6) +
         ", |g| = " + ShortNumber(value.gradient_norm, 3);
}

/// From the first difference in bits to the coarsest tolerance.
std::vector<Parting> FindPartings(const Tape& first, const Tape& second) {
  std::vector<Parting> partings;
  for (const double tolerance : kTolerances) {
    partings.push_back(FindParting(first, second, tolerance));
  }
  return partings;
}

std::string PartingText(const Problem& problem, const RunSpec& spec, const Tape& first,
                        const Tape& second, const std::vector<Parting>& partings) {
  const std::size_t shorter = std::min(first.points.size(), second.points.size());
  const bool is_equal_length = first.points.size() == second.points.size();
  std::string text;
  for (const Parting& parting : partings) {
    const std::string measure =
        parting.tolerance == 0.0 ? "bit for bit" : "to " + ShortNumber(parting.tolerance, 1);
    if (parting.index == Parting::kNever) {
      text += (is_equal_length ? "the same " : "the same first ") + std::to_string(shorter) +
              " points, " + measure + "\n";
      if (parting.tolerance == 0.0) return text;
      continue;
    }
    const Eigen::VectorXd& x = first.points[parting.index];
    const Eigen::VectorXd& y = second.points[parting.index];
    text += measure + ": part at evaluation " + std::to_string(parting.index + 1) + ", by " +
            ShortNumber(parting.difference, 3) + " of the largest |x|; " +
            ValueText("first", EvaluateAt(problem, spec, x)) + "; " +
            ValueText("second", EvaluateAt(problem, spec, y)) + "\n";
  }
  return text;
}

using Json = nlohmann::ordered_json;

/// One side: a solver, its tape, and where its time goes.
struct Side {
  Tape tape;
  TimeSplit time;
};

std::string CountsText(const Tape& tape) {
  return std::to_string(tape.Count(Evaluation::kEnergy)) + " E, " +
         std::to_string(tape.Count(Evaluation::kGradient)) + " g, " +
         std::to_string(tape.Count(Evaluation::kProduct)) + " products";
}

std::string SideText(const Side& side) {
  constexpr double kMilliseconds = 1e3;
  // Medians of parts need not add up to that of the whole: shares are those of their own sum.
  const double sum = side.time.evaluation + side.time.solver;
  const auto part = [sum](double seconds) {
    return ShortNumber(kMilliseconds * seconds, 3) + " ms (" +
           ShortNumber(100.0 * seconds / sum, 2) + " %)";
  };
  return side.tape.run.solver.ToString() + ": " + std::to_string(side.tape.points.size()) +
         " points, " + ToString(side.tape.run.outcome.reason) + "; " + CountsText(side.tape) +
         "\n  " + ShortNumber(kMilliseconds * side.time.run, 3) +
         " ms; medians of its parts: evaluation " + part(side.time.evaluation) +
         ", the solver itself " + part(side.time.solver) + "\n";
}

Json SideJson(const Side& side) {
  return {{"solver", side.tape.run.solver.ToString()},
          {"options", side.tape.run.options},
          {"stop", ToString(side.tape.run.outcome.reason)},
          {"points", side.tape.points.size()},
          {"energy_calls", side.tape.Count(Evaluation::kEnergy)},
          {"gradient_calls", side.tape.Count(Evaluation::kGradient)},
          {"products", side.tape.Count(Evaluation::kProduct)},
          {"seconds", side.time.run},
          {"evaluation_seconds", side.time.evaluation},
          {"solver_seconds", side.time.solver}};
}

/// Where each point was asked for, and its coordinates, which read back to the same doubles.
std::string TapeCsv(const Tape& tape) {
  const Eigen::Index n = tape.points.front().size();
  std::string text = "request,kind,point";
  for (Eigen::Index k = 0; k < n; ++k) text += ",x" + std::to_string(k);
  text += "\n";
  std::size_t written = 0;
  for (std::size_t i = 0; i < tape.requests.size(); ++i) {
    const Tape::Request& request = tape.requests[i];
    const bool product = request.kind == Evaluation::kProduct;
    text += std::to_string(i + 1) + (product                               ? ",product,"
                                     : request.kind == Evaluation::kEnergy ? ",E,"
                                                                           : ",g,");
    if (!product) text += std::to_string(request.point + 1);
    const bool is_new = !product && request.point == written;
    for (Eigen::Index k = 0; k < n; ++k) {
      text += is_new ? "," + NumberText(tape.points[request.point][k]) : ",";
    }
    if (is_new) ++written;
    text += "\n";
  }
  return text;
}

Json PartingsJson(const std::vector<Parting>& partings) {
  Json list = Json::array();
  for (const Parting& parting : partings) {
    const bool part = parting.index != Parting::kNever;
    list.push_back({{"tolerance", parting.tolerance},
                    {"evaluation", part ? Json(parting.index + 1) : Json(nullptr)},
                    {"difference", part ? Json(parting.difference) : Json(nullptr)}});
  }
  return list;
}

bool WriteFiles(const Side& first, const Side& second, const std::vector<Parting>& partings,
                FileBatch* batch, std::string* not_drawn, std::string* error) {
  const Json document = {{"format", "batten.replay/1"},      {"problem", FLAGS_problem},
                         {"repetitions", FLAGS_repetitions}, {"first", SideJson(first)},
                         {"second", SideJson(second)},       {"partings", PartingsJson(partings)}};
  const std::string folder = FLAGS_out + "/";
  if (batch->Write(folder + "replay.json", document.dump(2) + "\n", error) == nullptr ||
      batch->Write(folder + "tape_1.csv", TapeCsv(first.tape), error) == nullptr ||
      batch->Write(folder + "tape_2.csv", TapeCsv(second.tape), error) == nullptr) {
    return false;
  }
  PlotPanel panel;
  panel.x_label = "evaluation";
  panel.y_label = "largest difference / largest |x|";
  panel.log_y = true;
  PlotSeries series;
  series.label = second.tape.run.solver.ToString() + " from " + first.tape.run.solver.ToString();
  series.y = Differences(first.tape, second.tape);
  for (std::size_t i = 0; i < series.y.size(); ++i) series.x.push_back(static_cast<double>(i + 1));
  const bool any = std::any_of(series.y.begin(), series.y.end(), [](double y) { return y > 0.0; });
  panel.series.push_back(std::move(series));
  const FigureResult figure = any ? DrawPlot(folder + "replay", {panel}, 1, batch)
                                  : NoFigure(folder + "replay", "the points are the same", batch);
  if (IsWriteError(figure)) {
    *error = figure.message;
    return false;
  }
  if (any) *not_drawn = figure.message;
  return batch->Commit(error);
}

int RunReplay(const std::vector<std::string>& positional, CommandOutput* output) {
  if (!positional.empty()) {
    return Refuse("replay: found " + positional.front() + "; allowed: flags, as in --problem=rhino",
                  output);
  }
  if (!WasGiven("problem")) {
    return Refuse("replay: found no --problem; allowed: a name of batten list problems", output);
  }
  std::string* const error = &output->error;
  NameSpec solver, other;
  CatalogueEntry entry;
  if (!CheckRunFlags(error) || !OneSolver("solver", FLAGS_solver, &solver, error) ||
      !OneSolver("against", WasGiven("against") ? FLAGS_against : FLAGS_solver, &other, error)) {
    return kBadInput;
  }
  if (!FindProblem(FLAGS_problem, &entry, error)) {
    *error = "--problem: " + *error;
    return kBadInput;
  }
  const std::unique_ptr<Problem> problem = LoadProblem(entry, error);
  if (problem == nullptr) return kBadInput;
  if (WasGiven("out") && !CreateDirectories(FLAGS_out, error)) return kBadInput;
  const InterruptibleRun run;
  RunSpec spec = RunSpecFromFlags();
  spec.keep_trace = false;
  Side first, second;
  const auto measure = [&](const NameSpec& name, Side* side) {
    return RecordTape(*problem, name, spec, &side->tape, error) && !InterruptRequested() &&
           MeasureSplit(*problem, side->tape, spec, FLAGS_repetitions, &side->time, error);
  };
  const bool is_recorded = measure(solver, &first) && measure(other, &second);
  if (InterruptRequested()) return kInterruptedStatus;
  if (!is_recorded) return kBadInput;
  const std::vector<Parting> partings = FindPartings(first.tape, second.tape);
  std::string text = SideText(first) + SideText(second) +
                     PartingText(*problem, spec, first.tape, second.tape, partings);
  FileBatch batch;
  std::string not_drawn;
  if (WasGiven("out") && !WriteFiles(first, second, partings, &batch, &not_drawn, error)) {
    return kBadInput;
  }
  output->results = std::move(text);
  if (!WasGiven("out")) return kDone;
  output->results += "Files: " + FLAGS_out + "/replay.json, tape_1.csv, tape_2.csv, replay.svg" +
                     (not_drawn.empty() ? "" : " (" + not_drawn + ")") + "\n";
  return kDone;
}

}  // namespace

Command ReplayCommand() {
  Command command;
  command.name = "replay";
  command.summary = "splits a solver's time, and finds where two solvers part";
  command.details = {
      "Runs both solvers on the problem and records of each a tape: every E, gradient and Hessian "
      "product it asks for, in order, with the points. The tape is then replayed without the "
      "solver: what a run takes longer than that is the solver's own work. Medians of "
      "--repetitions runs and replays in turn.",
      "Then tells where the points of the two tapes are first not the same, bit for bit and by "
      "more than 1e-15, 1e-12 and 1e-8 of the largest |x|. E and |g| at the two points are "
      "evaluated afterwards, scaled as inside. Without --against the solver is held against a "
      "second run of itself: one that parts is not repeatable.",
      "Solvers that ask for Jacobians or projections, or for neither E nor a gradient, are "
      "refused, with what they ask for."};
  command.examples = {
      "batten replay --problem=rhino --solver=lbfgs --against=ceres_lbfgs --out=out/replay",
      "batten replay --problem=rhino --solver=ceres_lbfgs --against=ceres_lbfgs/form=problem "
      "--nocompile"};
  command.flags = {
      TextFlag("problem", "NAME", "a name of batten list problems, a problem file",
               "A problem of the catalogue (batten list problems) or a problem file."),
      TextFlag("solver", "SOLVER", "a solver of batten list solvers, with options or without"),
      TextFlag("against", "SOLVER", "a solver of batten list solvers, with options or without")};
  FlagInfo repetitions = NumberFlag("repetitions", "N", 1.0, 1000.0);
  repetitions.help = "Runs and replays of each solver, in turn; times are medians.";
  command.flags.push_back(std::move(repetitions));
  command.flags.push_back(TextFlag("out", "FOLDER", "a folder",
                                   "Folder for replay.json, the tapes as CSV and a figure, created "
                                   "if missing. Not given: nothing is written."));
  for (FlagInfo& flag : RunFlags()) command.flags.push_back(std::move(flag));
  command.run = &RunReplay;
  return command;
}

}  // namespace batten
