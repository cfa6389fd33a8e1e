#include <gtest/gtest.h>

#include "tests/solvers/contract_cases.h"

namespace batten {
namespace {

/// So many points that sums are shared by two threads, as each way of sharing asks for.
constexpr int kManyPoints = 41'000;

struct SharedFit {
  const char* name;
  FitSpec spec;
};

std::vector<SharedFit> SharedFits() {
  FitSpec fixed = MakeSpec(3, false, 20);
  fixed.parameters = Parameterization::kUniform;
  FitSpec free = MakeFreeSpec(3, false, 20, "data");
  free.parameters = Parameterization::kUniform;
  FitSpec projected = MakeProjectedSpec(3, true, 12, "ellipse");
  return {{"fixed", fixed}, {"free", free}, {"projected", projected}};
}

// Ceres' own threads sum in no fixed order (docs/design.md).
TEST_P(EverySolver, GivesTheSameBitsWithAnyNumberOfThreadsUnderConstraints) {
  if (GetParam() == "ceres_lm") return;
  const DataSet data = MakeNoisyBean(kManyPoints, 2, 611);
  for (const SharedFit& fit : SharedFits()) {
    const auto problem = MakeFit(data, fit.spec);
    const bool is_fixed = fit.spec.parameter_kind == ParameterKind::kFixed;
    // All coordinates alike, one alone, and two control points tied to each other.
    const int d = problem->curve_fit()->dimension();
    SetConstraints({HoldCurve(*problem, 0.1, 0, 0.3),
                    HoldCurve(*problem, 0.1, 1, 0.02),
                    HoldCurve(*problem, 0.6, 1, -0.1),
                    {"tied", {{8 * d, 1.0}, {9 * d, -1.0}}, 0.05}},
                   problem.get());
    const std::string solver = is_fixed ? name() : free_name();
    if (!WhyUnsupported(*problem, solver).empty()) continue;
    SCOPED_TRACE(fit.name);
    const auto iterates = [&](int threads) {
      TestContextOptions options = {2, -1.0, false};
      options.threads = threads;
      return SolverTrial(*problem, solver, options).context.iterates();
    };
    const std::vector<Eigen::VectorXd> one = iterates(1), two = iterates(2);
    ASSERT_EQ(one.size(), two.size());
    for (std::size_t k = 0; k < one.size(); ++k) EXPECT_TRUE(SameBits(one[k], two[k])) << k;
  }
}

}  // namespace
}  // namespace batten
