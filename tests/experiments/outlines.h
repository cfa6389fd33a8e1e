#ifndef BATTEN_TESTS_EXPERIMENTS_OUTLINES_H_
#define BATTEN_TESTS_EXPERIMENTS_OUTLINES_H_

#include <glog/logging.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "experiments/run.h"
#include "problems/catalogue.h"

namespace batten {

inline std::unique_ptr<Problem> LoadCatalogueProblem(const std::string& name) {
  CatalogueEntry entry;
  std::string error;
  CHECK(FindProblem(name, &entry, &error)) << error;
  std::unique_ptr<Problem> problem = LoadProblem(entry, &error);
  CHECK(problem != nullptr) << error;
  return problem;
}

/// The longest side of the box around the points.
inline double SizeOf(const Points& points) {
  return (points.colwise().maxCoeff() - points.colwise().minCoeff()).maxCoeff();
}

/// Data, parameters and knots of a fit, to be changed and made a problem again.
struct FixedFit {
  explicit FixedFit(const Problem& problem)
      : data(problem.curve_fit()->data()),
        spec(problem.curve_fit()->spec()),
        knots(problem.curve_fit()->basis().knots()) {
    data.parameters = problem.curve_fit()->parameters();
  }
  std::unique_ptr<Problem> Make() const {
    FitSpec fixed = spec;
    fixed.parameters.reset();
    fixed.given_knots = knots;
    std::string error;
    std::unique_ptr<Problem> problem = MakeFitProblem(data, fixed, &error);
    CHECK(problem != nullptr) << error;
    return problem;
  }
  DataSet data;
  FitSpec spec;
  std::vector<double> knots;
};

/// A name with options as users write it.
inline NameSpec Named(const std::string& text) {
  NameSpec name;
  std::string error;
  EXPECT_TRUE(ParseNameSpec(text, &name, &error)) << error;
  return name;
}

inline RunResult RunSolver(const Problem& problem, const std::string& solver,
                           const RunSpec& spec = {}) {
  RunResult result;
  std::string error;
  EXPECT_TRUE(Run(problem, Named(solver), spec, &result, &error)) << error;
  return result;
}

/// In the user's units.
inline Points ControlPointsOf(const Problem& problem, const RunResult& result) {
  return problem.curve_fit()->ControlPoints(result.x);
}

/// Runs that end only at the rounding floor, or where the method itself finds no further.
inline RunSpec ToTheFloor() {
  RunSpec spec;
  spec.gradient_tolerance = 0.0;
  spec.keep_trace = false;
  return spec;
}

}  // namespace batten

#endif  // BATTEN_TESTS_EXPERIMENTS_OUTLINES_H_
