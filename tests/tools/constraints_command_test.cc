// Constraints that are not linear, and the term curve_fairing, through the program as a process.
#include <gmock/gmock.h>

#include "tests/tools/program.h"

namespace batten {
namespace {

using ::testing::HasSubstr;

/// Half a turn of an uneven ring, counter-clockwise.
constexpr char kBow[] =
    "x,y\n10,0.2\n9.1,4.3\n6.8,7.1\n4.2,9.3\n0.3,10.2\n-3.6,9.1\n-7.3,7.2\n-9.2,3.7\n-10,0.1\n";

std::vector<std::string> FitBow(const std::string& constraints,
                                const std::string& solver = "augmented_lagrangian:lbfgs",
                                const std::vector<std::string>& flags = {}) {
  std::vector<std::string> arguments = {"fit", "-", "--control_points=6", "--solver=" + solver,
                                        "--constraints=" + constraints};
  arguments.insert(arguments.end(), flags.begin(), flags.end());
  return arguments;
}

TEST(FitCommand, HoldsConstraintsThatAreNotLinear) {
  const TemporaryFolder folder;
  const std::string out = folder / "fit.json", trace = folder / "trace.csv";
  const Ended ended =
      RunBatten(FitBow("curvature/t=0.5/kappa=0.2,point/free=1/x=-6/y=9,tangent/free=1/x=-1/y=-0.5",
                       "augmented_lagrangian:lbfgs", {"--out=" + out, "--trace=" + trace}),
                kBow);
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("missed by "));
  EXPECT_THAT(ended.out, HasSubstr("gradient of the Lagrangian"));
  const nlohmann::json fit = nlohmann::json::parse(ReadFile(out));
  EXPECT_LE(fit["constraint_violation"].get<double>(), 1e-10 * 20.0);
  EXPECT_EQ(fit["constraint_parameters"].size(), 1U);
  EXPECT_EQ(fit["audit"]["verified"], true);
  EXPECT_EQ(fit["audit"]["covers_gradient"], false);
  EXPECT_TRUE(fit["audit"]["gradient_norm"].is_null());
  EXPECT_LE(fit["audit"]["constraint_violation"].get<double>(), 1e-10 * 20.0);
  EXPECT_THAT(ended.out, HasSubstr("|g| is not audited"));
  const std::vector<std::string> rows = Lines(ReadFile(trace));
  EXPECT_THAT(rows.front(), HasSubstr(",step_norm,constraint_violation,energy_interpolation"));
  EXPECT_EQ(rows.size(), fit["iterations"].get<std::size_t>() + 2);
}

/// A cubic without inner knots, with given ends and no curvature there, is a straight line: its
/// control points divide it evenly. Nothing is left for a solver to do.
TEST(FitCommand, GivesTheCurveThatConstraintsDetermine) {
  constexpr char kZigzag[] = "x,y\n0,0\n1,1\n2,0\n3,1\n4,0\n5,1\n";
  for (const char* solver : {"banded_qr", "banded_cholesky", "dense_qr", "irls:banded_qr", "lbfgs",
                             "ceres_lm", "newton", "cg", "lspia", "jacobi_pia", "randomised_pia",
                             "anderson:lspia", "augmented_lagrangian:lbfgs"}) {
    const TemporaryFolder folder;
    const std::string out = folder / "fit.json";
    const Ended ended = RunBatten({"fit", "-", "--control_points=4", "--constraints=ends,natural",
                                   std::string("--solver=") + solver, "--out=" + out},
                                  kZigzag);
    ASSERT_EQ(ended.status, 0) << solver << ": " << ended.err << ended.out;
    const nlohmann::json fit = nlohmann::json::parse(ReadFile(out));
    EXPECT_EQ(fit["audit"]["verified"], true) << solver;
    for (int j = 0; j < 4; ++j) {
      const nlohmann::json& point = fit["spline"]["control_points"][static_cast<std::size_t>(j)];
      EXPECT_NEAR(point[0].get<double>(), 5.0 * j / 3.0, 1e-12) << solver;
      EXPECT_NEAR(point[1].get<double>(), j / 3.0, 1e-12) << solver;
    }
  }
  ExpectRefused(
      RunBatten({"fit", "-", "--control_points=4", "--constraints=ends,natural", "--fairing=gcv"},
                kZigzag),
      {"--fairing=gcv has no curves to choose from: the constraints leave nothing free"});
}

TEST(FitCommand, HasNoViolationWithoutThem) {
  const TemporaryFolder folder;
  const std::string out = folder / "fit.json", trace = folder / "trace.csv";
  const Ended ended =
      RunBatten(FitBow("ends", "lbfgs", {"--out=" + out, "--trace=" + trace}), kBow);
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_TRUE(nlohmann::json::parse(ReadFile(out))["constraint_violation"].is_null());
  EXPECT_THAT(Lines(ReadFile(trace)).front(), ::testing::Not(HasSubstr("violation")));
}

TEST(FitCommand, RefusesBadConstraintsThatAreNotLinear) {
  ExpectRefused(RunBatten(FitBow("curvatur/t=0.5/kappa=1"), kBow),
                {"--constraints: unknown constraint \"curvatur\"; did you mean curvature?"});
  ExpectRefused(RunBatten(FitBow("curvature/t=0.5"), kBow), {"has no kappa"});
  ExpectRefused(RunBatten(FitBow("point/free=1000/x=1"), kBow), {"free", "0 to 99"});
  ExpectRefused(RunBatten(FitBow("tangent/t=0.5/x=1/y=0,tangent/t=0.5/x=-1/y=0"), kBow),
                {"contradict each other"});
  const Ended plain = RunBatten(FitBow("curvature/t=0.5/kappa=0.1", "lbfgs"), kBow);
  ExpectRefused(plain, {"lbfgs holds linear constraints only; use augmented_lagrangian:lbfgs"});
  for (const char* solver : {"gim", "preconditioned_pia", "extended_pia"}) {
    ExpectRefused(RunBatten({"fit", "-", "--control_points=9", "--solver=" + std::string(solver),
                             "--constraints=tangent/t=0.5/x=1/y=0"},
                            kBow),
                  {solver, " takes no constraints; use augmented_lagrangian:lbfgs"});
  }
  ExpectRefused(
      RunBatten(FitBow("curvature/t=0.5/kappa=0.1", "augmented_lagrangian:banded_qr"), kBow),
      {"augmented_lagrangian:banded_qr needs terms that are affine"});
}

TEST(FitCommand, EndsAsInfeasibleWhereAConstraintCannotBeMet) {
  const Ended ended =
      RunBatten({"fit", "-", "--degree=1", "--control_points=2",
                 "--solver=augmented_lagrangian:lbfgs", "--constraints=ends,point/free=1/x=50"},
                kBow);
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.out, HasSubstr("stopped       infeasible"));
  EXPECT_THAT(ended.out, HasSubstr("constraint point/free=1/x=50, which is missed by "));
  EXPECT_EQ(Lines(ended.err).size(), 1U) << ended.err;
}

