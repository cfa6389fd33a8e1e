#include <algorithm>
#include <cmath>

#include "cost_functions/options.h"
#include "experiments/bezier_paper.h"
#include "experiments/bezier_paper_curves.h"
#include "experiments/bezier_paper_runs.h"
#include "experiments/experiment_runs.h"
#include "experiments/run.h"

namespace batten {
namespace {

constexpr int kNumMovedCurves = 30;
constexpr int kMovedDegree = 16;

struct NamedMap {
  std::string kind;
  double amount;
  Eigen::Matrix2d matrix;
};

std::vector<NamedMap> Maps() {
  constexpr double kDegreesOfTurn = 7.5;
  constexpr int kTurns = 12;
  std::vector<NamedMap> maps;
  for (int k = 0; k <= kTurns; ++k) {
    const double angle = k * kDegreesOfTurn;
    const double c = std::cos(angle * M_PI / 180.0), s = std::sin(angle * M_PI / 180.0);
    maps.push_back({"rotation", angle, (Eigen::Matrix2d() << c, -s, s, c).finished()});
  }
  for (const double factor : {0.01, 3.0, 1000.0}) {
    maps.push_back({"scaling", factor, factor * Eigen::Matrix2d::Identity()});
  }
  for (const double shear : {0.5, 2.0}) {
    maps.push_back({"shear", shear, (Eigen::Matrix2d() << 1, shear, 0, 1).finished()});
  }
  for (const double stretch : {0.1, 4.0}) {
    maps.push_back({"stretching", stretch, (Eigen::Matrix2d() << 1, 0, 0, stretch).finished()});
  }
  return maps;
}

bool RunAffine(const ExperimentRun& run, ExperimentTables* tables, std::string* /*error*/) {
  CsvTable& table = (*tables)[""] =
      CsvTable({"curve", "map", "amount", "pieces", "pieces_before", "rounds", "rounds_before"});
  const std::unique_ptr<CutRule> half = CheckedCutRule("half");
  const auto halved = [&half](const BezierCurve& curve, SubdivisionMode mode) {
    return RunRule(half.get(), curve, PaperSubdivision(mode), 1).result;
  };
  for (int k = 0; k < kNumMovedCurves; ++k) {
    if (InterruptRequested()) return true;
    if (run.progress) run.progress(static_cast<double>(k) / kNumMovedCurves, "maps");
    const BezierCurve curve = FamilyCurve("walk", kMovedDegree, k);
    const int pieces = halved(curve, SubdivisionMode::kAdaptive).num_pieces();
    const int rounds = halved(curve, SubdivisionMode::kUniform).rounds;
    for (const NamedMap& map : Maps()) {
      const BezierCurve mapped =
          *BezierCurve::Make(curve.control_points() * map.matrix.transpose(), nullptr);
      table.AddRow({std::to_string(k), map.kind, NumberText(map.amount),
                    std::to_string(halved(mapped, SubdivisionMode::kAdaptive).num_pieces()),
                    std::to_string(pieces),
                    std::to_string(halved(mapped, SubdivisionMode::kUniform).rounds),
                    std::to_string(rounds)});
    }
  }
  return true;
}

/// Of the rows of one kind of map: how many change pieces, how many rounds, and by how much.
struct Changes {
  int rows = 0;
  int pieces = 0;
  int rounds = 0;
  double largest = 0.0;  // of |ratio of pieces - 1|
};
Changes ChangesBy(const CsvTable& rows) {
  Changes changes;
  for (std::size_t k = 0; k < rows.num_rows(); ++k) {
    const double ratio = rows.Number(k, "pieces") / rows.Number(k, "pieces_before");
    ++changes.rows;
    changes.pieces += ratio == 1.0 ? 0 : 1;
    changes.rounds += rows.Number(k, "rounds") == rows.Number(k, "rounds_before") ? 0 : 1;
    changes.largest = std::max(changes.largest, std::abs(ratio - 1.0));
  }
  return changes;
}

Judgement JudgeInvariance(const ExperimentTables& tables) {
  Judgement judgement;
  int unchanged = 0, kinds = 0;
  for (const std::string& kind : tables.at("").Distinct("map")) {
    const Changes changes = ChangesBy(tables.at("").Where("map", kind));
    ++kinds;
    unchanged += changes.pieces == 0 && changes.rounds == 0 ? 1 : 0;
    judgement.because += (judgement.because.empty() ? "" : "; ") + kind + " changes pieces in " +
                         std::to_string(changes.pieces) + " of " + std::to_string(changes.rows) +
                         " cases, by up to " + Rounded(100.0 * changes.largest, 0) +
                         " %, and uniform rounds in " + std::to_string(changes.rounds);
  }
  judgement.verdict = kinds == 0           ? ClaimVerdict::kUndecided
                      : unchanged == kinds ? ClaimVerdict::kHolds
                      : unchanged > 0      ? ClaimVerdict::kInPart
                                           : ClaimVerdict::kDoesNotHold;
  return judgement;
}

CsvTable ShownChanges(const ExperimentTables& tables) {
  CsvTable shown({"map", "amount", "curves", "pieces change", "by up to, %", "rounds change"});
  for (const std::string& kind : tables.at("").Distinct("map")) {
    const CsvTable of_kind = tables.at("").Where("map", kind);
    for (const std::string& amount : of_kind.Distinct("amount")) {
      const Changes changes = ChangesBy(of_kind.Where("amount", amount));
      shown.AddRow({kind, amount, std::to_string(changes.rows), std::to_string(changes.pieces),
                    Rounded(100.0 * changes.largest, 1), std::to_string(changes.rounds)});
    }
  }
  return shown;
}

}  // namespace

Experiment BezierPaperAffine() {
  Experiment experiment;
  experiment.name = "affine";
  experiment.title = "The stop rule under affine maps";
  experiment.text =
      "30 curves of degree 16 of the family `walk`, turned, scaled, sheared and stretched, then "
      "halved by the paper's stop rule. Its distances are relative to the larger side of an "
      "upright "
      "box, which turns into another length when the curve is turned; shear and stretching change "
      "distances themselves.";
  experiment.run = &RunAffine;
  experiment.shown = &ShownChanges;
  experiment.claims = {
      {"the stop rule does not change under affine maps", "section on the stop rule",
       "holds where no map changes the number of pieces or rounds of any curve; in "
       "part where some kind of map does not",
       &JudgeInvariance}};
  return experiment;
}

}  // namespace batten
