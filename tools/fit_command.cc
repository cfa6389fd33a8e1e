#include <gflags/gflags.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "experiments/atomic_file.h"
#include "experiments/curvature_figure.h"
#include "experiments/end_notes.h"
#include "experiments/figures.h"
#include "experiments/fit_report.h"
#include "experiments/loss_notes.h"
#include "experiments/max_distance_fit.h"
#include "experiments/run.h"
#include "experiments/short_number.h"
#include "solvers/solver_registry.h"
#include "tools/command.h"
#include "tools/fairing_flags.h"
#include "tools/fit_request.h"
#include "tools/fit_summary.h"
#include "tools/interrupts.h"
#include "tools/max_distance_flags.h"
#include "tools/output_files.h"
#include "tools/progress.h"
#include "tools/run_flags.h"

DEFINE_string(solver, "lbfgs",
              "The solver with its options, as in lbfgs/memory=5 (batten list solvers).");
DEFINE_string(trace, "", "CSV, one row per iteration.");
DEFINE_string(iterates, "", "JSON lines, control points and parameters at each iteration.");
DEFINE_string(figure, "",
              "SVG of data, control polygon and curve, drawn by gnuplot; its script (.gp) and data "
              "(.dat) stay beside it.");
DEFINE_string(
    curvature_figure, "",
    "SVG of the curvature: combs and curvature over arc length of the fit, of the curve that "
    "interpolates the data, and of the same fit without its fairing terms, where "
    "banded_qr solves these.");

