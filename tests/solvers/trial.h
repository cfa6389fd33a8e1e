#ifndef BATTEN_TESTS_SOLVERS_TRIAL_H_
#define BATTEN_TESTS_SOLVERS_TRIAL_H_

#include <glog/logging.h>

#include <string>

#include "tests/solvers/test_context.h"

namespace batten {

/// "ceres_lbfgs/memory=5" as an object of its class.
template <typename SolverClass>
SolverClass MakeSolver(const std::string& name_and_options) {
  NameSpec spec;
  OptionValues options;
  std::string error;
  CHECK(ParseNameSpec(name_and_options, &spec, &error)) << error;
  CHECK_EQ(spec.name, SolverClass::ClassInfo().name);
  CHECK(ResolveOptions(SolverClass::ClassInfo().options, spec, &options, &error)) << error;
  return SolverClass(options);
}

/// One run of a solver from the problem's start, and what it left behind.
template <typename SolverClass>
struct Trial {
  Trial(const Problem& problem, const std::string& name_and_options,
        TestContextOptions context_options = {}, Objective::Options objective_options = {})
      : context(problem, context_options) {
    Objective objective(&problem, &context, objective_options);
    x = objective.start();
    outcome = MakeSolver<SolverClass>(name_and_options).Minimize(&objective, &context, &x);
  }
  /// |g| at the end over |g| at the start.
  double gradient_ratio() { return context.GradientNorm(x) / context.gradient_norms().front(); }

  TestContext context;
  Eigen::VectorXd x;
  Outcome outcome;
};

template <typename SolverClass>
std::string WhyUnsupported(const Problem& problem, const std::string& name_and_options) {
  return MakeSolver<SolverClass>(name_and_options).WhyUnsupported(Objective(&problem, nullptr));
}

}  // namespace batten

#endif  // BATTEN_TESTS_SOLVERS_TRIAL_H_