TEST(FitCommand, TakesConstraintsThatAreNotLinearFromAProblemFile) {
  const TemporaryFolder folder;
  folder.Write("bow.csv", kBow);
  const std::string good = folder.Write(
      "bow.json",
      R"({"name": "bow", "data": "bow.csv", "spline": {"degree": 3, "control_points": 6},)"
      R"( "constraints": ["curvature/t=0.5/kappa=0.2", "point/free=1/x=-6/y=9"]})");
  const Ended ended =
      RunBatten({"fit", "--problem=" + good, "--solver=augmented_lagrangian:ceres_lm"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  const std::string bad = folder.Write(
      "bad.json",
      R"({"name": "bow", "data": "bow.csv", "spline": {"degree": 3, "control_points": 6},)"
      R"( "constraints": ["curvature/t=0.5/kapa=0.2"]})");
  ExpectRefused(RunBatten({"fit", "--problem=" + bad}), {bad, "kapa", "kappa"});
}

TEST(FitCommand, HoldsLinearConstraintsWhateverTheParametersAre) {
  // An end-interpolating curve begins in its first control point and ends in its last one.
  const TemporaryFolder folder;
  const std::string out = folder / "fit.json";
  const std::string constraints = "point/t=0/x=11/y=-1,point/t=1/y=0.5";
  for (const auto& [solver, kind, distance] : {std::tuple("banded_qr", "fixed", "interpolation"),
                                               {"lspia", "fixed", "interpolation"},
                                               {"lm_schur", "free", "free_parameter"},
                                               {"newton", "projected", "foot_point"}}) {
    SCOPED_TRACE(solver);
    const Ended ended =
        RunBatten(FitBow(constraints, solver,
                         {"--out=" + out, "--parameter_kind=" + std::string(kind),
                          "--terms=" + std::string(distance), "--max_iterations=5000"}),
                  kBow);
    EXPECT_EQ(ended.status, 0) << ended.err;
    const nlohmann::json fit = nlohmann::json::parse(ReadFile(out));
    const nlohmann::json& points = fit["spline"]["control_points"];
    EXPECT_NEAR(points.front()[0].get<double>(), 11.0, 1e-12 * 20.0);
    EXPECT_NEAR(points.front()[1].get<double>(), -1.0, 1e-12 * 20.0);
    EXPECT_NEAR(points.back()[1].get<double>(), 0.5, 1e-12 * 20.0);
    EXPECT_TRUE(fit["audit"]["verified"].get<bool>());
  }
}

TEST(FitCommand, WeighsFairingByControlPoint) {
  EXPECT_EQ(
      RunBatten({"fit", "-", "--control_points=6", "--terms=interpolation,fairing/weight=1e-3",
                 "--solver=lspia/fairing_factor=5/fairing_first=2/fairing_last=3",
                 "--max_iterations=100000", "--mode=native"},
                kBow)
          .status,
      0);
  ExpectRefused(
      RunBatten({"fit", "-", "--control_points=6", "--solver=lspia/fairing_factor=5"}, kBow),
      {"lspia weighs the term fairing", "use fairing_factor=1"});
  ExpectRefused(
      RunBatten({"fit", "-", "--control_points=6", "--solver=lspia/fairing_factor=-1"}, kBow),
      {"fairing_factor", "0 to 1e+06"});
}

TEST(FitCommand, TakesTheTermCurveFairing) {
  for (const char* solver : {"lbfgs", "ceres_lbfgs", "ceres_lm", "newton"}) {
    const Ended ended = RunBatten({"fit", "-", "--control_points=8",
                                   "--terms=interpolation,curve_fairing/weight=1e-3,"
                                   "curve_fairing/measure=variation/weight=1e-4",
                                   "--solver=" + std::string(solver)},
                                  kBow);
    EXPECT_EQ(ended.status, 0) << solver << ended.err;
  }
  for (const auto& [kind, distance] :
       {std::pair("free", "free_parameter"), std::pair("projected", "foot_point")}) {
    const Ended ended = RunBatten(
        {"fit", "-", "--control_points=8", "--parameter_kind=" + std::string(kind),
         "--terms=" + std::string(distance) + ",curve_fairing/weight=1e-3", "--solver=lbfgs"},
        kBow);
    EXPECT_EQ(ended.status, 0) << kind << ended.err;
  }
  ExpectRefused(RunBatten({"fit", "-", "--control_points=8", "--terms=interpolation,curve_fairing",
                           "--solver=cg"},
                          kBow),
                {"cg needs terms that are affine", "curve_fairing is not; use lbfgs"});
  ExpectRefused(RunBatten({"fit", "-", "--control_points=8", "--degree=1",
                           "--terms=interpolation,curve_fairing"},
                          kBow),
                {"curve_fairing of measure bending needs degree 2 or more"});
}

TEST(FitCommand, OfCurveFairingDoesNotChangeWhenDataAreMovedOrScaled) {
  // Scaled by 3 and moved; not by a power of two, which would be scaled away exactly.
  std::string moved = "x,y\n";
  for (const auto& row : Lines(kBow)) {
    double x = 0.0, y = 0.0;
    if (std::sscanf(row.c_str(), "%lf,%lf", &x, &y) != 2) continue;
    std::ostringstream text;
    text.precision(17);
    text << 3.0 * x + 7.0 << ',' << 3.0 * y - 40.0 << '\n';
    moved += text.str();
  }
  const auto control_points = [](const std::string& points) {
    const TemporaryFolder folder;
    const std::string out = folder / "fit.json";
    const Ended ended = RunBatten({"fit", "-", "--control_points=8", "--out=" + out,
                                   "--terms=interpolation,curve_fairing/weight=0.01,"
                                   "curve_fairing/measure=variation/weight=1e-3"},
                                  points);
    EXPECT_EQ(ended.status, 0) << ended.err;
    return nlohmann::json::parse(ReadFile(out))["spline"]["control_points"]
        .get<std::vector<std::vector<double>>>();
  };
  const auto plain = control_points(kBow), other = control_points(moved);
  for (std::size_t j = 0; j < plain.size(); ++j) {
    EXPECT_NEAR(other[j][0], 3.0 * plain[j][0] + 7.0, 1e-4) << j;
    EXPECT_NEAR(other[j][1], 3.0 * plain[j][1] - 40.0, 1e-4) << j;
  }
}

}  // namespace
}  // namespace batten
