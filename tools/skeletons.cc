#include "tools/skeletons.h"

namespace batten {

const char kSolverSkeleton[] = R"(#include "solvers/plugin.h"

// The gradient method with steps that are halved until E falls by enough (Armijo), and doubled
// after each iteration: put your own method into DoStep.
class @CLASS@ final : public batten::SimpleStepper<@CLASS@> {
 public:
  static constexpr char kName[] = "@NAME@";
  static constexpr char kSummary[] = "gradient steps, halved until E falls by enough";
  static constexpr char kSource[] = "Armijo, Pacific J. Math. 16, 1966";
  using SimpleStepper::SimpleStepper;

 private:
  // Once, before iteration 0 is booked; it may move *x. An outcome ends the run.
  std::optional<batten::Outcome> DoStart(Eigen::VectorXd* x) override {
    const batten::Status status = objective()->EnergyAndGradient(*x, &energy_, &gradient_);
    if (status != batten::Status::kOk) return Ended(status);
    return std::nullopt;
  }

  // One iteration from *x. It prints nothing and stops by no rule of its own: who calls it books
  // *x afterwards. Where an evaluation is refused, *x must still be what was booked last.
  std::optional<batten::Outcome> DoStep(Eigen::VectorXd* x) override {
    for (; step_ > 1e-20; step_ *= 0.5) {
      const Eigen::VectorXd trial = *x - step_ * gradient_;
      double energy = 0.0;
      batten::Status status = objective()->Energy(trial, &energy);
      if (status == batten::Status::kNonFinite) continue;
      if (status != batten::Status::kOk) return Ended(status);
      if (!(energy < energy_ - 1e-4 * step_ * gradient_.squaredNorm())) continue;
      status = objective()->EnergyAndGradient(trial, &energy_, &gradient_);
      if (status != batten::Status::kOk) return Ended(status);
      *x = trial;
      step_ *= 2.0;
      return std::nullopt;
    }
    return batten::Outcome{batten::StopReason::kLineSearchEnded, "no step lowers E"};
  }

  double energy_ = 0.0;
  Eigen::VectorXd gradient_;
  double step_ = 1.0;
};

BATTEN_PLUGIN(registry) { registry->AddSolver<@CLASS@>(); }
)";

const char kSolverTest[] = R"(add_test(NAME comparison
  COMMAND Batten::batten compare --problems=rhino --solvers=banded_qr,@NAME@ --max_iterations=200
    --plugins=$<TARGET_FILE:@NAME@>)
)";

const char kTermSkeleton[] = R"(#include "solvers/plugin.h"

// sum_i w_i |C(t_i) - Q_i|^2, the distance from the data: put your own residual into operator().
struct @CLASS@ : batten::TermAtDataPoints {
  // Affine in the control points and alike for all coordinates: compiled to banded rows. Where your
  // residual is not, take this line away.
  static constexpr bool kAffine = true;
  using TermAtDataPoints::TermAtDataPoints;
  static batten::TermInfo Info() {
    return batten::MakeTermInfo("@NAME@", "distance from the data at their parameters",
                                "Piegl & Tiller, The NURBS Book, sec. 9.4.1");
  }
  // Derivatives of any kind are read from this: T is whatever computes them. False where the
  // residual has no value.
  template <typename SiteType, typename T>
  bool operator()(const SiteType& site, const T* const* control_points, T* residuals) const {
    for (int c = 0; c < site.dimension(); ++c) {
      residuals[c] = site.root_weight() * (site.Curve(control_points, c) - site.point(c));
    }
    return true;
  }
};

BATTEN_PLUGIN(registry) { batten::AddTerm<@CLASS@>(registry); }
)";

const char kTermTest[] = R"(add_test(NAME fit
  COMMAND Batten::batten fit --problem=rhino --terms=@NAME@ --solver=lbfgs
    --plugins=$<TARGET_FILE:@NAME@>)
)";

const char kBuild[] = R"(# Builds @NAME@.so against the installed Batten alone:
#   cmake -S . -B build -DCMAKE_PREFIX_PATH=<where Batten was installed> && cmake --build build
cmake_minimum_required(VERSION 3.25)
project(@NAME@ LANGUAGES CXX)

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
find_package(Batten @VERSION@ REQUIRED)
batten_add_plugin(@NAME@ @NAME@.cc)

enable_testing()
add_test(NAME conformance COMMAND Batten::batten check $<TARGET_FILE:@NAME@>)
)";

}  // namespace batten
