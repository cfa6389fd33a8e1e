#include "solvers/best_cut_rule.h"

#include "solvers/cut_search.h"
#include "splines/bezier_measures.h"

namespace batten {
namespace {

constexpr char kSource[] =
    "Ma, Lin, Shen, Optimal subdivision parameters for planar Bezier curves, 2016";
constexpr int kPapersRounds = 3;
constexpr int kMostNarrowings = 30;

}  // namespace

std::vector<OptionInfo> BestCutRule::Options() {
  return {OptionInfo::Integer("rounds", kPapersRounds, 0, kMostNarrowings,
                              "Pieces that stem from fewer cuts are cut at the best place, others "
                              "at 1/2; with choice=automatic the most rounds."),
          OptionInfo::Word("choice", "fixed", {"fixed", "automatic"},
                           "automatic: within the rounds, only pieces whose control polygon turns "
                           "by more than 45 degrees from the chord."),
          OptionInfo::Word("search", "grid", {"grid", "exact"},
                           "grid: the best of u = 0.2, 0.25, ..., 0.8; exact: of all local "
                           "minima.")};
}

BestCutRule::BestCutRule(CutMeasure measure, const OptionValues& options)
    : measure_(measure),
      is_exact_(options.Word("search") == "exact"),
      is_automatic_(options.Word("choice") == "automatic"),
      num_rounds_(options.Integer("rounds")) {}

bool BestCutRule::IsSearched(const CutTrial& trial) const {
  if (trial.depth() >= num_rounds_ || trial.degree() < 2) return false;
  return !is_automatic_ ||
         SquaredLegSlope(trial.degree(), trial.dimension(), trial.points(), 0.0) > 1.0;
}

double BestCutRule::Choose(CutTrial* trial) {
  if (!IsSearched(*trial)) return CutAtHalf(trial);
  CutValue value(measure_, trial->degree(), trial->dimension(), trial->points());
  const CutPlace best = is_exact_ ? ExactMinimum(&value) : GridMinimum(&value);
  trial->Count(value.num_evaluations());
  return best.u;
}

CutRuleInfo FlatnessCutRule::ClassInfo() {
  CutRuleInfo info;
  info.name = "flatness";
  info.summary =
      "where both parts' control polygons are flattest, in the first rounds; then at 1/2";
  info.source = kSource;
  info.options = Options();
  return info;
}

CutRuleInfo HullCutRule::ClassInfo() {
  CutRuleInfo info;
  info.name = "hull";
  info.summary = "where both parts' hulls are smallest, in the first rounds; then at 1/2";
  info.source = kSource;
  info.options = Options();
  return info;
}

std::string HullCutRule::WhyUnsupported(const BezierCurve& curve,
                                        const SubdivisionOptions& /*options*/) const {
  if (curve.dimension() == 2) return "";
  return "hull needs a planar curve; found " + std::to_string(curve.dimension()) +
         " coordinates, use flatness";
}

}  // namespace batten