namespace batten {
namespace {

constexpr char kAllowedFigure[] = "NAME.svg, with one character or more before the ending";

/// How far a run is, by whichever limit or goal is nearest.
double Fraction(const RunSpec& spec, const TraceRow& row, double start_gradient_norm) {
  double fraction = row.seconds / spec.max_seconds;
  if (spec.max_iterations > 0) {
    fraction = std::max(fraction, row.iteration / static_cast<double>(spec.max_iterations));
  }
  if (spec.mode == Mode::kRace && spec.gradient_tolerance > 0.0 && row.gradient_norm > 0.0) {
    // One digit of the gradient takes about as long as another.
    fraction = std::max(fraction, std::log(row.gradient_norm / start_gradient_norm) /
                                      std::log(spec.gradient_tolerance));
  }
  return fraction;
}

bool RunWithProgress(const Problem& problem, const NameSpec& solver, RunSpec spec,
                     RunResult* result, std::string* error) {
  const InterruptibleRun interruptible;
  constexpr int kDigits = 4;
  Progress progress(FLAGS_quiet);
  double start_gradient_norm = 0.0;
  spec.progress = [&](const TraceRow& row) {
    if (row.iteration == 0) start_gradient_norm = row.gradient_norm;
    if (!progress.IsDue()) return;
    progress.Show(Fraction(spec, row, start_gradient_norm),
                  "iteration " + std::to_string(row.iteration) + ", E " +
                      ShortNumber(row.energy, kDigits) + ", |g| " +
                      ShortNumber(row.gradient_norm, kDigits));
  };
  return Run(problem, solver, spec, result, error);
}

std::vector<OutputFile> Outputs() {
  std::vector<OutputFile> outputs;
  if (WasGiven("out")) outputs.push_back({"out", FLAGS_out});
  if (WasGiven("trace")) outputs.push_back({"trace", FLAGS_trace});
  if (WasGiven("iterates")) outputs.push_back({"iterates", FLAGS_iterates});
  const auto add_figure = [&outputs](const std::string& flag, const std::string& path) {
    if (!WasGiven(flag)) return;
    for (const std::string& name :
         {path, WithExtension(path, ".gp"), WithExtension(path, ".dat")}) {
      outputs.push_back({flag, name});
    }
  };
  add_figure("figure", FLAGS_figure);
  add_figure("fairing_figure", FLAGS_fairing_figure);
  add_figure("curvature_figure", FLAGS_curvature_figure);
  return outputs;
}

/// What a run is written to.
struct Written {
  std::vector<std::string> files;
  std::string problem;  // not empty: something is missing all the same
};

bool Drew(const FigureResult& figure, const std::string& flag, const std::string& path,
          Written* written, std::string* error) {
  if (IsWriteError(figure)) {
    *error = figure.message;
    return false;
  }
  if (figure.drawn) written->files.push_back(path);
  if (!figure.drawn) written->problem = "--" + flag + ": " + figure.message;
  return true;
}

bool DrawFitFigure(const Problem& problem, const RunResult& run, FileBatch* batch, Written* written,
                   std::string* error) {
  return Drew(FitFigure(problem, run, WithExtension(FLAGS_figure, ""), batch), "figure",
              FLAGS_figure, written, error);
}

bool DrawChoice(const FairingChoice& choice, FileBatch* batch, Written* written,
                std::string* error) {
  const std::vector<PlotPanel> panels = FairingChoicePanels(choice);
  const int columns = panels.size() == 4 ? 2 : 3;
  return Drew(DrawPlot(WithExtension(FLAGS_fairing_figure, ""), panels, columns, batch),
              "fairing_figure", FLAGS_fairing_figure, written, error);
}

bool DrawCurvature(const Problem& problem, const RunResult& run, FileBatch* batch, Written* written,
                   std::string* error) {
  const std::string stem = WithExtension(FLAGS_curvature_figure, "");
  const CurveFit& fit = *problem.curve_fit();
  if (fit.dimension() < 2 || !run.x.allFinite()) {
    return Drew(NoFigure(stem, "curvature needs a curve in the plane or in space", batch),
                "curvature_figure", FLAGS_curvature_figure, written, error);
  }
  const std::vector<PlotPanel> panels = CurvaturePanels(FitBesideOthers(problem, run.x));
  const int columns = panels.size() == 4 ? 2 : static_cast<int>(panels.size());
  return Drew(DrawPlot(stem, panels, columns, batch), "curvature_figure", FLAGS_curvature_figure,
              written, error);
}

/// All files or none: a full disk and an interrupt leave what was there before.
bool WriteFiles(const Problem& problem, const RunResult& run, const RunSpec& spec,
                const FitReport& report, Written* written, std::string* error) {
  FileBatch batch;
  const auto write = [&](const std::string& flag, const std::string& path, const auto& fill) {
    if (!WasGiven(flag)) return true;
    AtomicFile* const file = batch.Open(path, error);
    if (file == nullptr) return false;
    written->files.push_back(path);
    fill(&file->stream());
    // Now, not at the end: /dev/stdout may be given twice. What failed, Commit() says.
    return file->stream().flush() || file->Commit(error);
  };
  const auto fill_fit = [&](std::ostream* stream) {
    WriteFitJson(problem, run, spec, report, stream);
  };
  const auto fill_trace = [&](std::ostream* stream) { *stream << RunTraceCsv(problem, run); };
  const auto fill_iterates = [&](std::ostream* stream) {
    *stream << IteratesJsonLines(problem, run);
  };
  return write("out", FLAGS_out, fill_fit) && write("trace", FLAGS_trace, fill_trace) &&
         write("iterates", FLAGS_iterates, fill_iterates) &&
         (!WasGiven("figure") || DrawFitFigure(problem, run, &batch, written, error)) &&
         (!WasGiven("curvature_figure") || DrawCurvature(problem, run, &batch, written, error)) &&
         (!WasGiven("fairing_figure") ||
          DrawChoice(*report.fairing_choice, &batch, written, error)) &&
         batch.Commit(error);
}

/// Iterates stay in memory until the run has ended. False with one sentence for more of them than
/// that is good for; a direct solver has but its start and its end.
bool CheckIteratesFit(const Problem& problem, const NameSpec& solver, const RunSpec& spec,
                      std::string* error) {
  constexpr double kMostGibibytes = 4.0;
  const SolverInfo* const info = SolverRegistry::Global().Find(solver.name);
  if (!spec.keep_iterates || (info != nullptr && info->native_rule == NativeRule::kDirect)) {
    return true;
  }
  const double gibibytes =
      std::ldexp(sizeof(double) * (1.0 + spec.max_iterations) * problem.num_variables(), -30);
  if (gibibytes <= kMostGibibytes) return true;
  *error = "--iterates: those of " + std::to_string(spec.max_iterations) + " iterations with " +
           std::to_string(problem.num_variables()) + " variables would take " +
           ShortNumber(gibibytes, 3) + " GiB of memory; allowed: at most " +
           ShortNumber(kMostGibibytes, 3) + "; use a lower --max_iterations";
  return false;
}

int FitAndWrite(const FitRequest& request, const NameSpec& solver, const RunSpec& spec,
                CommandOutput* output) {
  std::optional<FairingChoice> choice;
  const std::unique_ptr<Problem> problem = LoadFit(request, &choice, &output->error);
  if (problem == nullptr || !CheckIteratesFit(*problem, solver, spec, &output->error)) {
    return kBadInput;
  }
  RunResult run;
  if (!RunWithProgress(*problem, solver, spec, &run, &output->error)) return kBadInput;
  if (InterruptRequested()) {
    output->error = "interrupted; nothing was written";
    return kInterruptedStatus;
  }
  if (!run.skipped.empty()) return Refuse("--solver: " + run.skipped, output);

  NoteDistanceFromMinimum(*problem, &run);
  NoteLosses(*problem, &run);
  FitReport report = MeasureFit(*problem, run, spec);
  report.fairing_choice = std::move(choice);
  if (report.fairness.has_value()) NoteErrorsOfRules(*problem, *report.fairness, &run);
  Written written;
  if (!WriteFiles(*problem, run, spec, report, &written, &output->error)) return kBadInput;
  output->results = FitSummary(request.label, *problem, run, report, written.files);
  if (report.audited && !report.verdict.holds) {
    output->error = "audit: " + solver.ToString() + " " + report.verdict.failure;
    return kDisagreement;
  }
  if (!written.problem.empty()) return Refuse(written.problem, output);
  if (ReachedTarget(run, spec, report)) return kDone;
  output->error = NotReachedMessage(run, spec);
  return kNotReached;
}

bool SearchWithProgress(const FitRequest& request, MaxDistanceFit* fit, std::string* error) {
  std::optional<DataSet> data = LoadData(request.entry, error);
  if (!data.has_value()) return false;
  FitSpec spec = request.spec;
  // A rule of its own where the user names none: distances are along the curve.
  if (!WasGiven("parameters")) spec.parameters = Parameterization::kChordLength;
  const InterruptibleRun interruptible;
  Progress progress(FLAGS_quiet);
  const auto watch = [&](int num_control_points, double fraction) {
    if (progress.IsDue()) {
      progress.Show(fraction, std::to_string(num_control_points) + " control points");
    }
    return !InterruptRequested();
  };
  if (FitWithinDistance(*std::move(data), spec, MaxDistance(), watch, fit, error)) return true;
  if (!InterruptRequested()) *error = request.source + ": " + *error;
  return false;
}

int SearchAndWrite(const FitRequest& request, CommandOutput* output) {
  MaxDistanceFit fit;
  if (!SearchWithProgress(request, &fit, &output->error)) {
    return InterruptRequested() ? kInterruptedStatus : kBadInput;
  }
  const RunSpec spec;
  const FitReport report = MeasureFit(*fit.problem, fit.run, spec);
  Written written;
  if (!WriteFiles(*fit.problem, fit.run, spec, report, &written, &output->error)) {
    return kBadInput;
  }
  output->results = FitSummary(request.label, *fit.problem, fit.run, report, written.files);
  if (report.audited && !report.verdict.holds) {
    output->error = "audit: " + fit.run.solver.ToString() + " " + report.verdict.failure;
    return kDisagreement;
  }
  if (!written.problem.empty()) return Refuse(written.problem, output);
  return kDone;
}

int RunFit(const std::vector<std::string>& positional, CommandOutput* output) {
  std::vector<NameSpec> solvers;
  std::string* const error = &output->error;
  if (!SolversFromFlag("solver", FLAGS_solver, &solvers, error)) return kBadInput;
  if (solvers.size() != 1) {
    return Refuse(RefusedFlag("solver", FLAGS_solver, "one solver"), output);
  }
  for (const auto& [flag, path] : {std::pair("figure", FLAGS_figure),
                                   {"fairing_figure", FLAGS_fairing_figure},
                                   {"curvature_figure", FLAGS_curvature_figure}}) {
    if (WasGiven(flag) && WithExtension(path, ".svg") != path) {
      return Refuse(RefusedFlag(flag, path, kAllowedFigure), output);
    }
  }
  FitRequest request;
  if (!MakeFitRequest(positional, &request, error)) return kBadInput;
  if (AsksForMaxDistance() && !CheckMaxDistanceFlags(FitCommand().flags, request.spec, error)) {
    return kBadInput;
  }
  if (!CheckOutputs(Outputs(), request.input_files, error)) return kBadInput;
  if (AsksForMaxDistance()) return SearchAndWrite(request, output);
  if (!CheckRunFlags(error)) return kBadInput;
  RunSpec spec = RunSpecFromFlags();
  spec.keep_iterates = WasGiven("iterates");
  // Without its file the trace only tells the observed rate, which is not worth all memory.
  constexpr int kMostRows = 1'000'000;
  spec.keep_trace = WasGiven("trace") || spec.max_iterations <= kMostRows;
  return FitAndWrite(request, solvers.front(), spec, output);
}

}  // namespace

Command FitCommand() {
  Command command;
  command.name = "fit";
  command.arguments = "FILE | --problem=NAME";
  command.summary = "fits one spline to the points of FILE (- is standard input)";
  command.details = {
      "FILE is CSV with a header (x,y or x,y,z, ...; also t for given parameters and weight) or "
      "rows of numbers. Lengths are in the unit of the data, E in its square; seconds are seconds.",
      "Exit status 1: the solver failed or did not reach what was asked. line_search_ended and "
      "native_stop count as reached where |g| is so small that a step along -g lowers E by less "
      "than the rounding of E. Status 3: the claim failed its audit. Without gnuplot --figure "
      "gives status 2; all but the picture is written."};
  command.examples = {
      "batten fit data/animals/rhino_100.csv --closed --control_points=80 --out=fit.json",
      "batten fit --problem=rhino --solver=lspia/step=optimal --trace=trace.csv "
      "--figure=rhino.svg",
      "batten fit data/animals/rhino_2000.csv --closed --max_distance=0.5 --figure=rhino.svg"};
  command.flags = FitRequestFlags();
  command.flags.push_back(
      TextFlag("solver", "SOLVER", "a solver of batten list solvers, with options or without"));
  for (FlagInfo& flag : RunFlags()) command.flags.push_back(std::move(flag));
  command.flags.push_back(TextFlag("out", "FILE", "a file", "The fit as JSON (docs/formats.md)."));
  for (const char* name : {"trace", "iterates"}) {
    command.flags.push_back(TextFlag(name, "FILE", "a file"));
  }
  command.flags.push_back(TextFlag("figure", "FILE", kAllowedFigure));
  command.flags.push_back(TextFlag("curvature_figure", "FILE", kAllowedFigure));
  command.flags.push_back(SwitchFlag("quiet"));
  command.run = &RunFit;
  return command;
}

}  // namespace batten
