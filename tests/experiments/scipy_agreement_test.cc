#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <vector>

#include "tests/experiments/outlines.h"

namespace batten {
namespace {

/// All control points of one fit by SciPy, from the file that scipy_control_points.py beside this
/// one writes.
struct ScipyFit {
  std::string problem;  // of the catalogue
  double moved = 0.0;   // by so many sizes of the data, along each axis
  std::vector<std::vector<double>> control_points;
};

std::vector<ScipyFit> ReadScipyFits() {
  std::ifstream file(BATTEN_SOURCE_DIR "/tests/experiments/scipy_control_points.csv");
  std::string line;
  std::getline(file, line);
  std::vector<ScipyFit> fits;
  while (std::getline(file, line)) {
    std::istringstream fields(line);
    std::string problem, field;
    std::getline(fields, problem, ',');
    std::vector<double> numbers;
    while (std::getline(fields, field, ',')) numbers.push_back(std::stod(field));
    if (numbers[1] == 0.0) fits.push_back({problem, numbers[0], {}});
    fits.back().control_points.emplace_back(numbers.begin() + 2, numbers.end());
  }
  return fits;
}

std::unique_ptr<Problem> Moved(const ScipyFit& scipy) {
  const auto problem = LoadCatalogueProblem(scipy.problem);
  const CurveFit& fit = *problem->curve_fit();
  DataSet data = fit.data();
  data.points.array() += scipy.moved * fit.size();
  std::string error;
  auto moved = MakeFitProblem(data, fit.spec(), &error);
  CHECK(moved != nullptr) << error;
  return moved;
}

TEST(ScipyAgreement, OfBandedQrIsWithinRoundingOfTheDataAsTheyLie) {
  const std::vector<ScipyFit> fits = ReadScipyFits();
  ASSERT_EQ(fits.size(), 12U);
  for (const ScipyFit& scipy : fits) {
    SCOPED_TRACE(scipy.problem + (scipy.moved == 0.0 ? "" : ", moved"));
    const auto problem = Moved(scipy);
    const Points ours = ControlPointsOf(*problem, RunSolver(*problem, "banded_qr"));
    // Where the data lie far off, SciPy's own numbers keep this much of their size.
    const double tolerance = (scipy.moved == 0.0 ? 1e-10 : 1e-8) * problem->curve_fit()->size();
    ASSERT_EQ(static_cast<Eigen::Index>(scipy.control_points.size()), ours.rows());
    for (Eigen::Index j = 0; j < ours.rows(); ++j) {
      const std::vector<double>& theirs = scipy.control_points[static_cast<std::size_t>(j)];
      ASSERT_EQ(static_cast<Eigen::Index>(theirs.size()), ours.cols());
      for (Eigen::Index c = 0; c < ours.cols(); ++c) {
        EXPECT_NEAR(ours(j, c), theirs[static_cast<std::size_t>(c)], tolerance)
            << "control point " << j << ", coordinate " << c;
      }
    }
  }
}

}  // namespace
}  // namespace batten
