// Counts allocations of whole iterations: malloc is this program's own, which counts and passes on.
#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>

#include "solvers/solver_registry.h"
#include "tests/solvers/test_fits.h"

// A sanitizer has a malloc of its own to which another must not be put first.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
#define BATTEN_COUNTS_ALLOCATIONS 0
#else
#define BATTEN_COUNTS_ALLOCATIONS 1
#endif

namespace batten {
namespace {

std::atomic<bool> is_counting{false};
std::atomic<long> num_allocations{0};

}  // namespace

/// Of any thread, from `operator new`, Eigen or the C library.
void CountAllocation() {
  if (is_counting) ++num_allocations;
}

}  // namespace batten

#if BATTEN_COUNTS_ALLOCATIONS
// NOLINTBEGIN(bugprone-reserved-identifier, cert-dcl37-c, cert-dcl51-cpp)
extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* __libc_calloc(std::size_t count, std::size_t size);
extern "C" void* __libc_realloc(void* old, std::size_t size);
extern "C" void* __libc_memalign(std::size_t alignment, std::size_t size);
extern "C" void* malloc(std::size_t size) {
  batten::CountAllocation();
  return __libc_malloc(size);
}
extern "C" void* calloc(std::size_t count, std::size_t size) {
  batten::CountAllocation();
  return __libc_calloc(count, size);
}
extern "C" void* realloc(void* old, std::size_t size) {
  batten::CountAllocation();
  return __libc_realloc(old, size);
}
extern "C" void* aligned_alloc(std::size_t alignment, std::size_t size) {
  batten::CountAllocation();
  return __libc_memalign(alignment, size);
}
// NOLINTEND(bugprone-reserved-identifier, cert-dcl37-c, cert-dcl51-cpp)
#endif

namespace batten {
namespace {

/// Counts what happens between the ends of iterations kFirst - 1 and kLast, and stops there.
class CountingContext final : public RunContext {
 public:
  static constexpr int kFirst = 5;
  static constexpr int kLast = 10;

  explicit CountingContext(int threads) : threads_(threads) { num_allocations = 0; }
  ~CountingContext() override { is_counting = false; }
  CountingContext(const CountingContext&) = delete;
  CountingContext& operator=(const CountingContext&) = delete;

  Status Iterate(const Eigen::VectorXd& /*x*/) override {
    is_counting = iterations_ + 1 >= kFirst && iterations_ < kLast;
    return iterations_++ < kLast ? Status::kOk : Status::kStop;
  }
  StopReason stop_reason() const override { return StopReason::kIterationLimit; }
  void Note(const std::string& /*name*/, const std::string& /*value*/) override {}
  void OffTheClock(const std::function<void()>& work) override { work(); }
  std::uint64_t seed() const override { return 1; }
  int threads() const override { return threads_; }

  int iterations() const { return iterations_ - 1; }
  static long allocations() { return num_allocations; }

 private:
  int threads_;
  int iterations_ = 0;
};

/// Points of a wavy round, off it by noise of half a wave.
DataSet NoisyRound(int m) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 0.05);
  DataSet data;
  data.points.resize(m, 2);
  for (int i = 0; i < m; ++i) {
    const double angle = 6.2 * i / m;
    const double radius = 1.0 + 0.1 * std::sin(5.0 * angle) + noise(random);
    data.points.row(i) << radius * std::cos(angle), radius * std::sin(angle);
  }
  return data;
}

std::unique_ptr<Problem> NoisyFit(int m, FitSpec spec) {
  std::string error;
  std::unique_ptr<Problem> problem = MakeFitProblem(NoisyRound(m), std::move(spec), &error);
  CHECK(problem != nullptr) << error;
  return problem;
}

long AllocationsOf(const std::string& solver, const Problem& problem, int threads) {
  NameSpec name;
  std::string error;
  CHECK(ParseNameSpec(solver, &name, &error)) << error;
  OptionValues options;
  const std::unique_ptr<Solver> made = SolverRegistry::Global().Make(name, &options, &error);
  CHECK(made != nullptr) << error;
  CountingContext context(threads);
  Objective objective(&problem, nullptr);
  Eigen::VectorXd x = objective.start();
  made->Minimize(&objective, &context, &x);
  EXPECT_EQ(context.iterations(), CountingContext::kLast);
  return CountingContext::allocations();
}

TEST(Allocations, AreSeenWhereverTheyAreMade) {
  if (!BATTEN_COUNTS_ALLOCATIONS) GTEST_SKIP() << "malloc is a sanitizer's";
  num_allocations = 0;
  is_counting = true;
  const auto number = std::make_unique<int>(1);
  EXPECT_EQ(num_allocations, 1);
  const Eigen::VectorXd vector = Eigen::VectorXd::Zero(*number + 40);
  EXPECT_EQ(num_allocations, 2);
  const std::vector<double> other(static_cast<std::size_t>(vector.size()));
  is_counting = false;
  EXPECT_EQ(num_allocations, 3) << other.size();
  // And in iterations: these search all feet anew.
  EXPECT_GT(AllocationsOf("pdm", *NoisyFit(500, MakeFreeSpec(3, true, 12)), 1), 0);
}

TEST(Allocations, AnIterationOfLmSchurHasNone) {
  if (!BATTEN_COUNTS_ALLOCATIONS) GTEST_SKIP() << "malloc is a sanitizer's";
  for (const char* solver : {"lm_schur", "newton"}) {
    for (const bool closed : {true, false}) {
      const FitSpec plain = MakeFreeSpec(3, closed, 12, closed ? "circle" : "data");
      EXPECT_EQ(AllocationsOf(solver, *NoisyFit(500, plain), 1), 0) << solver << closed;
      FitSpec other_sizes = plain;
      other_sizes.degree = 4;
      EXPECT_EQ(AllocationsOf(solver, *NoisyFit(500, other_sizes), 1), 0) << solver << closed;
      const FitSpec faired = MakeFreeSpec(3, closed, 12, closed ? "circle" : "data",
                                          "free_parameter,fairing/weight=1e-4");
      EXPECT_EQ(AllocationsOf(solver, *NoisyFit(500, faired), 1), 0) << solver << closed;
    }
    FitSpec held = MakeFreeSpec(3, false, 12, "data");
    held.hold_ends = true;
    EXPECT_EQ(AllocationsOf(solver, *NoisyFit(500, held), 1), 0) << solver;
  }
}

TEST(Allocations, NorHasOneThatThreadsShare) {
  if (!BATTEN_COUNTS_ALLOCATIONS) GTEST_SKIP() << "malloc is a sanitizer's";
  // Below 20,000 points each a second thread is not worth its time.
  const auto problem = NoisyFit(40'000, MakeFreeSpec(3, true, 12));
  EXPECT_EQ(AllocationsOf("lm_schur", *problem, 2), 0);
}

}  // namespace
}  // namespace batten
