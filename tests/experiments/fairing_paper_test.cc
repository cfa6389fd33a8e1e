// Every verdict of the reproduction from hand-made tables, each way it can come out; and the
// source's problem.
#include "experiments/fairing_paper.h"

#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <cmath>

#include "cost_functions/options.h"
#include "splines/normal_band.h"
#include "tests/experiments/hand_made_tables.h"
#include "tests/experiments/outlines.h"
#include "tests/splines/example_splines.h"

namespace batten {
namespace {

ExperimentTables CircleTables(const std::vector<double>& bump,
                              const std::vector<double>& variation) {
  CsvTable table({"setting", "bump", "curvature_variation"});
  for (std::size_t i = 0; i < bump.size(); ++i) {
    table.AddRow({kFairingRatios[i].name, NumberText(bump[i]), NumberText(variation[i])});
  }
  return {{"", table}};
}

TEST(FairingPaper, JudgesTheBump) {
  const Experiment circle = FairingPaperCircle();
  EXPECT_EQ(VerdictOn(circle, CircleTables({4, 3, 2, 9}, {4, 3, 2, 9}), 0), kHolds);
  EXPECT_EQ(VerdictOn(circle, CircleTables({4, 3, 3.5, 9}, {4, 3, 2, 9}), 0), kInPart);
  EXPECT_EQ(VerdictOn(circle, CircleTables({4, 5, 3.5, 9}, {4, 3, 3, 9}), 0), kDoesNotHold);
  EXPECT_EQ(VerdictOn(circle, CircleTables({4, 5}, {4, 3}), 0), kUndecided);
}

/// Alike for all shapes but the coast.
ExperimentTables ShapeTables(const std::string& setting, double move, double variation,
                             double curvature, double coast_factor, double bending = 1.0) {
  CsvTable table({"shape", "setting", "largest_move", "curvature_variation", "max_curvature",
                  "bending_energy"});
  for (const char* shape : {"track", "airfoil", "coast"}) {
    const double factor = std::string(shape) == "coast" ? coast_factor : 1.0;
    for (const FairingRatio& ratio : kFairingRatios) {
      const bool asked = setting == ratio.name;
      const bool plain = std::string("interpolation") == ratio.name;
      const double scale = asked ? factor : 1.0;
      table.AddRow({shape, ratio.name, NumberText(plain ? 0.0 : move * scale),
                    NumberText(asked ? variation * scale : 1.0),
                    NumberText(asked ? curvature * scale : 1.0),
                    NumberText(asked ? bending * scale : 1.0)});
    }
  }
  return {{"", table}};
}

TEST(FairingPaper, JudgesWhatTheWeightsDo) {
  const Experiment shapes = FairingPaperShapes();
  // Data are 100 long: a move of 1 is one per cent.
  EXPECT_EQ(VerdictOn(shapes, ShapeTables("0.01 : 1", 0.9, 0.9, 1, 1), 0), kHolds);
  EXPECT_EQ(VerdictOn(shapes, ShapeTables("0.01 : 1", 0.9, 0.9, 1, 1.2), 0), kInPart);
  EXPECT_EQ(VerdictOn(shapes, ShapeTables("0.01 : 1", 1.1, 0.9, 1, 1), 0), kInPart);
  EXPECT_EQ(VerdictOn(shapes, ShapeTables("0.01 : 1", 1.1, 1.1, 1.1, 1, 1.1), 0), kDoesNotHold);
  // What rises on one shape is in the verdict and in its reason.
  const Judgement risen = shapes.claims[0].judge(ShapeTables("0.01 : 1", 0.8, 0.8, 0.9, 1.2, 0.9));
  EXPECT_EQ(risen.verdict, kInPart);
  EXPECT_THAT(risen.because,
              ::testing::EndsWith(": the bending energy rises on the coast, the largest curvature "
                                  "rises on the coast"));
  const Judgement uneven = shapes.claims[2].judge(ShapeTables("1 : 0.01", 1, 0.9, 0.1, 3));
  EXPECT_EQ(uneven.verdict, kInPart);
  EXPECT_THAT(uneven.because, ::testing::HasSubstr(": the coast is less steady than at 1 : 1"));
  EXPECT_EQ(VerdictOn(shapes, ShapeTables("1 : 1", 1, 0.4, 1, 1), 1), kHolds);
  EXPECT_EQ(VerdictOn(shapes, ShapeTables("1 : 1", 1, 0.4, 1, 2), 1), kInPart);
  EXPECT_EQ(VerdictOn(shapes, ShapeTables("1 : 1", 1, 0.6, 1, 1), 1), kDoesNotHold);
  EXPECT_EQ(VerdictOn(shapes, ShapeTables("1 : 0.01", 1, 1, 0.4, 1), 2), kHolds);
  EXPECT_EQ(VerdictOn(shapes, ShapeTables("1 : 0.01", 1, 1, 0.4, 2), 2), kInPart);
  EXPECT_EQ(VerdictOn(shapes, ShapeTables("1 : 0.01", 1, 1.1, 0.6, 1), 2), kDoesNotHold);
  EXPECT_EQ(VerdictOn(shapes, ShapeTables("1 : 0.01", 1, 1.1, 0.4, 1), 2), kInPart);
  EXPECT_EQ(VerdictOn(shapes,
                      {{"", CsvTable({"shape", "setting", "largest_move", "curvature_variation",
                                      "max_curvature", "bending_energy"})}},
                      1),
            kUndecided);
}

ExperimentTables MethodTables(double digits, double heavy_digits, double seconds) {
  CsvTable table({"points", "setting", "method", "seconds", "times_cholesky", "digits"});
  for (const char* points : {"10", "1000"}) {
    for (const char* setting : {"1 : 1", "1 : 0.01", "1 : 1e-8"}) {
      for (const char* method : {"dense_qr", "banded_cholesky", "banded_qr"}) {
        const bool dense = std::string(method) == "dense_qr";
        const bool heavy = std::string(setting) == "1 : 1e-8";
        table.AddRow({points, setting, method, NumberText(dense ? seconds : 1.0), "1",
                      std::string(points) == "1000" ? ""
                                                    : NumberText(!dense  ? 14.0
                                                                 : heavy ? heavy_digits
                                                                         : digits)});
      }
    }
  }
  return {{"", table}};
}

TEST(FairingPaper, JudgesDigitsAndTime) {
  const Experiment method = FairingPaperMethod();
  EXPECT_EQ(VerdictOn(method, MethodTables(12, 11, 1.5), 0), kHolds);
  EXPECT_EQ(VerdictOn(method, MethodTables(12, 7, 1.5), 0), kInPart);
  EXPECT_EQ(VerdictOn(method, MethodTables(9, 7, 1.5), 0), kDoesNotHold);
  EXPECT_EQ(VerdictOn(method, MethodTables(12, 11, 1.5), 1), kHolds);
  EXPECT_EQ(VerdictOn(method, MethodTables(12, 11, 900), 1), kDoesNotHold);
  const ExperimentTables empty = {
      {"", CsvTable({"points", "setting", "method", "seconds", "times_cholesky", "digits"})}};
  EXPECT_EQ(VerdictOn(method, empty, 0), kUndecided);
  EXPECT_EQ(VerdictOn(method, empty, 1), kUndecided);
}

/// The source's formula written down again: M from the basis functions' definition with Bessel's
/// two rows, W from the linear pieces of their second derivatives, all in long double.
Points SourceFormula(const Points& points, double alpha, double beta) {
  using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  const Eigen::Index m = points.rows(), n = m + 2;
  std::vector<double> u(3, 0.0);
  Eigen::VectorXd t = Eigen::VectorXd::Zero(m);
  for (Eigen::Index i = 1; i < m; ++i) {
    t[i] = t[i - 1] + std::sqrt((points.row(i) - points.row(i - 1)).norm());
  }
  u.insert(u.end(), t.data(), t.data() + m);
  u.insert(u.end(), 3, t[m - 1]);
  LongMatrix a = LongMatrix::Zero(n, n), f = LongMatrix::Zero(n, points.cols());
  for (Eigen::Index i = 0; i < m; ++i) {
    for (Eigen::Index j = 0; j < n && i + 1 < m; ++j) {
      a(i, j) = BasisByDefinition(u, static_cast<int>(j), 3, t[i]);
    }
    f.row(i) = points.row(i).cast<long double>();
  }
  a(m - 1, n - 1) = 1.0L;
  const auto bessel = [&](Eigen::Index i, Eigen::Index j, Eigen::Index k) {
    const Eigen::RowVectorXd first = (points.row(j) - points.row(i)) / (t[j] - t[i]);
    const Eigen::RowVectorXd second = (points.row(k) - points.row(j)) / (t[k] - t[j]);
    return Eigen::RowVectorXd(first - (second - first) * (t[j] - t[i]) / (t[k] - t[i]));
  };
  a(m, 0) = a(m + 1, n - 2) = -1.0L;
  a(m, 1) = a(m + 1, n - 1) = 1.0L;
  f.row(m) = (bessel(0, 1, 2) * (t[1] - t[0]) / 3.0).cast<long double>();
  f.row(m + 1) = (bessel(m - 1, m - 2, m - 3) * (t[m - 1] - t[m - 2]) / 3.0).cast<long double>();
  LongMatrix w = LongMatrix::Zero(n, n);
  for (Eigen::Index s = 3; s + 1 < m + 3; ++s) {
    const long double length = static_cast<long double>(u[s + 1]) - u[s];
    const auto at = [&](Eigen::Index j, bool right) {
      const auto hat = [&](Eigen::Index k) {
        return (k == s - 1 && !right) || (k == s && right) ? 1.0L : 0.0L;
      };
      const auto over = [&](long double value, Eigen::Index first, Eigen::Index last) {
        const long double step = static_cast<long double>(u[last]) - u[first];
        return step > 0.0L ? value / step : 0.0L;
      };
      const long double rise = over(hat(j), j, j + 2) - over(hat(j + 1), j + 1, j + 3);
      const long double fall = over(hat(j + 1), j + 1, j + 3) - over(hat(j + 2), j + 2, j + 4);
      return 6.0L * (over(rise, j, j + 3) - over(fall, j + 1, j + 4));
    };
    for (Eigen::Index i = s - 3; i <= s; ++i) {
      for (Eigen::Index j = s - 3; j <= s; ++j) {
        w(i, j) += length / 6.0L *
                   (2.0L * at(i, false) * at(j, false) + at(i, false) * at(j, true) +
                    at(i, true) * at(j, false) + 2.0L * at(i, true) * at(j, true));
      }
    }
  }
  const LongMatrix normal = alpha * w + beta * a.transpose() * a;
  return LongMatrix(normal.ldlt().solve(beta * a.transpose() * f)).cast<double>();
}

TEST(FairingPaper, ControlPointsAreTheSourcesFormula) {
  std::mt19937 random(20250601);
  for (const int dimension : {2, 3}) {
    for (const int m : {6, 25}) {
      Points points = RandomPoints(m, dimension, &random);
      for (int i = 0; i < m; ++i) points(i, 0) += 1.5 * i;
      for (const FairingRatio& ratio : kFairingRatios) {
        const auto problem = SourceFit(points, ratio.alpha, ratio.beta);
        // Inflections are counted in the plane; elsewhere there is no number.
        EXPECT_EQ(FairnessCells(*problem, problem->start()).back().empty(), dimension == 3);
        const Points expected = SourceFormula(points, ratio.alpha, ratio.beta);
        for (const char* solver : {"banded_qr", "dense_qr"}) {
          const Points ours = ControlPointsOf(*problem, RunSolver(*problem, solver));
          EXPECT_LE((ours - expected).cwiseAbs().maxCoeff(), 1e-10 * problem->curve_fit()->size())
              << solver << " " << ratio.name << " m = " << m;
        }
      }
    }
  }
}

/// Knots a step apart from `begin` on, all simple: inside, rows of W are those of the cubic
/// B-spline, whose second derivative is 0, 1, -2, 1, 0 at its knots.
std::vector<double> KnotsFrom(double begin) {
  std::vector<double> u;
  for (int i = 0; i < 14; ++i) u.push_back(begin + i);
  return u;
}

TEST(FairingPaper, WOfUniformKnotsIsKnown) {
  const Eigen::RowVector4d known(8.0 / 3.0, -1.5, 0.0, 1.0 / 6.0);
  const Eigen::MatrixXd formula = SourceFormulaOfW(KnotsFrom(0.0));
  const Eigen::MatrixXd accurate = AccurateW(KnotsFrom(0.0));
  ASSERT_EQ(accurate.rows(), 10);
  EXPECT_LE((accurate.row(3) - known).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_LE((formula.row(3) - known).cwiseAbs().maxCoeff(), 1e-12);
  // Far out differences of cubes have lost what the values at the ends keep.
  const Eigen::MatrixXd far = SourceFormulaOfW(KnotsFrom(1e5));
  EXPECT_LE((AccurateW(KnotsFrom(1e5)).row(3) - known).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_GE((far.row(3) - known).cwiseAbs().maxCoeff(), 1e-7);
}

/// Points of a spiral about one apart.
Points Spiral(int num_points) {
  Points points(num_points, 2);
  for (int i = 0; i < num_points; ++i) {
    const double angle = std::sqrt(2.0 * i + 9.0);
    points.row(i) << angle * std::cos(angle), angle * std::sin(angle);
  }
  return points;
}

TEST(FairingPaper, TheSourcesFormulaAgreesOnShortDataAndLosesDigitsWithTheCubeOfTheParameter) {
  const FormulaErrors few = MeasureSourceFormula(Spiral(10), true);
  const FormulaErrors more = MeasureSourceFormula(Spiral(300), true);
  const FormulaErrors many = MeasureSourceFormula(Spiral(10000), false);
  EXPECT_NEAR(few.reach, 9.0, 1.0);
  EXPECT_LE(few.w, 1e-12);
  EXPECT_LE(few.source, 1e-11);
  EXPECT_GE(more.source, 1e3 * few.source);
  EXPECT_LE(more.dense_qr, 1e-10);
  EXPECT_GE(more.source, 10.0 * more.dense_qr);
  EXPECT_TRUE(std::isnan(many.source));
  const double power = std::log10(many.w / more.w) / std::log10(many.reach / more.reach);
  EXPECT_NEAR(power, 3.0, 0.5);
}

ExperimentTables FormulaTables(double few_w, double many_w, double many_source) {
  CsvTable table({"data", "points", "reach", "w_error", "source_error", "dense_qr_error"});
  table.AddRow({"coast", "10", "100", NumberText(few_w), NumberText(few_w), "1e-13"});
  table.AddRow({"coast", "1000", "1000", NumberText(many_w), NumberText(many_source), "1e-13"});
  table.AddRow({"coast", "10000", "10000", NumberText(many_w), "", ""});
  return {{"", table}};
}

TEST(FairingPaper, JudgesTheFormula) {
  const Experiment formula = FairingPaperFormula();
  EXPECT_EQ(VerdictOn(formula, FormulaTables(1e-12, 1e-11, 1e-11)), kHolds);
  EXPECT_EQ(VerdictOn(formula, FormulaTables(1e-12, 1e-7, 1e-11)), kInPart);
  EXPECT_EQ(VerdictOn(formula, FormulaTables(1e-12, 1e-11, 1e-9)), kInPart);
  EXPECT_EQ(VerdictOn(formula, FormulaTables(1e-9, 1e-7, 1e-7)), kDoesNotHold);
  EXPECT_THAT(formula.claims[0].judge(FormulaTables(1e-12, 1e-9, 1e-8)).because,
              ::testing::AllOf(::testing::HasSubstr("its W has 12 digits"),
                               ::testing::HasSubstr("the control points have 8, "),
                               ::testing::HasSubstr("with the power 1.5 of")));
  EXPECT_EQ(VerdictOn(formula, {{"", CsvTable({"data", "points", "reach", "w_error", "source_error",
                                               "dense_qr_error"})}}),
            kUndecided);
}

}  // namespace
}  // namespace batten
