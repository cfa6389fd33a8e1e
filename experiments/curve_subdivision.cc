#include "experiments/curve_subdivision.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "experiments/build_info.h"
#include "experiments/short_number.h"
#include "splines/bezier_distance.h"

namespace batten {
namespace {

using Json = nlohmann::ordered_json;

Json NumberOrNull(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

/// Adds what one curve came to.
void Add(int path, const BezierSpan& span, bool is_first, const Subdivision& part,
         std::vector<double>* coordinates, CurveSubdivision* whole) {
  for (std::size_t i = is_first ? 0 : 1; i < part.parameters.size(); ++i) {
    const double s = part.parameters[i];
    whole->vertices.push_back(
        {path, s == 1.0 ? span.end : span.begin + s * (span.end - span.begin)});
    const double* point =
        part.vertices.data() + static_cast<std::ptrdiff_t>(i) * part.vertices.cols();
    coordinates->insert(coordinates->end(), point, point + part.vertices.cols());
  }
  ++whole->num_curves;
  whole->num_pieces += part.num_pieces();
  whole->rounds = std::max(whole->rounds, part.rounds);
  whole->cuts += part.cuts;
  whole->evaluations += part.evaluations;
  whole->num_failing += part.num_failing;
  if (part.end > whole->end || (whole->message.empty() && part.end == whole->end)) {
    whole->message = part.message;
  }
  whole->end = std::max(whole->end, part.end);
}

void AddError(const BezierCurve& curve, const Subdivision& part, CurveSubdivision* whole) {
  const Eigen::Map<const Eigen::VectorXd> parameters(
      part.parameters.data(), static_cast<Eigen::Index>(part.parameters.size()));
  const DistanceBounds bounds = BoundHausdorffDistance(curve, parameters, part.vertices);
  whole->error_at_most = std::max(whole->error_at_most, bounds.upper);
  // Another curve's polyline may pass nearer: no bound for more curves than one.
  whole->error_at_least =
      whole->num_curves == 1 ? bounds.lower : std::numeric_limits<double>::quiet_NaN();
}

/// A rule that tells of its progress.
class WatchedRule final : public CutRule {
 public:
  WatchedRule(CutRule* rule, const SubdivisionProgress& progress, int num_curves)
      : rule_(*rule), progress_(progress), num_curves_(num_curves) {}

  CutRuleInfo Info() const override { return rule_.Info(); }
  std::string WhyUnsupported(const BezierCurve& curve,
                             const SubdivisionOptions& options) const override {
    return rule_.WhyUnsupported(curve, options);
  }
  void Start(const BezierCurve& curve, const SubdivisionOptions& options) override {
    rule_.Start(curve, options);
    is_uniform_ = options.mode == SubdivisionMode::kUniform;
    ++curve_;
    Tell(0.0, 0);
  }
  bool AlwaysHalves() const override { return rule_.AlwaysHalves(); }
  double Choose(CutTrial* trial) override {
    constexpr int kSeldom = 16;  // looking at the clock takes as long as a cut
    if (++num_choices_ % kSeldom == 0) Tell(trial->begin(), trial->depth());
    return rule_.Choose(trial);
  }

 private:
  void Tell(double done, int round) const {
    if (!progress_) return;
    progress_((curve_ + done) / num_curves_,
              "curve " + std::to_string(curve_ + 1) + " of " + std::to_string(num_curves_) +
                  (is_uniform_ ? ", round " + std::to_string(round + 1) : ""));
  }

  CutRule& rule_;
  const SubdivisionProgress& progress_;
  const int num_curves_;
  int curve_ = -1;
  int num_choices_ = 0;
  bool is_uniform_ = false;
};

bool CheckRoom(const SubdivisionOptions& options, double size, int num_curves, std::string* error) {
  if (!std::isfinite(size)) {
    *error =
        "the box of all control points is wider than the largest number; allowed: a box up to "
        "1.797e308 wide";
    return false;
  }
  if (num_curves <= options.max_pieces) return true;
  *error = "max_pieces is " + std::to_string(options.max_pieces) + ", must be at least " +
           std::to_string(num_curves) + ", a piece for each curve";
  return false;
}

/// Empty unless control_points has missed the tolerance.
std::string MissedTolerance(const SubdivisionOptions& options, const CurveSubdivision& result) {
  // Certified to 1e-3.
  constexpr double kSlack = 1.002;
  constexpr int kDigits = 3;
  const double wanted = options.relative_tolerance * result.size;
  if (options.stop != StopMeasure::kControlPoints || result.end != SubdivisionEnd::kAllPass ||
      !(wanted > 0.0) || result.error_at_most <= kSlack * wanted) {
    return "";
  }
  return "the true error is up to " + ShortNumber(result.error_at_most / wanted, kDigits) +
         " times the tolerance: control_points measures from the lines of chords, beyond whose "
         "ends "
         "the curve may go; polygon and segment keep it";
}

}  // namespace

bool SubdivideCurves(const std::vector<BezierPath>& paths, CutRule* rule,
                     const SubdivisionOptions& options, const SubdivisionProgress& progress,
                     CurveSubdivision* result, std::string* error) {
  *result = CurveSubdivision();
  result->size = BoxSideOf(paths);
  int num_curves = 0;
  for (const BezierPath& path : paths) num_curves += static_cast<int>(path.spans.size());
  if (!CheckRoom(options, result->size, num_curves, error)) return false;
  WatchedRule watched(rule, progress, num_curves);
  SubdivisionOptions part_options = options;
  part_options.reference_size = result->size;
  std::vector<double> coordinates;
  int dimension = 1;
  for (std::size_t p = 0; p < paths.size(); ++p) {
    bool is_first = true;
    for (const BezierSpan& span : paths[p].spans) {
      Subdivision part;
      part_options.max_pieces = static_cast<int>((options.max_pieces - result->num_pieces) /
                                                 (num_curves - result->num_curves));
      const auto begin = std::chrono::steady_clock::now();
      if (!SubdivideBy(&watched, span.curve, part_options, &part, error)) return false;
      const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
      result->seconds += taken.count();
      dimension = span.curve.dimension();
      Add(static_cast<int>(p), span, is_first, part, &coordinates, result);
      AddError(span.curve, part, result);
      is_first = false;
    }
  }
  result->points = Eigen::Map<const Points>(
      coordinates.data(), static_cast<Eigen::Index>(result->vertices.size()), dimension);
  if (num_curves > 1 && result->num_failing > 0) {
    result->message = std::to_string(result->num_failing) + " of " +
                      std::to_string(result->num_pieces) + " pieces of all " +
                      std::to_string(num_curves) + " curves do not pass; of one curve, " +
                      result->message;
  }
  const std::string missed = MissedTolerance(options, *result);
  if (!missed.empty()) result->message += (result->message.empty() ? "" : "; ") + missed;
  return true;
}

std::string PolylineCsv(const CurveSubdivision& result) {
  const bool has_paths = !result.vertices.empty() && result.vertices.back().path > 0;
  const std::string names = "x,y,z,w";
  const auto d = static_cast<std::size_t>(result.points.cols());
  std::string text = (has_paths ? "path,t," : "t,") + names.substr(0, 2 * d - 1) + "\n";
  for (std::size_t i = 0; i < result.vertices.size(); ++i) {
    if (has_paths) text += std::to_string(result.vertices[i].path) + ",";
    text += NumberText(result.vertices[i].t);
    for (Eigen::Index c = 0; c < result.points.cols(); ++c) {
      text += "," + NumberText(result.points(static_cast<Eigen::Index>(i), c));
    }
    text += "\n";
  }
  return text;
}

std::string SubdivisionJson(const std::string& input, const std::string& rule,
                            const OptionValues& rule_options, const SubdivisionOptions& options,
                            const CurveSubdivision& result) {
  Json json;
  json["format"] = "batten.subdivision/1";
  json["input"] = input;
  json["rule"] = rule;
  json["rule_options"] = rule_options.ToText();
  json["stop"] = ToString(options.stop);
  json["relative_tolerance"] = options.relative_tolerance;
  json["subdivision"] = ToString(options.mode);
  json["size"] = NumberOrNull(result.size);
  json["curves"] = result.num_curves;
  json["pieces"] = result.num_pieces;
  json["rounds"] = result.rounds;
  json["cuts"] = result.cuts;
  json["evaluations"] = result.evaluations;
  json["seconds"] = result.seconds;
  json["true_error"] = {{"at_most", NumberOrNull(result.error_at_most)},
                        {"at_least", NumberOrNull(result.error_at_least)},
                        {"relative_at_most", NumberOrNull(result.error_at_most / result.size)}};
  json["end"] = ToString(result.end);
  json["failing_pieces"] = result.num_failing;
  json["message"] = result.message;
  json["version"] = kVersion;
  json["commit"] = kGitCommit;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace batten
