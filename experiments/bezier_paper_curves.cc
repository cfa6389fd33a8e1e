#include "experiments/bezier_paper_curves.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "problems/data_folders.h"
#include "problems/svg_file.h"

namespace batten {
namespace {

/// Not a distribution of the standard library's, whose numbers differ between libraries.
double Between(double low, double high, std::mt19937* random) {
  constexpr double kRange = 4294967296.0;
  return low + (high - low) * ((*random)() / kRange);
}

Points WavePoints(int degree, std::mt19937* random) {
  const double amplitude = Between(0.5, 1.5, random);
  const double periods = Between(1.0, 4.0, random);
  const double phase = Between(0.0, 2.0 * M_PI, random);
  constexpr double kLength = 4.0;
  Points points(degree + 1, 2);
  for (int i = 0; i <= degree; ++i) {
    const double s = i / static_cast<double>(degree);
    points.row(i) << kLength * s, amplitude * std::sin(2.0 * M_PI * periods * s + phase);
  }
  return points;
}

}  // namespace

const std::vector<std::string>& CurveFamilies() {
  static const auto& families = *new std::vector<std::string>{"uniform", "walk", "wave"};
  return families;
}

BezierCurve FamilyCurve(const std::string& family, int degree, int number) {
  const std::vector<std::string>& families = CurveFamilies();
  const auto index = std::find(families.begin(), families.end(), family) - families.begin();
  CHECK_LT(index, static_cast<std::ptrdiff_t>(families.size())) << "no curve family " << family;
  std::seed_seq seeds = {static_cast<int>(index), degree, number};
  std::mt19937 random(seeds);
  Points points(degree + 1, 2);
  if (family == "wave") {
    points = WavePoints(degree, &random);
  } else {
    for (int i = 0; i <= degree; ++i) {
      const double x = Between(-1.0, 1.0, &random), y = Between(-1.0, 1.0, &random);
      points.row(i) << x, y;
      if (family == "walk" && i > 0) points.row(i) += points.row(i - 1);
    }
  }
  return *BezierCurve::Make(std::move(points), nullptr);
}

bool GlyphCurves(const std::string& name, std::vector<BezierCurve>* curves, std::string* error) {
  std::vector<BezierPath> paths;
  std::string left_out;
  const std::string file = DataRoot() + "/data/glyphs/" + name + ".svg";
  if (!ReadSvgPaths(file, &paths, &left_out, error)) return false;
  for (const BezierPath& path : paths) {
    for (const BezierSpan& span : path.spans) {
      if (span.curve.degree() > 1) curves->push_back(span.curve);
    }
  }
  return true;
}

}  // namespace batten
