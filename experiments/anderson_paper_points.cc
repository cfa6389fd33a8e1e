#include "experiments/anderson_paper.h"
#include "experiments/anderson_paper_growth.h"
#include "experiments/anderson_paper_runs.h"
#include "solvers/lanczos.h"

namespace batten {
namespace {

constexpr const char* kPointsColumn = "points";

/// `points` and `extra` more around each, in a box of side 0.05.
Points WithExtraPoints(const Points& points, int extra) {
  constexpr double kHalfSide = 0.025;
  constexpr std::uint64_t kSeed = 20200602;
  const Eigen::Index each = extra + 1;
  Points all(each * points.rows(), points.cols());
  const Eigen::VectorXd moves = RandomStart(all.size(), kSeed);
  for (Eigen::Index i = 0; i < all.rows(); ++i) {
    all.row(i) = points.row(i / each);
    if (i % each == 0) continue;
    for (Eigen::Index c = 0; c < all.cols(); ++c) {
      all(i, c) += kHalfSide * moves[i * all.cols() + c];
    }
  }
  return all;
}

bool RunPoints(const ExperimentRun& run, ExperimentTables* tables, std::string* error) {
  CsvTable& table = (*tables)[""] = CsvTable(GrowthColumns());
  std::vector<PaperExample> examples;
  if (!ShownExamples(&examples, error)) return false;
  const PaperExample& example = examples.front();
  const int extras[] = {0, 1, 3, 7, 15};
  double done = 0.0;
  for (const int extra : extras) {
    if (InterruptRequested()) return true;
    const Points points = WithExtraPoints(example.points, extra);
    AddGrowthRows(*FreeFit(points, example.control_points, "circle"), run,
                  done / static_cast<double>(std::size(extras)), &table);
    done += 1.0;
  }
  return true;
}

}  // namespace

Experiment AndersonPaperPoints() {
  Experiment experiment;
  experiment.name = "points";
  experiment.title = "Time per iteration against the number of points";
  experiment.text =
      "The smooth example with 0, 1, 3, 7 and 15 extra points around each of its 100, at random "
      "(seeded) in a box of side 0.05: up to 1600 points, 8 control points. Time per iteration "
      "over the first 30, set-up left out. An iteration of L-BFGS is one or more evaluations; one "
      "of PDM, TDM and SDM holds a search for all feet, one of Anderson two.";
  experiment.run = &RunPoints;
  experiment.shown = [](const ExperimentTables& tables) {
    return GrowthShown(tables, kPointsColumn);
  };
  experiment.claims = {
      {"the cost per iteration is linear in the points", "its text",
       "holds where the time per iteration of both methods grows no faster than points^1.15, by a "
       "fit of the logarithms, in part where that of one, else does not hold",
       [](const ExperimentTables& tables) { return JudgeLinear(tables, kPointsColumn); }},
      {"PDM, TDM and SDM slow down fast with the size: points", "its text",
       "holds where their times per iteration all grow faster than points^1.5, in part where some "
       "do, else does not hold",
       [](const ExperimentTables& tables) { return JudgeSlowsDown(tables, kPointsColumn); }}};
  experiment.figures = {
      {"points_times", "Time per iteration against the number of points.", 1,
       [](const ExperimentTables& tables) { return AgainstGrowth(tables, kPointsColumn); }}};
  return experiment;
}

}  // namespace batten
