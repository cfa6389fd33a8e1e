// The point sets of the reproduction of Qin & Zhang.
#include <algorithm>

#include "experiments/anderson_paper_runs.h"
#include "experiments/experiment_runs.h"
#include "problems/data_folders.h"
#include "solvers/lanczos.h"

namespace batten {
namespace {

struct Recipe {
  const char* name;
  const char* file;
  int smoothing;  // moving means of 2 * smoothing + 1 points, three times
  int points;
  int control_points;
  double noise;  // half the side of the square that it is uniform in, in the unit box
};
constexpr Recipe kRecipes[] = {{"smooth", "cat_2000", 90, 100, 8, 0.0},
                               {"sharp", "cat_2000", 0, 90, 20, 0.0},
                               {"noisy", "squirrel_2000", 140, 200, 8, 0.03},
                               {"crawling", "rhino_2000", 90, 200, 8, 0.03}};
constexpr std::uint64_t kDataSeed = 20200601;

Points MovingMean(const Points& closed, int reach) {
  const Eigen::Index m = closed.rows();
  Points mean = Points::Zero(m, closed.cols());
  for (Eigen::Index i = 0; i < m; ++i) {
    for (Eigen::Index k = -reach; k <= reach; ++k) mean.row(i) += closed.row((i + k + m) % m);
  }
  return mean / (2.0 * reach + 1.0);
}

Points Every(const Points& points, int count) {
  Points chosen(count, points.cols());
  for (Eigen::Index i = 0; i < count; ++i) chosen.row(i) = points.row(i * points.rows() / count);
  return chosen;
}

void ScaleToUnitBox(Points* points) {
  const Eigen::RowVectorXd low = points->colwise().minCoeff();
  const Eigen::RowVectorXd high = points->colwise().maxCoeff();
  *points = (points->rowwise() - low) / (high - low).maxCoeff();
}

bool MakeExample(const Recipe& recipe, PaperExample* example, std::string* error) {
  const std::string path = DataRoot() + "/data/animals/" + recipe.file + ".csv";
  const std::optional<DataSet> data = ReadDataSet(path, error);
  if (!data) return false;
  Points points = data->points;
  for (int k = 0; recipe.smoothing > 0 && k < 3; ++k) points = MovingMean(points, recipe.smoothing);
  points = Every(points, recipe.points);
  ScaleToUnitBox(&points);
  const Eigen::VectorXd noise = RandomStart(points.size(), kDataSeed);
  points += recipe.noise * Eigen::Map<const Points>(noise.data(), points.rows(), points.cols());
  *example = {recipe.name, recipe.control_points, std::move(points)};
  return true;
}

FitSpec FreeSpec(int control_points) {
  FitSpec spec;
  spec.name = "free";
  spec.closed = true;
  spec.control_points = control_points;
  spec.parameter_kind = ParameterKind::kFree;
  return spec;
}

}  // namespace

const std::vector<std::string>& IteratingMethods() {
  static const auto& names = *new std::vector<std::string>{kJointLbfgs,
                                                           kAndersonPdm,
                                                           "pdm",
                                                           "tdm",
                                                           "sdm",
                                                           "foot_newton",
                                                           "newton",
                                                           "lm_schur",
                                                           "varpro",
                                                           "gi",
                                                           "ceres_lbfgs",
                                                           "ceres_lm",
                                                           "anderson/window=5:gi",
                                                           "anderson/window=5:tdm",
                                                           "anderson/window=5:sdm"};
  return names;
}

const std::vector<std::string>& PaperExampleNames() {
  static const auto& names = *new std::vector<std::string>{"smooth", "sharp", "noisy"};
  return names;
}

const std::vector<std::string>& ShownExampleNames() {
  static const auto& names = *new std::vector<std::string>{"smooth", "sharp", "noisy", "crawling"};
  return names;
}

bool IsPaperExample(const std::string& name) {
  const std::vector<std::string>& names = PaperExampleNames();
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string ExampleLabel(const std::string& name) {
  return IsPaperExample(name) ? name : name + " (ours)";
}

bool ShownExamples(std::vector<PaperExample>* examples, std::string* error) {
  examples->clear();
  for (const Recipe& recipe : kRecipes) {
    PaperExample example;
    if (!MakeExample(recipe, &example, error)) return false;
    examples->push_back(std::move(example));
  }
  return true;
}

std::shared_ptr<const Problem> FreeFit(const Points& points, int control_points,
                                       const std::string& start) {
  DataSet data;
  data.name = "outline";
  data.points = points;
  FitSpec spec = FreeSpec(control_points);
  spec.start = start;
  return CheckedFit(std::move(data), std::move(spec));
}

std::shared_ptr<const Problem> FreeFitFrom(const Points& points, const Points& start) {
  DataSet data;
  data.name = "outline";
  data.points = points;
  FitSpec spec = FreeSpec(static_cast<int>(start.rows()));
  spec.start_points = start;
  return CheckedFit(std::move(data), std::move(spec));
}

}  // namespace batten
