// Fits a closed cubic to points on an ellipse with two solvers and compares their ends: what a
// program outside Batten's tree needs, from the installed package alone. Plugins may follow on its
// name; their solvers come behind ours.

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "experiments/run.h"
#include "problems/fit_problem.h"
#include "solvers/plugin_loader.h"

int main(int argc, char** argv) {
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
  std::vector<batten::LoadedPlugin> plugins;
  error = batten::LoadPlugins(std::vector<std::string>(argv + 1, argv + argc), &plugins);
  if (!error.empty()) {
    std::fprintf(stderr, "%s\n", error.c_str());
    return 2;
  }
  std::vector<std::string> solvers = {"banded_qr", "lbfgs"};
  for (const batten::LoadedPlugin& plugin : plugins) {
    for (const batten::PluginName& name : plugin.names) {
      if (name.kind == "solver") solvers.push_back(name.name);
    }
  }
  double minimum = 0.0;
  for (const std::string& solver : solvers) {
    batten::NameSpec name;
    batten::RunResult result;
    if (!batten::ParseNameSpec(solver, &name, &error) ||
        !batten::Run(*problem, name, batten::RunSpec(), &result, &error)) {
      std::fprintf(stderr, "%s\n", error.c_str());
      return 2;
    }
    std::printf("%-16s %3d iterations  E = %.12g  %s\n", solver.c_str(), result.iterations,
                result.energy, batten::ToString(result.outcome.reason));
    if (solver == solvers.front()) minimum = result.energy;
    // All end at the one minimum: E is flat there, so that E agrees to rounding of its own size.
    if (!(std::abs(result.energy - minimum) <= 1e-12 * minimum)) return 1;
  }
  return 0;
}
