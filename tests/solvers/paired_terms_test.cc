// gim and its relatives with terms beside interpolation: where they go and how fast.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

#include "solvers/paired_iteration.h"
#include "tests/solvers/contract_cases.h"

namespace batten {
namespace {

using ::testing::HasSubstr;

/// The equations (B + F) P = Q + f, dense: B from the basis' definition, F and f from what the
/// terms' residuals are at zero and at each unit vector.
struct DenseEquations {
  /// `grouped`: row j of B and Q is the sum over the group of j, as of extended_pia; otherwise that
  /// of the point paired with j.
  DenseEquations(const Problem& problem, bool grouped);
  Points Moves(const Points& p) const { return scale.asDiagonal() * (right - matrix * p); }
  Eigen::MatrixXd scaled() const { return scale.asDiagonal() * matrix; }
  Points Solution() const { return matrix.fullPivLu().solve(right); }

  Eigen::MatrixXd matrix;  // B + F
  Eigen::MatrixXd right;   // Q + f
  Eigen::VectorXd scale;   // D
};

/// Adds F and f of one term.
void AddTerm(const BlockFamily& family, int d, Eigen::MatrixXd* f_matrix,
             Eigen::MatrixXd* f_right) {
  const Eigen::Index n = f_matrix->rows();
  Eigen::VectorXd at_zero, at_unit;
  ASSERT_EQ(family.Residuals(Eigen::VectorXd::Zero(n * d), &at_zero), Status::kOk);
  Eigen::MatrixXd all(at_zero.size(), n * d);
  for (Eigen::Index i = 0; i < n * d; ++i) {
    ASSERT_EQ(family.Residuals(Eigen::VectorXd::Unit(n * d, i), &at_unit), Status::kOk);
    all.col(i) = at_unit - at_zero;
  }
  const Eigen::MatrixXd normal = family.weight() * all.transpose() * all;
  const Eigen::VectorXd right = -family.weight() * all.transpose() * at_zero;
  for (Eigen::Index i = 0; i < n * d; ++i) {
    for (Eigen::Index k = i % d; k < n * d; k += d) {
      if (i % d == 0) (*f_matrix)(i / d, k / d) += normal(i, k);
      // All coordinates alike.
      ASSERT_NEAR(normal(i, k), normal(i / d * d, k / d * d), 1e-12 * normal.norm());
    }
    (*f_right)(i / d, i % d) += right[i];
  }
}

DenseEquations::DenseEquations(const Problem& problem, bool grouped) {
  const CurveFit& fit = *problem.curve_fit();
  const DenseFit dense(problem);
  const Eigen::Index m = dense.a.rows(), n = dense.a.cols();
  Eigen::MatrixXd chosen = Eigen::MatrixXd::Zero(n, m);
  const std::vector<double> parameters(fit.parameters().data(), fit.parameters().data() + m);
  std::vector<int> pairs;
  if (!grouped) pairs = PairWithControlPoints(fit.basis(), parameters);
  for (Eigen::Index i = 0; i < m; ++i) {
    Eigen::Index j = 0;
    const double largest = dense.a.row(i).maxCoeff(&j);
    if (grouped) {
      chosen(j, i) = largest;
    } else {
      chosen(pairs[static_cast<std::size_t>(i)], i) = 1.0;
    }
  }
  Eigen::MatrixXd f_matrix = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd f_right = Eigen::MatrixXd::Zero(n, fit.dimension());
  for (std::size_t k = 1; k < problem.terms().size(); ++k) {
    AddTerm(*problem.terms()[k].family, fit.dimension(), &f_matrix, &f_right);
  }
  matrix = chosen * dense.a + f_matrix;
  right = chosen * dense.q + f_right;
  scale = (chosen.rowwise().sum() + f_matrix.cwiseAbs().rowwise().sum()).cwiseInverse();
}

struct TermsCase {
  std::string terms;
  bool closed;
  int dimension;
  int n;
};

std::vector<TermsCase> Cases() {
  return {
      {"interpolation,fairing/weight=1e-5", true, 2, 24},
      {"interpolation,fairing/weight=1e-5", false, 3, 24},
      {"interpolation,fairing/derivative=3/weight=1e-9", true, 3, 25},
      {"interpolation,fairing/derivative=3/weight=1e-9", false, 2, 21},
      {"interpolation,fairing/weight=1e-2", true, 2, 5},  // entries of the band overlap
      {"interpolation,end_tangent/weight=0.01", false, 2, 22},
      {"interpolation,end_tangent/weight=0.01/end=begin,end_curvature/weight=1e-7,"
       "fairing/derivative=1/weight=1e-4,fairing/weight=1e-6",
       false, 3, 23},
      {"interpolation,end_point/weight=3,fairing/weight=1e-6", false, 2, 18},
  };
}

/// `extra`: points more than control points.
std::unique_ptr<Problem> MakeCase(const TermsCase& c, int extra = 0) {
  FitSpec spec = MakeSpec(3, c.closed, c.n, c.terms);
  spec.knots = KnotRule::kAveraged;
  return MakeFit(WithoutWeights(MakeNoisyLoop(c.n + extra, c.dimension, 61)), spec);
}

const char* const kPaired[] = {"gim", "weighted_pia", "local_pia", "preconditioned_pia"};
const char* const kAll[] = {"gim", "weighted_pia", "local_pia", "preconditioned_pia",
                            "extended_pia"};

bool IsGrouped(const std::string& solver) { return solver == "extended_pia"; }

Points PointsOf(const Problem& problem, const Eigen::VectorXd& x) {
  const int d = problem.curve_fit()->dimension();
  return Eigen::Map<const Points>(x.data(), x.size() / d, d);
}

void ExpectEndsAtItsEquations(const Problem& problem, const std::string& solver) {
  const DenseEquations equations(problem, IsGrouped(solver));
  const SolverTrial trial(problem, solver, {100'000});
  EXPECT_EQ(trial.outcome.reason, StopReason::kNativeStop) << trial.outcome.message;
  EXPECT_THAT(trial.outcome.message, HasSubstr("not the minimum of E"));
  EXPECT_TRUE(HasItsOwnLimit(trial));
  const double first = (trial.context.iterates()[1] - trial.context.iterates()[0]).norm();
  // What is left of the scaled equations: a move that is 1e-10 of the first one, or of local_pia
  // 1e-12 at each control point, over the weight of weighted_pia, which is 1 at least. Moves of
  // preconditioned_pia are nearly the error itself.
  const Eigen::VectorXd sizes =
      Eigen::JacobiSVD<Eigen::MatrixXd>(equations.scaled()).singularValues();
  const auto n = static_cast<double>(sizes.size());
  const double least = std::min(0.5, sizes.minCoeff());
  const double left = 1e-10 * first + std::sqrt(n) * 1e-12;
  const double tolerance = left / least + 64 * kEpsilon * n * sizes.maxCoeff() / least;
  const Points solution = equations.Solution();
  EXPECT_LT((PointsOf(problem, trial.all) - solution).norm(), tolerance);
  EXPECT_LT(tolerance, 1e-6);
  // That is no minimum of E.
  TestContext judge(problem);
  EXPECT_GT(judge.Energy(trial.x),
            judge.Energy(SolverTrial(problem, "banded_qr").x) * (1.0 + 1e-9));
}

TEST(PairedTerms, LeadToWhereResidualsOfPairedPointsBalanceTheirPull) {
  for (const TermsCase& c : Cases()) {
    SCOPED_TRACE(c.terms + (c.closed ? ", closed" : ", open"));
    const auto problem = MakeCase(c);
    for (const char* solver : kAll) {
      SCOPED_TRACE(solver);
      ExpectEndsAtItsEquations(*problem, solver);
    }
    ExpectEndsAtItsEquations(*MakeCase(c, 17), "extended_pia");
  }
}

TEST(PairedTerms, MoveControlPointsByTheScaledEquations) {
  for (const TermsCase& c : Cases()) {
    SCOPED_TRACE(c.terms + (c.closed ? ", closed" : ", open"));
    const auto problem = MakeCase(c);
    for (const char* solver : {"gim", "weighted_pia/w=1.3", "local_pia", "extended_pia"}) {
      SCOPED_TRACE(solver);
      const DenseEquations equations(*problem, IsGrouped(solver));
      const SolverTrial trial(*problem, solver, {1});
      const Points start = PointsOf(*problem, trial.context.iterates()[0]);
      const Points next = PointsOf(*problem, trial.context.iterates()[1]);
      const double weight = std::string(solver) == "weighted_pia/w=1.3" ? 1.3 : 1.0;
      EXPECT_LT((next - start - weight * equations.Moves(start)).norm(), kRoundingOfStep);
      // One product, also with the terms' part of it.
      EXPECT_EQ(trial.context.count(Evaluation::kProduct), 1);
    }
  }
}

double RadiusOfOneMinus(const Eigen::MatrixXd& matrix) {
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols());
  return (one - matrix).eigenvalues().cwiseAbs().maxCoeff();
}

TEST(PairedTerms, AreInTheSpectralRadiusAndTheWeightThatAreNoted) {
  for (const TermsCase& c : Cases()) {
    SCOPED_TRACE(c.terms + (c.closed ? ", closed" : ", open"));
    const auto problem = MakeCase(c);
    const Eigen::MatrixXd a = DenseEquations(*problem, false).scaled();
    // No row sum is above 1.
    EXPECT_LT(a.cwiseAbs().rowwise().sum().maxCoeff(), 1.0 + 16 * kEpsilon);
    // Eigenvalues of matrices that are not symmetric carry more than roundings.
    constexpr double kTolerance = 1e-9;
    for (const char* solver : {"gim", "local_pia"}) {
      EXPECT_NEAR(Noted(SolverTrial(*problem, solver, {1}), "spectral radius of I - A"),
                  RadiusOfOneMinus(a), kTolerance);
    }
    const double smallest = a.eigenvalues().cwiseAbs().minCoeff();
    const SolverTrial weighted(*problem, "weighted_pia", {1});
    EXPECT_NEAR(Noted(weighted, "smallest eigenvalue of A"), smallest, kTolerance);
    EXPECT_NEAR(Noted(weighted, "w"), 2.0 / (1.0 + smallest), kTolerance);
    EXPECT_NEAR(Noted(weighted, "spectral radius of I - w A"),
                RadiusOfOneMinus(2.0 / (1.0 + smallest) * a), kTolerance);
    const auto many = MakeCase(c, 17);
    EXPECT_NEAR(Noted(SolverTrial(*many, "extended_pia", {1}), "spectral radius of the iteration"),
                RadiusOfOneMinus(DenseEquations(*many, true).scaled()), kTolerance);
  }
}

/// Row j minimises |e_j' - m A| among rows m with entries j - q .. j + q, modulo n.
Eigen::MatrixXd BandedInverse(const Eigen::MatrixXd& a, int half_width) {
  const auto n = static_cast<int>(a.rows());
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(n, n);
  for (int j = 0; j < n; ++j) {
    Eigen::MatrixXd rows(2 * half_width + 1, n);
    for (int k = -half_width; k <= half_width; ++k) {
      rows.row(k + half_width) = a.row((j + k + n) % n);
    }
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(n, j);
    const Eigen::VectorXd row = rows.transpose().colPivHouseholderQr().solve(unit);
    for (int k = -half_width; k <= half_width; ++k) {
      inverse(j, (j + k + n) % n) = row[k + half_width];
    }
  }
  return inverse;
}

TEST(PairedTerms, AreInTheBandedInverseOfPreconditionedPia) {
  for (const TermsCase& c : Cases()) {
    SCOPED_TRACE(c.terms + (c.closed ? ", closed" : ", open"));
    const auto problem = MakeCase(c);
    const DenseEquations equations(*problem, false);
    const Eigen::MatrixXd a = equations.scaled();
    const SolverTrial full(*problem, "preconditioned_pia/half_width=25", {1, -1.0});
    EXPECT_LT((PointsOf(*problem, full.context.iterates()[1]) - equations.Solution()).norm(),
              1e-10);
    if (c.n < 7) continue;
    const Eigen::MatrixXd inverse = BandedInverse(a, 2);
    const SolverTrial trial(*problem, "preconditioned_pia/half_width=2", {1});
    const Points start = PointsOf(*problem, trial.context.iterates()[0]);
    const Points next = PointsOf(*problem, trial.context.iterates()[1]);
    EXPECT_LT((next - start - inverse * equations.Moves(start)).norm(), 10 * kRoundingOfStep);
    EXPECT_NEAR(Noted(trial, "spectral radius of I - M^-1 A"), RadiusOfOneMinus(inverse * a), 1e-9);
  }
}

TEST(PairedTerms, ThatWeighNothingChangeNothing) {
  const auto none = MakeCase({"interpolation", false, 2, 20});
  const auto nothing =
      MakeCase({"interpolation,fairing/weight=0,end_tangent/weight=0", false, 2, 20});
  const auto light = MakeCase({"interpolation,fairing/weight=1e-5", false, 2, 20});
  const auto turned = MakeCase({"fairing/weight=1e-5,interpolation", false, 2, 20});
  for (const char* solver : kAll) {
    SCOPED_TRACE(solver);
    const SolverTrial without(*none, solver, {25, -1.0});
    EXPECT_TRUE(SameBits(SolverTrial(*nothing, solver, {25, -1.0}).x, without.x));
    const SolverTrial with(*light, solver, {25, -1.0});
    EXPECT_FALSE(SameBits(with.x, without.x));
    // Nor does their order.
    EXPECT_TRUE(SameBits(with.x, SolverTrial(*turned, solver, {25, -1.0}).x));
  }
}

TEST(PairedTerms, LeaveLocalPiaToRestWhereItMovesByLessThanTheTolerance) {
  const auto problem = MakeCase({"interpolation,fairing/weight=1e-5", true, 2, 24});
  const DenseEquations equations(*problem, false);
  const double tolerance = 1e-3 * problem->curve_fit()->setting().size;
  const SolverTrial trial(*problem, "local_pia/tolerance=1e-3", {1000, -1.0, false});
  EXPECT_EQ(trial.outcome.reason, StopReason::kNativeStop);
  EXPECT_THAT(trial.outcome.message, HasSubstr("no control point moves by more"));
  bool some_rested = false;
  for (std::size_t k = 0; k + 1 < trial.context.iterates().size(); ++k) {
    const Points p = PointsOf(*problem, trial.context.iterates()[k]);
    const Points move = PointsOf(*problem, trial.context.iterates()[k + 1]) - p;
    const Points expected = equations.Moves(p);
    for (int j = 0; j < 24; ++j) {
      const bool rests = expected.row(j).norm() <= tolerance;
      some_rested = some_rested || rests;
      EXPECT_LE(rests ? move.row(j).norm() : (move.row(j) - expected.row(j)).norm(),
                rests ? 0.0 : kRoundingOfStep);
    }
  }
  EXPECT_TRUE(some_rested);
  EXPECT_LE(equations.Moves(PointsOf(*problem, trial.x)).rowwise().norm().maxCoeff(), tolerance);
}

TEST(PairedTerms, MoveControlPointsWithoutDataInExtendedPia) {
  // All data in the first half of an open curve.
  const auto make = [](const std::string& terms) {
    DataSet data = WithoutWeights(MakeNoisyLoop(40, 2, 62));
    data.parameters = Eigen::VectorXd::LinSpaced(40, 0.0, 0.5);
    FitSpec spec = MakeSpec(3, false, 14, terms);
    spec.parameters.reset();
    spec.domain = {0.0, 1.0};
    return MakeFit(data, spec);
  };
  const auto plain = make("interpolation");
  const SolverTrial without(*plain, "extended_pia");
  const auto fair = make("interpolation,fairing/derivative=1/weight=0.01");
  const SolverTrial with(*fair, "extended_pia", {200'000});
  const Points start = PointsOf(*plain, StartOf(*plain));
  const Points resting = PointsOf(*plain, without.x), moved = PointsOf(*fair, with.x);
  EXPECT_EQ((resting - start).row(13).norm(), 0.0);
  EXPECT_GT((moved - start).row(13).norm(), 1e-3);
  ExpectEndsAtItsEquations(*fair, "extended_pia");
}

TEST(PairedTerms, CanBeAccelerated) {
  const auto problem = MakeCase({"interpolation,fairing/weight=1e-5", true, 2, 24});
  const SolverTrial trial(*problem, "anderson:gim", {2000, -1.0, false});
  EXPECT_NE(trial.outcome.reason, StopReason::kNumericalFailure);
  EXPECT_LT((PointsOf(*problem, trial.x) - DenseEquations(*problem, false).Solution()).norm(),
            1e-8);
}

TEST(PairedTerms, AreRefusedWhereTheyHaveNoRowsOrInterpolationIsWeighted) {
  const DataSet data = WithoutWeights(MakeNoisyLoop(20, 2, 63));
  for (const char* solver : kAll) {
    SCOPED_TRACE(solver);
    const auto expect = [&](const DataSet& points, const std::string& terms,
                            const std::string& part) {
      const std::string why =
          WhyUnsupported(*MakeFit(points, MakeSpec(3, true, 20, terms)), solver);
      ExpectOneSentenceWithAWayOut(why, solver);
      EXPECT_THAT(why, HasSubstr(part));
    };
    expect(data, "interpolation,curve_fairing/weight=1e-4",
           "curve_fairing/weight=1e-4 is not; use");
    expect(data, "interpolation,fairing/weight=1e-4/loss=huber", "loss=huber is not; use lbfgs");
    expect(data, "interpolation/loss=huber,fairing", "loss=huber is not; use lbfgs");
    expect(data, "interpolation,fairing,interpolation/weight=2", "there are 2; use lspia");
    expect(data, "fairing", "there is none; use lspia");
    expect(data, "interpolation/weight=2,fairing", "interpolation with weight 1 alone");
    expect(MakeNoisyLoop(20, 2, 63), "interpolation,fairing", "no weights per point; use lspia");
    const auto held = MakeFit(data, MakeSpec(3, true, 20, "interpolation,fairing/weight=1e-4"));
    EXPECT_EQ(WhyUnsupported(*held, solver), "");
    SetConstraints({HoldCurve(*held, 0.4, 0, 0.1)}, held.get());
    EXPECT_THAT(WhyUnsupported(*held, solver), HasSubstr("takes no constraints; use lspia"));
  }
  for (const char* solver : kPaired) {
    EXPECT_EQ(
        WhyUnsupported(*MakeFit(data, MakeSpec(3, true, 19, "interpolation,fairing")), solver),
        std::string(solver) + " needs 20 control points for 20 points");
  }
}

}  // namespace
}  // namespace batten
