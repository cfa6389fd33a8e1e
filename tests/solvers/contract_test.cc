#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>

#include "tests/roundoff.h"
#include "tests/solvers/contract_cases.h"

namespace batten {
namespace {

INSTANTIATE_TEST_SUITE_P(Registry, EverySolver,
                         ::testing::ValuesIn(SolverRegistry::Global().Names()),
                         [](const auto& solver) { return solver.param; });

TEST_P(EverySolver, SaysWhatItIs) {
  const SolverInfo info = *SolverRegistry::Global().Find(GetParam());
  EXPECT_EQ(info.name, GetParam());
  EXPECT_EQ(MakeSolver(name())->Info().name, GetParam());
  EXPECT_FALSE(info.summary.empty());
  EXPECT_EQ(info.summary.find('\n'), std::string::npos);
  EXPECT_FALSE(info.source.empty());
}

std::string ReadText(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// The cell behind "| `option` | " without backticks; empty where there is none.
std::string DefaultOnPage(const std::string& page, const std::string& option) {
  const std::string begin = "\n| `" + option + "` | ";
  const std::size_t found = page.find(begin);
  if (found == std::string::npos) return "";
  const std::size_t cell = found + begin.size();
  std::string text = page.substr(cell, page.find(" |", cell) - cell);
  text.erase(std::remove(text.begin(), text.end(), '`'), text.end());
  return text;
}

TEST_P(EverySolver, HasAPageWithItsDefaultsAndARowInTheTable) {
  const std::string folder = BATTEN_SOURCE_DIR "/docs/solvers/";
  const std::string page = ReadText(folder + GetParam() + ".md");
  EXPECT_EQ(page.rfind("# " + GetParam() + "\n", 0), 0U);
  for (const OptionInfo& option : SolverRegistry::Global().Find(GetParam())->options) {
    const std::string text = DefaultOnPage(page, option.name);
    double number = 0.0;
    if (option.kind == OptionInfo::Kind::kWord) {
      EXPECT_EQ(text, option.default_word) << option.name;
    } else {
      ASSERT_TRUE(ParseNumber(text, &number)) << option.name << ": " << text;
      EXPECT_EQ(number, option.default_number) << option.name;
    }
  }
  EXPECT_THAT(ReadText(folder + "README.md"), ::testing::HasSubstr("](" + GetParam() + ".md)"));
}

TEST_P(EverySolver, OptionsHaveDefaultsInTheirRangesAndHelp) {
  std::set<std::string> names;
  for (const OptionInfo& option : SolverRegistry::Global().Find(GetParam())->options) {
    SCOPED_TRACE(option.name);
    EXPECT_TRUE(names.insert(option.name).second);
    EXPECT_FALSE(option.help.empty());
    if (option.kind == OptionInfo::Kind::kWord) {
      EXPECT_THAT(option.words, ::testing::Contains(option.default_word));
    } else {
      EXPECT_LE(option.lowest, option.default_number);
      EXPECT_GE(option.highest, option.default_number);
    }
  }
}

TEST_P(EverySolver, EachWordOfAnOptionRuns) {
  const auto fixed = MakeFit(MakeNoisyLoop(40, 2, 3), MakeSpec(3, true, 12));
  const auto free = MakeFit(MakeNoisyLoop(40, 2, 3), MakeFreeSpec(3, true, 12));
  for (const OptionInfo& option : SolverRegistry::Global().Find(GetParam())->options) {
    for (const std::string& word : option.words) {
      const std::string solver = GetParam() + "/" + option.name + "=" + word;
      for (const Problem* problem : {fixed.get(), free.get()}) {
        SCOPED_TRACE(solver);
        if (!WhyUnsupported(*problem, solver).empty()) continue;
        if (problem == free.get() && keeps_its_spans()) continue;
        SolverTrial trial(*problem, solver);
        EXPECT_LT(trial.context.Energy(trial.x), trial.context.Energy(problem->start()));
      }
    }
  }
}

/// Size of differences of E that are rounding noise where E is `energy`.
double NoiseOf(double energy) { return 1e3 * kEpsilon * energy; }

bool HasHeavyBall(const std::string& solver) {
  return solver == "polyak_lspia" || solver == "mlspia";
}

void ExpectMinimized(const Problem& problem, const SolverTrial& trial) {
  const DenseFit dense(problem);
  if (HasItsOwnLimit(trial)) {
    EXPECT_LT(dense.Gap(trial.all), dense.Gap(problem.start()));
    return;
  }
  const double start_gap = dense.Gap(problem.start());
  const double gap = dense.Gap(trial.all);
  const double energy = (dense.a * dense.solution - dense.q).squaredNorm();
  // Rounding of the data, at most 0.5 inside, is worth this in E; in A P it grows with the
  // condition where residuals are large.
  const double rounding =
      std::pow(64 * kEpsilon * dense.a.norm() * (1.0 + dense.condition() * std::sqrt(energy)), 2);
  switch (trial.outcome.reason) {
    case StopReason::kSolved:
      // Through the normal equations A P is off by the condition too (Higham, sec. 20.4); what QR
      // keeps is held against narrower bounds in its own tests.
      EXPECT_LE(gap, std::pow(64 * kEpsilon * dense.a.norm() * dense.condition(), 2) + rounding);
      break;
    case StopReason::kGradientSmall:
    case StopReason::kRoundingFloor: {
      // gap = ||A (P - P*)||^2 = g'N^-1 g / 4, and what rounding moves of A P adds to the root.
      const double norm = trial.context.gradient_norms().back();
      EXPECT_LE(std::sqrt(gap), 0.5 * norm / dense.smallest + std::sqrt(rounding));
      break;
    }
    case StopReason::kNativeStop:
    case StopReason::kLineSearchEnded:
      EXPECT_LE(gap, NoiseOf(start_gap + energy));
      break;
    case StopReason::kIterationLimit: {
      // Slow on ill-conditioned problems, yet no slower than the slowest of them all, a step of
      // 1 / (the largest row sum of N) along the gradient.
      const Eigen::MatrixXd normal = dense.a.transpose() * dense.a;
      const double largest = normal.cwiseAbs().rowwise().sum().maxCoeff();
      const double factor = 1.0 - dense.smallest * dense.smallest / largest;
      double slowest = std::pow(factor, trial.iterations());
      if (HasHeavyBall(trial.info.name)) {
        // Two equal roots of the recursion: it rises by (2 k + 1) before it falls by r^k (Polyak).
        const double r = (dense.condition() - 1.0) / (dense.condition() + 1.0);
        const int k = trial.iterations();
        slowest = std::max(slowest, (2 * k + 1) * std::pow(r, k));
      }
      EXPECT_LE(gap, slowest * slowest * start_gap + rounding);
      break;
    }
    default:
      ADD_FAILURE() << ToString(trial.outcome.reason) << ": " << trial.outcome.message;
  }
}

void ExpectMinimizes(const std::string& solver, const std::vector<ContractProblem>& problems,
                     int* num_runs) {
  for (const ContractProblem& row : problems) {
    const auto problem = row.make();
    if (!WhyUnsupported(*problem, solver).empty()) continue;
    SCOPED_TRACE(row.name);
    ++*num_runs;
    ExpectMinimized(*problem, SolverTrial(*problem, solver));
  }
}

TEST_P(EverySolver, MinimizesEachKindOfFit) {
  int num_runs = 0;
  ExpectMinimizes(name(), LeastSquaresProblems(), &num_runs);
  ExpectMinimizes(name(), InterpolationProblems(), &num_runs);
  EXPECT_EQ(num_runs == 0, needs_free_parameters());
}

TEST_P(EverySolver, GivesTheSameBitsTwice) {
  for (const SupportedProblem& row : SupportedProblems(GetParam())) {
    SCOPED_TRACE(row.name);
    const SolverTrial one(*row.problem, row.solver);
    const SolverTrial two(*row.problem, row.solver);
    ASSERT_EQ(one.context.iterates().size(), two.context.iterates().size());
    for (std::size_t i = 0; i < one.context.iterates().size(); ++i) {
      ASSERT_TRUE(SameBits(one.context.iterates()[i], two.context.iterates()[i])) << i;
    }
    EXPECT_EQ(one.outcome.message, two.outcome.message);
    EXPECT_EQ(one.context.notes(), two.context.notes());
  }
}

/// TwoProblems() with fixed parameters, the points changed by `change`.
std::unique_ptr<Problem> Changed(const ContractProblem& row,
                                 const std::function<void(DataSet*)>& change) {
  const auto problem = row.make();
  const CurveFit& fit = *problem->curve_fit();
  FitSpec spec = fit.spec();
  DataSet data = fit.data();
  data.parameters = fit.parameters();
  spec.parameters.reset();
  spec.domain = {fit.basis().domain_begin(), fit.basis().domain_end()};
  spec.given_knots = fit.basis().knots();
  change(&data);
  return MakeFit(data, spec);
}

TEST_P(EverySolver, ScalesExactlyWithPowersOfTwo) {
  for (const ContractProblem& row : TwoProblems()) {
    const auto problem = Changed(row, [](DataSet*) {});
    if (!WhyUnsupported(*problem, name()).empty()) continue;
    const SolverTrial plain(*problem, name());
    for (const double scale : {0x1p-20, 0x1p20}) {
      const auto scaled = Changed(row, [scale](DataSet* data) { data->points *= scale; });
      const SolverTrial trial(*scaled, name());
      EXPECT_EQ(plain.iterations(), trial.iterations()) << row.name;
      EXPECT_TRUE(SameBits(plain.x, trial.x)) << row.name;
    }
  }
}

TEST_P(EverySolver, FollowsDataThatAreMovedAndTurned) {
  for (const ContractProblem& row : TwoProblems()) {
    const auto problem = Changed(row, [](DataSet*) {});
    if (!WhyUnsupported(*problem, name()).empty()) continue;
    const auto changed = Changed(row, [](DataSet* data) {
      const double c = std::cos(0.7), s = std::sin(0.7);
      const Eigen::VectorXd x = data->points.col(0), y = data->points.col(1);
      data->points.col(0) = c * x - s * y + Eigen::VectorXd::Constant(x.size(), 1000.0);
      data->points.col(1) = s * x + c * y - Eigen::VectorXd::Constant(x.size(), 300.0);
    });
    SCOPED_TRACE(row.name);
    const SolverTrial plain(*problem, name());
    const SolverTrial trial(*changed, name());
    // The box around turned data is another one, and with it the first steps of some.
    const int few = 3 + plain.iterations() / 5;
    EXPECT_NEAR(plain.iterations(), trial.iterations(), few);
    Points turned = problem->curve_fit()->ControlPoints(plain.all);
    const Eigen::VectorXd x = turned.col(0), y = turned.col(1);
    turned.col(0) = std::cos(0.7) * x - std::sin(0.7) * y;
    turned.col(1) = std::sin(0.7) * x + std::cos(0.7) * y;
    turned.col(0).array() += 1000.0;
    turned.col(1).array() -= 300.0;
    const Points ends = changed->curve_fit()->ControlPoints(trial.all);
    // Each end is as near to its minimum as its |g| says; data near 1000 are rounded to eps of it.
    ExpectMinimized(*problem, plain);
    ExpectMinimized(*changed, trial);
    const DenseFit dense(*problem);
    const double scale = problem->curve_fit()->setting().scale;
    const double near = dense.DistanceFor(plain.context.gradient_norms().back()) / scale +
                        dense.DistanceFor(trial.context.gradient_norms().back()) /
                            changed->curve_fit()->setting().scale +
                        64 * kEpsilon * 1000.0 * dense.condition();
    EXPECT_LT((ends - turned).norm(), near);
  }
}

TEST_P(EverySolver, TakesThePointsInAnyOrder) {
  for (const ContractProblem& row : TwoProblems()) {
    const auto problem = Changed(row, [](DataSet*) {});
    if (!WhyUnsupported(*problem, name()).empty()) continue;
    const auto shuffled = Changed(row, [](DataSet* data) {
      const auto m = data->points.rows();
      Eigen::PermutationMatrix<Eigen::Dynamic> order(m);
      order.setIdentity();
      std::mt19937 random(20240502);
      for (Eigen::Index i = m - 1; i > 0; --i) {
        std::swap(order.indices()[i], order.indices()[random() % (i + 1)]);
      }
      data->points = Points(order * data->points);
      data->parameters = Eigen::VectorXd(order * *data->parameters);
      if (data->weights.has_value()) data->weights = Eigen::VectorXd(order * *data->weights);
    });
    SCOPED_TRACE(row.name);
    const SolverTrial plain(*problem, name());
    const SolverTrial trial(*shuffled, name());
    EXPECT_NEAR(plain.iterations(), trial.iterations(), 3 + plain.iterations() / 10);
    ExpectMinimized(*problem, plain);
    ExpectMinimized(*shuffled, trial);
    const DenseFit dense(*problem);
    const double near = dense.DistanceFor(plain.context.gradient_norms().back() +
                                          trial.context.gradient_norms().back()) +
                        64 * kEpsilon * dense.condition();
    EXPECT_LT((plain.x - trial.x).norm(), near);
  }
}

}  // namespace
}  // namespace batten
