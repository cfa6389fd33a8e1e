#ifndef BATTEN_TESTS_SOLVERS_TEST_FITS_H_
#define BATTEN_TESTS_SOLVERS_TEST_FITS_H_

#include <glog/logging.h>

#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "problems/fit_problem.h"
#include "splines/basis_functions.h"

namespace batten {

inline FitSpec MakeSpec(int degree, bool closed, int control_points,
                        const std::string& terms = "interpolation") {
  FitSpec spec;
  spec.degree = degree;
  spec.closed = closed;
  spec.control_points = control_points;
  spec.parameters = Parameterization::kCentripetal;
  std::string error;
  CHECK(ParseNameSpecList(terms, &spec.terms, &error)) << error;
  return spec;
}

/// Of a fit whose parameters are variables.
inline FitSpec MakeFreeSpec(int degree, bool closed, int control_points,
                            const std::string& start = "circle",
                            const std::string& terms = "free_parameter") {
  FitSpec spec = MakeSpec(degree, closed, control_points, terms);
  spec.parameter_kind = ParameterKind::kFree;
  spec.start = start;
  return spec;
}

/// Of a fit whose parameters are always the foot points.
inline FitSpec MakeProjectedSpec(int degree, bool closed, int control_points,
                                 const std::string& start = "circle",
                                 const std::string& terms = "foot_point") {
  FitSpec spec = MakeSpec(degree, closed, control_points, terms);
  spec.parameter_kind = ParameterKind::kProjected;
  spec.start = start;
  return spec;
}

/// A fit of points of data/, "animals/rhino_100.csv".
inline std::unique_ptr<Problem> MakeFileFit(const std::string& path, FitSpec spec) {
  std::string error;
  std::optional<DataSet> data = ReadDataSet(std::string(BATTEN_SOURCE_DIR "/data/") + path, &error);
  CHECK(data.has_value()) << error;
  std::unique_ptr<Problem> problem = MakeFitProblem(std::move(*data), std::move(spec), &error);
  CHECK(problem != nullptr) << error;
  return problem;
}

inline std::unique_ptr<Problem> Rhino() {
  return MakeFileFit("animals/rhino_100.csv", MakeSpec(3, true, 40));
}

inline std::unique_ptr<Problem> Dolphin() {
  FitSpec spec = MakeSpec(3, true, 40);
  spec.parameters = Parameterization::kUniform;
  return MakeFileFit("animals/dolphin_80.csv", spec);
}

/// Points near a bent loop without symmetry, off it by noise of standard deviation 0.1, with
/// weights in [0.1, 2].
inline DataSet MakeNoisyLoop(int num_points, int dimension, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 0.1);
  std::uniform_real_distribution<double> weight(0.1, 2.0);
  DataSet data;
  data.name = "noisy_loop";
  data.points.resize(num_points, dimension);
  data.weights = Eigen::VectorXd(num_points);
  for (int i = 0; i < num_points; ++i) {
    const double angle = 6.28 * i / num_points;
    for (int c = 0; c < dimension; ++c) {
      data.points(i, c) =
          3.0 * std::sin((c + 1) * angle + 0.7 * c) + std::cos(2.0 * angle + c) + noise(random);
    }
    (*data.weights)[i] = weight(random);
  }
  return data;
}

/// Points near a bean, which a circle grows into; from the third coordinate on waves. Noise of
/// standard deviation 0.03, weights in [0.5, 2].
inline DataSet MakeNoisyBean(int num_points, int dimension, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 0.03);
  std::uniform_real_distribution<double> weight(0.5, 2.0);
  DataSet data;
  data.name = "noisy_bean";
  data.points.resize(num_points, dimension);
  data.weights = Eigen::VectorXd(num_points);
  for (int i = 0; i < num_points; ++i) {
    const double angle = 2.0 * M_PI * (i + 0.3) / num_points;
    const double radius = 2.0 + 0.5 * std::cos(2.0 * angle + 0.4) + 0.3 * std::sin(3.0 * angle);
    for (int c = 0; c < dimension; ++c) {
      const double wave = c == 0   ? radius * std::cos(angle)
                          : c == 1 ? 0.8 * radius * std::sin(angle)
                                   : 0.5 * std::sin(c * angle);
      data.points(i, c) = wave + noise(random);
    }
    (*data.weights)[i] = weight(random);
  }
  return data;
}

inline std::unique_ptr<Problem> MakeFit(DataSet data, FitSpec spec) {
  std::string error;
  std::unique_ptr<Problem> problem = MakeFitProblem(std::move(data), std::move(spec), &error);
  CHECK(problem != nullptr) << error;
  return problem;
}

/// sum_j B_j(t) P_j = value in coordinate `coordinate`, inside the problem (scaled); t in the
/// domain.
inline LinearConstraint HoldCurve(const Problem& problem, double t, int coordinate, double value) {
  const CurveFit& fit = *problem.curve_fit();
  const BsplineBasis& basis = fit.basis();
  const int span = basis.FindSpan(t);
  std::vector<double> values(static_cast<std::size_t>(basis.order()));
  EvaluateBasis(basis.degree(), basis.knots().data(), span, t, values.data());
  LinearConstraint constraint;
  constraint.name = "curve held";
  constraint.value = value;
  for (int j = 0; j < basis.order(); ++j) {
    const int point = basis.ControlPointIndex(span - basis.degree() + j);
    constraint.coefficients.emplace_back(point * fit.dimension() + coordinate,
                                         values[static_cast<std::size_t>(j)]);
  }
  return constraint;
}

inline void SetConstraints(const std::vector<LinearConstraint>& constraints, Problem* problem) {
  std::string error;
  CHECK(problem->SetLinearConstraints(constraints, &error)) << error;
}

}  // namespace batten

#endif  // BATTEN_TESTS_SOLVERS_TEST_FITS_H_
