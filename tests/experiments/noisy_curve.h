#ifndef BATTEN_TESTS_EXPERIMENTS_NOISY_CURVE_H_
#define BATTEN_TESTS_EXPERIMENTS_NOISY_CURVE_H_

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "problems/fit_problem.h"
#include "tests/experiments/outlines.h"

namespace batten {

/// A noisy curve of known truth: three random waves a coordinate; open or closed.
struct NoisyCurve {
  explicit NoisyCurve(unsigned seed, int dimension = 2) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0.0, 1.0);
    closed = seed % 2 == 0;
    const int m = 100 + static_cast<int>(seed % 5) * 25;
    noise = 0.01 * std::pow(10.0, (seed % 3) * 0.5);
    std::vector<std::array<double, 6>> waves(static_cast<std::size_t>(dimension));
    for (auto& row : waves) {
      for (double& wave : row) wave = normal(random);
    }
    data.name = "noisy";
    data.points.resize(m, dimension);
    data.parameters = Eigen::VectorXd(m);
    truth.resize(m, dimension);
    for (int i = 0; i < m; ++i) {
      const double t = closed ? static_cast<double>(i) / m : static_cast<double>(i) / (m - 1);
      (*data.parameters)[i] = t;
      for (int c = 0; c < dimension; ++c) {
        const std::array<double, 6>& wave = waves[static_cast<std::size_t>(c)];
        double value = 0.0;
        for (int k = 0; k < 3; ++k) {
          const double a = (closed ? 2.0 : 1.3) * M_PI * (k + 1) * t;
          value += (wave[2 * k] * std::cos(a) + wave[2 * k + 1] * std::sin(a)) / (k + 1);
        }
        truth(i, c) = value;
        data.points(i, c) = value + noise * normal(random);
      }
    }
    spec.closed = closed;
    spec.control_points = m / 2;
    spec.parameters.reset();
    spec.domain = {0.0, 1.0};
  }
  double Error(double weight) const {
    FitSpec weighted = spec;
    std::string error;
    EXPECT_TRUE(ParseNameSpecList("interpolation,fairing/weight=" + NumberText(weight),
                                  &weighted.terms, &error));
    const auto problem = MakeFitProblem(data, weighted, &error);
    const CurveFit& fit = *problem->curve_fit();
    const BsplineCurve curve = fit.Curve(RunSolver(*problem, "banded_qr").x);
    return (curve.Sample(fit.parameters()) - truth).norm();
  }
  bool closed = false;
  double noise = 0.0;
  DataSet data;
  Points truth;
  FitSpec spec;
};

}  // namespace batten

#endif  // BATTEN_TESTS_EXPERIMENTS_NOISY_CURVE_H_
