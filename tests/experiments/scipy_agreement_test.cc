#include <gtest/gtest.h>

#include "tests/experiments/outlines.h"

namespace batten {
namespace {

struct ScipyControlPoint {
  int index;
  std::vector<double> coordinates;
};

struct ScipyFit {
  const char* problem;  // of the catalogue
  double moved;         // by so many sizes of the data, along each axis
  std::vector<ScipyControlPoint> control_points;
};

// By SciPy 1.10 and NumPy 1.24, from the folder above data/:
//
//   import numpy as np
//   from scipy.interpolate import BSpline, make_lsq_spline
//   def read(path, moved):
//       q = np.loadtxt('data/' + path, delimiter=',', skiprows=1)
//       return q + moved * (q.max(0) - q.min(0)).max()
//   def closed(q, n):  # uniform cubic: the basis unrolled, the first three functions once more
//       m = len(q)
//       unrolled = BSpline.design_matrix(np.arange(m) / m, np.arange(-3, n + 4) / n, 3).toarray()
//       a = unrolled[:, :n].copy()
//       a[:, :3] += unrolled[:, n:]
//       return np.linalg.lstsq(a, q, rcond=None)[0]
//   def clamped(q, n, power):  # averaged knots of The NURBS Book, 9.68 and 9.69
//       steps = np.linalg.norm(np.diff(q, axis=0), axis=1) ** power
//       t = np.append(0, np.cumsum(steps)) / steps.sum(); t[-1] = 1
//       jd = np.arange(1, n - 3) * len(q) / (n - 3)
//       i = jd.astype(int); a = jd - i
//       inner = (1 - a) * t[i - 1] + a * t[i]
//       return make_lsq_spline(t, q, np.r_[[0] * 4, inner, [1] * 4], 3).c
//
//   closed(read('animals/rhino_100.csv', moved), 80), and so on for the four outlines with 80, 80,
//   40 and 83 control points;
//   clamped(read('airfoils/naca2412_open.csv', moved), 40, 1),
//   clamped(read('curves3d/protein_3aid_a_ca_open.csv', moved), 60, 0.5)
const std::vector<ScipyFit> kScipyFits = {
    {"rhino",
     0.0,
     {{0, {122.01951637924766, -112.62097257829404}},
      {7, {123.8045288900066, -67.31883754762228}},
      {40, {13.777632380181991, -62.88982105176344}},
      {79, {114.89294091835875, -112.12885644706002}}}},
    {"squirrel",
     0.0,
     {{0, {462.31165244988904, -261.4814623233482}},
      {7, {365.0314784519974, -114.45532596913003}},
      {40, {116.92068966934579, -204.08425765651504}},
      {79, {425.2056528190335, -243.39675203840306}}}},
    {"dolphin",
     0.0,
     {{0, {451.78557182984986, -135.10964741450763}},
      {7, {265.38503547299024, -65.84927397323656}},
      {20, {31.690112779453706, -426.1141631409409}},
      {39, {411.45064689719175, -141.14252691172663}}}},
    {"cat",
     0.0,
     {{0, {117.20817132341325, -57.951420581229364}},
      {7, {103.30623237857091, -44.10763091422988}},
      {41, {16.823102444014413, -41.799151603292614}},
      {82, {114.04224032261348, -63.57391002915612}}}},
    {"airfoil",
     0.0,
     {{1, {0.9877445986745115, 0.0037964151130217122}},
      {7, {0.6129003425284797, 0.06226366856277728}},
      {20, {-0.000861586816058218, -0.0008084630823800185}},
      {38, {0.9823121059142664, -0.002562697712397747}}}},
    {"protein",
     0.0,
     {{1, {4.293100405086466, 12.523548663870557, 43.22187166138252}},
      {7, {-2.7130654305556003, -2.2850430129065797, 29.478217906174958}},
      {30, {10.090579280003563, -5.802217429110597, 10.623537504361291}},
      {58, {9.391115657813033, 12.887797060274822, 30.74145800505185}}}},
    {"rhino",
     1e6,
     {{0, {119416174.2733722, 119415939.63288331}},
      {7, {119416176.0583852, 119415984.93501885}},
      {40, {119416066.03148836, 119415989.36403495}},
      {79, {119416167.1467968, 119415940.1249994}}}},
    {"squirrel",
     1e6,
     {{0, {464835222.27587295, 464834498.4827581}},
      {7, {464835124.9957009, 464834645.5088959}},
      {40, {464834876.8849108, 464834555.87996316}},
      {79, {464835185.1698755, 464834516.56747067}}}},
    {"dolphin",
     1e6,
     {{0, {475834419.1894565, 475833832.2942379}},
      {7, {475834232.7889213, 475833901.5546105}},
      {20, {475833999.0939979, 475833541.2897222}},
      {39, {475834378.8545315, 475833826.2613573}}}},
    {"cat",
     1e6,
     {{0, {120342366.24567808, 120342191.08608612}},
      {7, {120342352.34373827, 120342204.92987497}},
      {41, {120342265.8606089, 120342207.2383549}},
      {82, {120342363.07974695, 120342185.46359682}}}},
    {"airfoil",
     1e6,
     {{1, {999995.4110255993, 999994.4270774162}},
      {7, {999995.0361813437, 999994.4855446669}},
      {20, {999994.4224194131, 999994.4224725392}},
      {38, {999995.405593105, 999994.420718302}}}},
    {"protein",
     1e6,
     {{1, {34439004.29310062, 34439012.52354839, 34439043.221871555}},
      {7, {34438997.286934584, 34438997.71495702, 34439029.47821787}},
      {30, {34439010.090579234, 34438994.19778256, 34439010.62353755}},
      {58, {34439009.39111562, 34439012.88779708, 34439030.74145802}}}},
};

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

class ScipyAgreement : public ::testing::TestWithParam<ScipyFit> {};

TEST_P(ScipyAgreement, OfBandedQrIsWithinRoundingOfTheDataAsTheyLie) {
  const ScipyFit& scipy = GetParam();
  const auto problem = Moved(scipy);
  const Points ours = ControlPointsOf(*problem, RunSolver(*problem, "banded_qr"));
  // Where the data lie far off, SciPy's own numbers keep this much of their size.
  const double tolerance = (scipy.moved == 0.0 ? 1e-10 : 1e-8) * problem->curve_fit()->size();
  for (const ScipyControlPoint& theirs : scipy.control_points) {
    ASSERT_EQ(static_cast<int>(theirs.coordinates.size()), ours.cols());
    for (int c = 0; c < ours.cols(); ++c) {
      EXPECT_NEAR(ours(theirs.index, c), theirs.coordinates[static_cast<std::size_t>(c)], tolerance)
          << "control point " << theirs.index << ", coordinate " << c;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Fits, ScipyAgreement, ::testing::ValuesIn(kScipyFits),
                         [](const auto& row) {
                           return std::string(row.param.problem) +
                                  (row.param.moved == 0.0 ? "" : "_moved");
                         });

}  // namespace
}  // namespace batten
