// One of each kind that is neither solver nor term.
#include <cmath>
#include <fstream>

#include "solvers/plugin.h"

namespace {

class Third final : public batten::CutRule {
 public:
  static batten::CutRuleInfo ClassInfo() { return {"third", "cuts at a third", "none", {}}; }
  explicit Third(const batten::OptionValues& /*options*/) {}
  batten::CutRuleInfo Info() const override { return ClassInfo(); }
  double Choose(batten::CutTrial* /*trial*/) override { return 1.0 / 3.0; }
};

std::optional<batten::DataSet> Circle(std::string* /*error*/) {
  constexpr int kNumPoints = 48;
  batten::DataSet data;
  data.points.resize(kNumPoints, 2);
  for (int i = 0; i < kNumPoints; ++i) {
    const double angle = 2.0 * M_PI * i / kNumPoints;
    data.points.row(i) << std::cos(angle), std::sin(angle);
  }
  return data;
}

/// Pairs of numbers behind the word "pairs".
std::optional<batten::DataSet> ReadPairs(const std::string& path, std::string* error) {
  std::ifstream file(path);
  std::string word;
  file >> word;
  if (word != "pairs") {
    *error = path + ":1:1: found no word pairs; allowed: pairs, then numbers";
    return std::nullopt;
  }
  batten::DataSet data;
  for (double x = 0.0, y = 0.0; file >> x >> y;) {
    data.points.conservativeResize(data.points.rows() + 1, 2);
    data.points.bottomRows(1) << x, y;
  }
  return data;
}

}  // namespace

BATTEN_PLUGIN(registry) {
  registry->AddCutRule<Third>();
  batten::NamedProblem circle;
  circle.name = "made_circle";
  circle.summary = "48 points on a circle, made by a plugin";
  circle.spec.closed = true;
  circle.spec.control_points = 8;
  circle.make_data = &Circle;
  registry->Add(circle);
  registry->Add(batten::DataReader{"pairs", "pairs of numbers", ".pairs", &ReadPairs});
}
