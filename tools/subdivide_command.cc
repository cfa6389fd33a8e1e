#include <gflags/gflags.h>

#include <memory>

#include "experiments/atomic_file.h"
#include "experiments/curve_subdivision.h"
#include "experiments/short_number.h"
#include "solvers/cut_rule_registry.h"
#include "tools/command.h"
#include "tools/output_files.h"
#include "tools/progress.h"
#include "tools/run_flags.h"

DEFINE_string(rule, "longest",
              "Where pieces are cut, with options, as in flatness/rounds=3 (batten list rules).");
DEFINE_string(stop, batten::ToString(batten::SubdivisionOptions().stop),
              "What must be small on a piece: polygon (largest distance of a control point from "
              "the chord's segment) and segment (of the curve itself) bound the true error; "
              "control_points (distance from the chord's line, the rule of most papers), flatness "
              "(sum of its squares), hull_area (planar curves) and angle (of the control polygon "
              "with the chord) do not.");
DEFINE_double(relative_tolerance, batten::SubdivisionOptions().relative_tolerance,
              "Of the stop measure, relative to the larger side of the control points' box (areas "
              "and squares: to its square); of angle: radians, below pi / 2.");
DEFINE_string(subdivision, batten::ToString(batten::SubdivisionOptions().mode),
              "adaptive: only pieces that fail are cut; uniform: every piece, until all pass.");
DEFINE_int32(max_depth, batten::SubdivisionOptions().max_depth,
             "No piece narrower than 2^-N of its curve is cut; uniform: most rounds.");
DEFINE_int32(max_pieces, batten::SubdivisionOptions().max_pieces,
             "Most pieces of all curves together.");
DEFINE_string(report, "", "JSON: pieces, rounds, cuts, evaluations, seconds, true error.");
DECLARE_string(figure);
DECLARE_bool(quiet);

