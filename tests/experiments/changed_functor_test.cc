// A term's functor is all there is of it: change the functor, and every path of every solver
// changes.
#include <gmock/gmock.h>

#include "cost_functions/functor_family.h"
#include "cost_functions/interpolation.h"
#include "solvers/solver_registry.h"
#include "tests/experiments/outlines.h"

namespace batten {
namespace {

/// factor (C - Q) + shift: with a basis that sums to 1 the minimum moves by -shift / factor in each
/// coordinate, and E* is factor^2 times as large.
struct Changeable : InterpolationResidual {
  using InterpolationResidual::InterpolationResidual;
  static TermInfo Info() { return {"changeable", "for this test", "none", kAffine, {}}; }
  template <typename SiteType, typename T>
  bool operator()(const SiteType& site, const T* const* control_points, T* residuals) const {
    for (int c = 0; c < site.dimension(); ++c) {
      residuals[c] =
          site.root_weight() * (factor * (site.Curve(control_points, c) - site.point(c)) + shift);
    }
    return true;
  }
  static double factor;
  static double shift;
};
double Changeable::factor = 1.0;
double Changeable::shift = 0.0;

/// As the program makes one, with the changeable term instead of the catalogue's.
std::unique_ptr<Problem> ChangeableProblem(double factor, double shift) {
  Changeable::factor = factor;
  Changeable::shift = shift;
  if (TermRegistry::Global().Find("changeable") == nullptr) {
    TermRegistry::Global().Register(std::make_unique<FunctorTerm<Changeable>>());
  }
  std::string error;
  std::optional<DataSet> data =
      ReadDataSet(std::string(BATTEN_SOURCE_DIR "/data/animals/rhino_100.csv"), &error);
  FitSpec spec;
  spec.closed = true;
  spec.control_points = 80;
  spec.terms = {{"changeable", {}, nullptr}};
  return MakeFitProblem(std::move(*data), spec, &error);
}

struct Path {
  std::string solver;
  bool compile;
};

std::vector<Path> AllPaths() {
  std::vector<Path> paths;
  for (const std::string& name : SolverRegistry::Global().Names()) {
    paths.push_back({SolverRegistry::Global().UsualName(name), true});
  }
  for (const char* more : {"ceres_lbfgs/form=problem", "ceres_lbfgs/form=spans"}) {
    paths.push_back({more, true});
  }
  for (const char* plain : {"lbfgs", "ceres_lbfgs", "ceres_lbfgs/form=problem", "ceres_lm"}) {
    paths.push_back({plain, false});
  }
  return paths;
}

TEST(ChangedFunctor, ChangesEveryPathOfFixedParameters) {
  const double factor = 2.5;
  const double shift = 0.2;
  int num_paths = 0;
  for (const Path& path : AllPaths()) {
    SCOPED_TRACE(path.solver + (path.compile ? "" : ", not compiled"));
    RunSpec spec;
    spec.compile = path.compile;
    const auto original = ChangeableProblem(1.0, 0.0);
    const RunResult before = RunSolver(*original, path.solver, spec);
    const auto changed = ChangeableProblem(factor, shift);
    const RunResult after = RunSolver(*changed, path.solver, spec);
    if (!before.skipped.empty()) {
      EXPECT_THAT(before.skipped,
                  ::testing::ContainsRegex("needs free parameters|interpolation term alone"));
      continue;
    }
    ++num_paths;
    // 1e-8 of the data's size, as solvers are to agree; sizes are up to 1 inside.
    const Eigen::VectorXd moved = (after.x - before.x).array() + shift / factor;
    EXPECT_LT(moved.cwiseAbs().maxCoeff(), 1e-8);
    EXPECT_NEAR(after.energy, factor * factor * before.energy, 1e-12 * after.energy);
    // The trace sees the energy of the changed functor from its first row on.
    EXPECT_NE(after.trace.front().energy, factor * factor * before.trace.front().energy);
    EXPECT_NEAR(after.trace.back().energy, after.energy, 1e-12 * after.energy);
  }
  EXPECT_GT(2 * num_paths, static_cast<int>(AllPaths().size()));
}

}  // namespace
}  // namespace batten
