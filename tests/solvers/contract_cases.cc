#include "tests/solvers/contract_cases.h"

#include <glog/logging.h>
#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <utility>

#include "cost_functions/options.h"

namespace batten {
namespace {

/// In the middle, far from what a periodic sequence repeats.
std::vector<double> WithADoubleKnot(std::vector<double> knots) {
  const std::size_t middle = knots.size() / 2;
  knots[middle] = knots[middle + 1];
  return knots;
}

}  // namespace

std::string FreeName(const std::string& registered) {
  if (registered == "anderson") return "anderson:pdm";
  // Small enough to be stopped at each of its evaluations.
  if (registered == "best_of") return "best_of/starts=2/steps=4:foot_newton";
  return SolverRegistry::Global().UsualName(registered);
}

std::unique_ptr<Solver> MakeSolver(const std::string& name_and_options) {
  NameSpec spec;
  std::string error;
  CHECK(ParseNameSpec(name_and_options, &spec, &error)) << error;
  std::unique_ptr<Solver> solver = SolverRegistry::Global().Make(spec, nullptr, &error);
  CHECK(solver != nullptr) << error;
  return solver;
}

std::string WhyUnsupported(const Problem& problem, const std::string& solver, bool compile) {
  return MakeSolver(solver)->WhyUnsupported(Objective(&problem, nullptr, {compile}));
}

SolverTrial::SolverTrial(const Problem& problem, const std::string& solver,
                         TestContextOptions options, bool compile)
    : info(MakeSolver(solver)->Info()), context(problem, options) {
  Objective objective(&problem, &context, {compile});
  x = objective.start();
  outcome = MakeSolver(solver)->Minimize(&objective, &context, &x);
  all = objective.Expand(x);
}

double Noted(const SolverTrial& trial, const std::string& name) {
  double value = std::nan("");
  EXPECT_TRUE(ParseNumber(trial.context.notes().at(name), &value)) << name;
  return value;
}

bool HasItsOwnLimit(const SolverTrial& trial) {
  // What has one with further terms alone may stop by itself without them, too.
  return !trial.info.limit.empty() && trial.outcome.reason == StopReason::kNativeStop &&
         trial.outcome.message.find("its own limit") != std::string::npos;
}

void ExpectOneSentenceWithAWayOut(const std::string& sentence, const std::string& solver) {
  // Of what wraps a solver the sentence has the names alone.
  const std::string name = solver.substr(0, solver.find_first_of("/:"));
  EXPECT_EQ(sentence.rfind(name, 0), 0U) << sentence;
  EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
  EXPECT_EQ(sentence.find(". "), std::string::npos) << sentence;
  EXPECT_NE(sentence.back(), '.') << sentence;
  EXPECT_THAT(sentence, ::testing::ContainsRegex("use |needs [0-9]+ |hold |not both")) << sentence;
}

void ExpectRunsOrRefuses(const Problem& problem, const std::string& solver, bool compile) {
  const std::string why = WhyUnsupported(problem, solver, compile);
  if (!why.empty()) {
    ExpectOneSentenceWithAWayOut(why, solver);
    return;
  }
  SolverTrial trial(problem, solver, {}, compile);
  EXPECT_TRUE(trial.x.allFinite());
  EXPECT_NE(trial.outcome.reason, StopReason::kNumericalFailure) << trial.outcome.message;
  Objective objective(&problem, nullptr, {compile});
  double before = 0.0, after = 0.0;
  ASSERT_EQ(objective.Energy(objective.start(), &before), Status::kOk);
  ASSERT_EQ(objective.Energy(trial.x, &after), Status::kOk);
  EXPECT_LT(after, before);
}

Eigen::VectorXd StartOf(const Problem& problem) { return Objective(&problem, nullptr).start(); }

bool SameBits(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}

DataSet WithoutWeights(DataSet data) {
  data.weights.reset();
  return data;
}

std::vector<ContractProblem> LeastSquaresProblems() {
  std::vector<ContractProblem> problems;
  const auto add = [&problems](FitSpec spec, int m) {
    const auto seed = static_cast<unsigned>(problems.size());
    const int d = 1 + static_cast<int>(seed % 4);
    const bool weighted = seed % 3 != 1;
    const char* ends = spec.closed                        ? "closed"
                       : spec.ends == EndKnots::kFloating ? "floating"
                                                          : "clamped";
    problems.push_back({std::string(ends) + " degree " + std::to_string(spec.degree) + ", " +
                            ToString(spec.knots) + " knots" +
                            (spec.given_knots.empty() ? "" : " with a double one") +
                            ", n = " + std::to_string(spec.control_points) +
                            ", d = " + std::to_string(d) + (weighted ? ", weighted" : ""),
                        [=] {
                          DataSet data = MakeNoisyLoop(m, d, 100 + seed);
                          return MakeFit(weighted ? data : WithoutWeights(data), spec);
                        }});
  };
  for (int degree = 1; degree <= kMaxDegree; ++degree) {
    for (const KnotRule knots : {KnotRule::kUniform, KnotRule::kAveraged}) {
      for (const EndKnots ends :
           {EndKnots::kPeriodic, EndKnots::kEndInterpolating, EndKnots::kFloating}) {
        const bool closed = ends == EndKnots::kPeriodic;
        FitSpec spec = MakeSpec(degree, closed, ends == EndKnots::kFloating ? 15 : 19);
        spec.knots = knots;
        if (!closed) spec.ends = ends;
        add(spec, 60);
      }
    }
  }
  // The basis wraps onto itself, or its band overlaps its corner.
  for (const auto& [degree, n] :
       {std::pair(3, 6), {3, 3}, {3, 1}, {2, 4}, {4, 2}, {5, 2}, {7, 8}, {9, 12}}) {
    add(MakeSpec(degree, true, n), 30);
  }
  for (const EndKnots ends :
       {EndKnots::kPeriodic, EndKnots::kEndInterpolating, EndKnots::kFloating}) {
    FitSpec spec = MakeSpec(3, ends == EndKnots::kPeriodic, 19);
    if (!spec.closed) spec.ends = ends;
    spec.given_knots = WithADoubleKnot(UniformKnots(3, 19, ends, 0.0, 1.0));
    add(spec, 60);
  }
  return problems;
}

std::vector<ContractProblem> InterpolationProblems() {
  std::vector<ContractProblem> problems;
  for (int degree = 1; degree <= kMaxDegree; ++degree) {
    for (const bool closed : {true, false}) {
      const int d = 1 + static_cast<int>(problems.size() % 4);
      problems.push_back(
          {std::string(closed ? "closed" : "clamped") + " degree " + std::to_string(degree) +
               " through all points, d = " + std::to_string(d),
           [=] {
             FitSpec spec = MakeSpec(degree, closed, 24);
             spec.knots = KnotRule::kAveraged;
             return MakeFit(
                 WithoutWeights(MakeNoisyLoop(24, d, 200u + static_cast<unsigned>(degree))), spec);
           }});
    }
  }
  return problems;
}

std::vector<ContractProblem> TwoProblems() {
  // The cubic clamped curve.
  return {{"weighted closed curve",
           [] { return MakeFit(MakeNoisyLoop(50, 2, 1), MakeSpec(3, true, 17)); }},
          InterpolationProblems()[5]};
}

std::vector<ContractProblem> FreeProblems() {
  return {
      {"free, closed from a circle",
       [] {
         return MakeFit(WithoutWeights(MakeNoisyBean(60, 2, 301)), MakeFreeSpec(3, true, 12));
       }},
      {"free, open from the data, ends held",
       [] {
         FitSpec spec = MakeFreeSpec(3, false, 9, "data");
         spec.hold_ends = true;
         return MakeFit(WithoutWeights(MakeNoisyBean(40, 2, 302)), spec);
       }},
      {"free, three dimensions from an ellipse, weighted",
       [] { return MakeFit(MakeNoisyBean(50, 3, 303), MakeFreeSpec(2, true, 13, "ellipse")); }},
      {"free, open in three dimensions, with fixed parameters beside",
       [] {
         return MakeFit(
             MakeNoisyBean(40, 3, 304),
             MakeFreeSpec(4, false, 10, "data", "free_parameter,interpolation/weight=0.25"));
       }},
      {"free, closed with fewer control points than the band is wide",
       [] { return MakeFit(WithoutWeights(MakeNoisyBean(30, 2, 305)), MakeFreeSpec(3, true, 5)); }},
  };
}

std::vector<ContractProblem> ProjectedProblems() {
  return {
      {"projected, closed from a circle",
       [] {
         return MakeFit(WithoutWeights(MakeNoisyBean(60, 2, 311)), MakeProjectedSpec(3, true, 12));
       }},
      {"projected, open from the data, weighted",
       [] { return MakeFit(MakeNoisyBean(40, 2, 312), MakeProjectedSpec(3, false, 9, "data")); }},
      {"projected, three dimensions from an ellipse, weighted",
       [] {
         return MakeFit(MakeNoisyBean(50, 3, 313), MakeProjectedSpec(4, true, 11, "ellipse"));
       }},
  };
}

std::vector<SupportedProblem> SupportedProblems(const std::string& registered) {
  std::vector<SupportedProblem> supported;
  const auto add = [&supported](const std::string& solver, const ContractProblem& row) {
    std::unique_ptr<Problem> problem = row.make();
    if (!WhyUnsupported(*problem, solver).empty()) return;
    supported.push_back({solver, row.name, std::move(problem)});
  };
  const std::string usual = SolverRegistry::Global().UsualName(registered);
  for (const ContractProblem& row : TwoProblems()) add(usual, row);
  for (const ContractProblem& row : FreeProblems()) add(FreeName(registered), row);
  for (const ContractProblem& row : ProjectedProblems()) add(FreeName(registered), row);
  return supported;
}

}  // namespace batten
