// Fits a closed cubic to points on an ellipse with two solvers and compares their ends: what a
// program outside Batten's tree needs, from the installed package alone.

#include <cmath>
#include <cstdio>
#include <string>

#include "experiments/run.h"
#include "problems/fit_problem.h"

int main() {
  constexpr int kNumPoints = 60;
  batten::DataSet data;
  data.name = "ellipse";
  data.points.resize(kNumPoints, 2);
  for (int i = 0; i < kNumPoints; ++i) {
    const double angle = 2.0 * M_PI * i / kNumPoints;
    data.points.row(i) << 3.0 * std::cos(angle), 2.0 * std::sin(angle);
  }
  batten::FitSpec spec;
  spec.closed = true;
  spec.control_points = 12;

  std::string error;
  const auto problem = batten::MakeFitProblem(data, spec, &error);
  if (problem == nullptr) {
    std::fprintf(stderr, "%s\n", error.c_str());
    return 2;
  }
  double energies[2] = {0.0, 0.0};
  const char* const solvers[2] = {"banded_qr", "lbfgs"};
  for (int s = 0; s < 2; ++s) {
    batten::NameSpec name;
    batten::RunResult result;
    if (!batten::ParseNameSpec(solvers[s], &name, &error) ||
        !batten::Run(*problem, name, batten::RunSpec(), &result, &error)) {
      std::fprintf(stderr, "%s\n", error.c_str());
      return 2;
    }
    energies[s] = result.energy;
    std::printf("%-10s %3d iterations  E = %.12g  %s\n", solvers[s], result.iterations,
                result.energy, batten::ToString(result.outcome.reason));
  }
  // Both end at the one minimum: E is flat there, so that E agrees to rounding of its own size.
  return std::abs(energies[0] - energies[1]) <= 1e-12 * energies[0] ? 0 : 1;
}
