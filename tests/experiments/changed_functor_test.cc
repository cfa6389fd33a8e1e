// A term's functor is all there is of it: change the functor, and every path of every solver
// changes.
#include <gmock/gmock.h>

#include "cost_functions/free_family.h"
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

std::optional<DataSet> Rhino(int control_points, FitSpec* spec, std::string* error) {
  spec->closed = true;
  spec->control_points = control_points;
  return ReadDataSet(std::string(BATTEN_SOURCE_DIR "/data/animals/rhino_100.csv"), error);
}

/// As the program makes one, with the changeable term instead of the catalogue's.
std::unique_ptr<Problem> ChangeableProblem(double factor, double shift) {
  Changeable::factor = factor;
  Changeable::shift = shift;
  if (TermRegistry::Global().Find("changeable") == nullptr) {
    TermRegistry::Global().Register(std::make_unique<FunctorTerm<Changeable>>());
  }
  std::string error;
  FitSpec spec;
  std::optional<DataSet> data = Rhino(80, &spec, &error);
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
                  ::testing::ContainsRegex("needs free parameters|one interpolation term"));
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

/// The changeable functor with parameters that are variables.
class FreeChangeableTerm final : public Term {
 public:
  TermInfo Info() const override {
    TermInfo info = Changeable::Info();
    info.name = "free_changeable";
    info.affine = false;
    info.free_parameters = true;
    return info;
  }
  std::unique_ptr<BlockFamily> MakeFamily(const FitSetting& setting, const OptionValues& options,
                                          std::string* /*error*/) const override {
    return std::make_unique<FreeFamily<Changeable>>(setting, Changeable(options),
                                                    options.Real("weight"), nullptr);
  }
};

std::unique_ptr<Problem> FreeChangeableProblem(double shift) {
  Changeable::factor = 1.0;
  Changeable::shift = shift;
  if (TermRegistry::Global().Find("free_changeable") == nullptr) {
    TermRegistry::Global().Register(std::make_unique<FreeChangeableTerm>());
  }
  std::string error;
  FitSpec spec;
  std::optional<DataSet> data = Rhino(20, &spec, &error);
  spec.parameter_kind = ParameterKind::kFree;
  spec.terms = {{"free_changeable", {}, nullptr}};
  std::unique_ptr<Problem> problem = MakeFitProblem(std::move(*data), spec, &error);
  EXPECT_NE(problem, nullptr) << error;
  return problem;
}

TEST(ChangedFunctor, IsFollowedOrRefusedWhereParametersAreFree) {
  const double shift = 0.2;
  RunSpec spec;
  spec.max_iterations = 200;
  const auto original = FreeChangeableProblem(0.0);
  const RunResult before = RunSolver(*original, "lbfgs", spec);
  // A curve moved by -shift has the residuals that the one before had: control points come first.
  RunSpec moved = spec;
  moved.max_iterations = 3;
  moved.start = before.x;
  moved.start.head(original->ranges().front().size).array() -= shift;
  const auto changed = FreeChangeableProblem(shift);
  std::vector<std::string> following, refusing;
  for (const Path& path : AllPaths()) {
    SCOPED_TRACE(path.solver + (path.compile ? "" : ", not compiled"));
    moved.compile = path.compile;
    const RunResult after = RunSolver(*changed, path.solver, moved);
    if (!after.skipped.empty()) {
      refusing.push_back(path.solver);
      continue;
    }
    following.push_back(path.solver);
    // Sums of 200 squares, each of numbers up to 1.
    EXPECT_NEAR(after.start_energy, before.energy, 1e-12);
    EXPECT_LE(after.energy, before.energy + 1e-12);
  }
  // Those that know the distance's own structure may not take anything else for it; those that know
  // none go on from E as it is.
  for (const char* name : {"lbfgs", "ceres_lbfgs", "ceres_lm"}) {
    EXPECT_THAT(following, ::testing::Contains(::testing::StartsWith(name)));
  }
  for (const char* name : {"lm_schur", "newton", "foot_newton", "varpro", "gi", "pdm", "tdm"}) {
    EXPECT_THAT(refusing, ::testing::Contains(::testing::StartsWith(name)));
  }
}

}  // namespace
}  // namespace batten
