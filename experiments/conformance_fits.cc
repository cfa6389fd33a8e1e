#include "experiments/conformance_fits.h"

#include <glog/logging.h>

#include <cmath>
#include <random>
#include <utility>

#include "cost_functions/term.h"

namespace batten {
namespace {

/// Points near a bean, weights between 0.5 and 2.
DataSet MakeBean(int num_points, int dimension) {
  std::mt19937 random(20240507);
  std::uniform_real_distribution<double> noise(-0.05, 0.05);
  std::uniform_real_distribution<double> weight(0.5, 2.0);
  DataSet data;
  data.name = "bean";
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

struct Kind {
  std::string name;
  int num_points;
  int dimension;
  int degree;
  bool closed;
  int control_points;
  ParameterKind parameters;
  bool weighted;
};

const std::vector<Kind>& SmallKinds() {
  static const auto& kinds = *new std::vector<Kind>{
      {"closed 2-D", 40, 2, 3, true, 12, ParameterKind::kFixed, true},
      {"open 3-D", 30, 3, 3, false, 9, ParameterKind::kFixed, true},
      {"open 1-D", 30, 1, 2, false, 8, ParameterKind::kFixed, false},
      {"through all points", 20, 2, 3, true, 20, ParameterKind::kFixed, false},
      {"free parameters", 40, 2, 3, true, 8, ParameterKind::kFree, true},
      {"projected parameters", 40, 2, 3, true, 8, ParameterKind::kProjected, true},
  };
  return kinds;
}

// 512 k - 3 numbers: glibc gives them whole pages behind a header of 16 bytes.
const std::vector<Kind>& PageSizedKinds() {
  static const auto& kinds = *new std::vector<Kind>{
      {"open 1-D", 700, 1, 3, false, 509, ParameterKind::kFixed, true},
      {"closed 3-D", 700, 3, 3, true, 511, ParameterKind::kFixed, false},
      {"through all points", 509, 1, 3, true, 509, ParameterKind::kFixed, false},
      {"free parameters", 309, 2, 3, true, 100, ParameterKind::kFree, false},
      {"projected parameters", 600, 3, 3, true, 511, ParameterKind::kProjected, false},
  };
  return kinds;
}

/// Null with one sentence in `error`.
std::unique_ptr<Problem> MakeKind(const Kind& kind, const std::vector<std::string>& terms,
                                  std::string* error) {
  DataSet data = MakeBean(kind.num_points, kind.dimension);
  if (!kind.weighted) data.weights.reset();
  FitSpec spec;
  spec.degree = kind.degree;
  spec.closed = kind.closed;
  spec.control_points = kind.control_points;
  spec.parameters = Parameterization::kCentripetal;
  spec.parameter_kind = kind.parameters;
  if (kind.parameters != ParameterKind::kFixed) spec.start = "circle";
  for (const std::string& term : terms) {
    NameSpec name;
    if (!ParseNameSpec(term, &name, error)) return nullptr;
    spec.terms.push_back(std::move(name));
  }
  return MakeFitProblem(std::move(data), std::move(spec), error);
}

}  // namespace

std::vector<ExampleProblem> ExampleProblems() {
  std::vector<ExampleProblem> problems;
  for (const Kind& kind : SmallKinds()) {
    std::string error;
    problems.push_back({kind.name, MakeKind(kind, {}, &error)});
    CHECK(problems.back().problem != nullptr) << error;
  }
  return problems;
}

std::vector<ExampleProblem> ExampleProblemsOf(const std::string& term, bool with_distance) {
  std::vector<ExampleProblem> problems;
  for (const Kind& kind : SmallKinds()) {
    std::vector<std::string> terms = {term};
    if (with_distance) terms.insert(terms.begin(), DistanceTermOf(kind.parameters));
    std::string error;
    auto problem = MakeKind(kind, terms, &error);
    if (problem != nullptr) problems.push_back({kind.name, std::move(problem)});
  }
  return problems;
}

std::vector<ExampleProblem> PageSizedProblems(const std::string& term) {
  std::vector<ExampleProblem> problems;
  for (const Kind& kind : PageSizedKinds()) {
    std::string error;
    std::vector<std::string> terms;
    if (!term.empty()) terms.push_back(term);
    auto problem = MakeKind(kind, terms, &error);
    if (problem != nullptr) problems.push_back({kind.name, std::move(problem)});
  }
  return problems;
}

Eigen::VectorXd NearStart(const Problem& problem, double by, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> step(-by, by);
  Eigen::VectorXd x = problem.start();
  for (double& entry : x) entry += step(random);
  return x;
}

}  // namespace batten