namespace batten {
namespace {

constexpr char kAllowedFigure[] = "NAME.svg, with one character or more before the ending";
constexpr double kHighestDepth = 50.0;
constexpr double kMostPieces = 16777216.0;

std::vector<OutputFile> Outputs() {
  std::vector<OutputFile> outputs;
  if (WasGiven("out")) outputs.push_back({"out", FLAGS_out});
  if (WasGiven("report")) outputs.push_back({"report", FLAGS_report});
  if (WasGiven("figure")) {
    outputs.push_back({"figure", FLAGS_figure});
    outputs.push_back({"figure", WithExtension(FLAGS_figure, ".gp")});
    outputs.push_back({"figure", WithExtension(FLAGS_figure, ".dat")});
  }
  return outputs;
}

bool OptionsFromFlags(SubdivisionOptions* options, std::string* error) {
  FromString(FLAGS_stop, &options->stop);
  FromString(FLAGS_subdivision, &options->mode);
  options->relative_tolerance = FLAGS_relative_tolerance;
  options->max_depth = FLAGS_max_depth;
  options->max_pieces = FLAGS_max_pieces;
  if (options->IsValid(error)) return true;
  *error = "--" + *error;
  return false;
}

struct Request {
  std::string path;
  std::vector<BezierPath> curves;
  std::string left_out;
  std::string rule_name;
  std::unique_ptr<CutRule> rule;
  OptionValues rule_options;
  SubdivisionOptions options;
};

bool MakeRequest(const std::vector<std::string>& positional, Request* request, std::string* error) {
  if (positional.size() != 1) {
    *error = "subdivide: found " + std::to_string(positional.size()) + " files; allowed: one";
    return false;
  }
  request->path = positional.front();
  NameSpec spec;
  std::string reason;
  if (!ParseNameSpec(FLAGS_rule, &spec, &reason) ||
      (request->rule = CutRuleRegistry::Global().Make(spec, &request->rule_options, &reason)) ==
          nullptr) {
    *error = "--rule: " + reason;
    return false;
  }
  request->rule_name = spec.ToString();
  if (WasGiven("figure") && WithExtension(FLAGS_figure, ".svg") != FLAGS_figure) {
    *error = RefusedFlag("figure", FLAGS_figure, kAllowedFigure);
    return false;
  }
  return OptionsFromFlags(&request->options, error) &&
         ReadBezierFile(request->path, &request->curves, &request->left_out, error) &&
         CheckOutputs(Outputs(), {request->path}, error);
}

bool WriteFiles(const Request& request, const CurveSubdivision& result, std::string* not_drawn,
                std::string* error) {
  FileBatch batch;
  if (WasGiven("out") && batch.Write(FLAGS_out, PolylineCsv(result), error) == nullptr)
    return false;
  if (WasGiven("report") &&
      batch.Write(FLAGS_report,
                  SubdivisionJson(request.path, request.rule_name, request.rule_options,
                                  request.options, result),
                  error) == nullptr) {
    return false;
  }
  if (WasGiven("figure")) {
    const FigureResult figure =
        SubdivisionFigure(request.curves, result, WithExtension(FLAGS_figure, ""), &batch);
    if (IsWriteError(figure)) {
      *error = figure.message;
      return false;
    }
    if (!figure.drawn) *not_drawn = "--figure: " + figure.message;
  }
  return batch.Commit(error);
}

std::string Summary(const Request& request, const CurveSubdivision& result) {
  constexpr int kDigits = 4;
  const std::string relative =
      result.size > 0.0 ? " (" + ShortNumber(result.error_at_most / result.size, kDigits) +
                              " of the size " + ShortNumber(result.size, kDigits) + ")"
                        : "";
  return request.path + ": " + std::to_string(result.num_curves) + " curve" +
         (result.num_curves == 1 ? "" : "s") + ", rule " + request.rule_name + ", stop " +
         ToString(request.options.stop) + " " +
         ShortNumber(request.options.relative_tolerance, kDigits) + ", " +
         ToString(request.options.mode) + "\n  pieces " + std::to_string(result.num_pieces) +
         ", rounds " + std::to_string(result.rounds) + ", cuts " + std::to_string(result.cuts) +
         ", evaluations " + std::to_string(result.evaluations) + ", " +
         ShortNumber(result.seconds, kDigits) + " s\n  true error at most " +
         ShortNumber(result.error_at_most, kDigits) + relative + "\n" +
         (result.message.empty() ? "" : "  " + result.message + "\n");
}

bool Subdivided(const Request& request, CurveSubdivision* result, std::string* reason) {
  Progress progress(FLAGS_quiet);
  const auto show = [&progress](double fraction, const std::string& text) {
    progress.Show(fraction, text);
  };
  if (!SubdivideCurves(request.curves, request.rule.get(), request.options, show, result, reason)) {
    return false;
  }
  if (!request.left_out.empty()) {
    result->message += (result->message.empty() ? "" : "; ") + ("left out: " + request.left_out) +
                       ", since only paths are read";
  }
  return true;
}

int RunSubdivide(const std::vector<std::string>& positional, CommandOutput* output) {
  Request request;
  if (!MakeRequest(positional, &request, &output->error)) return kBadInput;
  CurveSubdivision result;
  std::string reason;
  if (!Subdivided(request, &result, &reason)) {
    return Refuse(request.path + ": " + reason, output);
  }
  std::string not_drawn;
  if (!WriteFiles(request, result, &not_drawn, &output->error)) return kBadInput;
  output->results = Summary(request, result);
  if (!not_drawn.empty()) return Refuse(not_drawn, output);
  if (result.end == SubdivisionEnd::kAllPass) return kDone;
  output->error = request.path + ": " + result.message;
  return kNotReached;
}

}  // namespace

Command SubdivideCommand() {
  Command command;
  command.name = "subdivide";
  command.arguments = "FILE";
  command.summary = "cuts Bezier curves into pieces that their chords can stand for";
  command.details = {
      "FILE: control points of one Bezier curve as CSV with a header x,y or x,y,z, or rows of "
      "numbers without commas (- is standard input), a "
      "fit.json, whose spline is cut span by span, JSON with control_points, or an SVG file, whose "
      "paths are cut curve by curve (M, L, H, V, C, S, Q, T, Z); other shapes are left out, and "
      "that is said; an arc (A) or a transform is refused.",
      "The true error is a certified upper bound of the Hausdorff distance of curves and "
      "polylines. "
      "Exit status 1: a bound on depth or pieces was hit; the polyline is written all the same."};
  command.examples = {
      "batten subdivide curve.csv --rule=flatness --relative_tolerance=1e-5 --out=polyline.csv "
      "--figure=cut.svg",
      "batten subdivide fit.json --rule=longest --stop=segment --report=counts.json"};
  FlagInfo figure =
      TextFlag("figure", "FILE", kAllowedFigure,
               "SVG of control polygon, curve, polyline and cuts, drawn by gnuplot; its script "
               "(.gp) and data (.dat) stay beside it.");
  command.flags = {
      TextFlag("rule", "RULE", "a rule of batten list rules, with options or without"),
      WordFlag("stop", StopMeasureNames()),
      NumberFlag("relative_tolerance", "R", 0.0, 1e150),
      WordFlag("subdivision", {"adaptive", "uniform"}),
      NumberFlag("max_depth", "N", 1.0, kHighestDepth),
      NumberFlag("max_pieces", "N", 1.0, kMostPieces),
      TextFlag("out", "FILE", "a file", "The polyline as CSV: t, x, y; path in front of several."),
      TextFlag("report", "FILE", "a file"),
      std::move(figure),
      SwitchFlag("quiet")};
  command.run = &RunSubdivide;
  return command;
}

}  // namespace batten
