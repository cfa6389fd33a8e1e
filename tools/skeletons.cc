#include "tools/skeletons.h"

namespace batten {

const char kSolverSkeleton[] = R"(#include "solvers/plugin.h"

// Gradient steps, halved until E falls by enough (Armijo): put your own method into DoStep.
struct @CLASS@ final : batten::SimpleStepper<@CLASS@> {
  static constexpr char kName[] = "@NAME@";
  static constexpr char kSummary[] = "gradient steps, halved until E falls by enough";
  static constexpr char kSource[] = "Armijo, Pacific J. Math. 16, 1966";
  using SimpleStepper::SimpleStepper;

 private:
  // One iteration. *x is booked afterwards; where an evaluation is refused it stays as it was.
  std::optional<batten::Outcome> DoStep(Eigen::VectorXd* x) override {
    double energy = 0.0, trial_energy = 0.0;
    batten::Status status = objective()->EnergyAndGradient(*x, &energy, &gradient_);
    if (status != batten::Status::kOk) return Ended(status);
    for (step_ *= 2.0; step_ > 1e-20; step_ *= 0.5) {
      const Eigen::VectorXd trial = *x - step_ * gradient_;
      status = objective()->Energy(trial, &trial_energy);
      if (status == batten::Status::kStop) return Ended(status);
      if (status == batten::Status::kNonFinite) continue;
      if (!(trial_energy < energy - 1e-4 * step_ * gradient_.squaredNorm())) continue;
      *x = trial;
      return std::nullopt;
    }
    return batten::Outcome{batten::StopReason::kLineSearchEnded, "no step lowers E"};
  }
  double step_ = 1.0;
  Eigen::VectorXd gradient_;
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
  static constexpr bool kAffine = true;  // in the control points; goes where yours is not
  using TermAtDataPoints::TermAtDataPoints;
  static batten::TermInfo Info() {
    return batten::MakeTermInfo("@NAME@", "distance from the data at their parameters",
                                "Piegl & Tiller, The NURBS Book, sec. 9.4.1");
  }
  template <typename SiteType, typename T>  // T: whatever computes derivatives
  bool operator()(const SiteType& site, const T* const* control_points, T* residuals) const {
    for (int c = 0; c < site.dimension(); ++c) {
      residuals[c] = site.root_weight() * (site.Curve(control_points, c) - site.point(c));
    }
    return true;  // false: no value there
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
