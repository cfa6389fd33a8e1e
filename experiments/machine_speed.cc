#include "experiments/machine_speed.h"

#include <Eigen/Core>
#include <chrono>
#include <vector>

#include "experiments/comparison.h"

namespace batten {

double ReferenceSeconds() {
  using Clock = std::chrono::steady_clock;
  constexpr int kRounds = 9;
  constexpr int kDivisions = 20'000;
  constexpr int kSweeps = 200;
  const Eigen::ArrayXd x = Eigen::ArrayXd::LinSpaced(2048, 0.0, 1.0);
  Eigen::ArrayXd y = x;
  double fraction = 1.0;
  std::vector<double> seconds;
  for (int round = 0; round < kRounds; ++round) {
    const Clock::time_point begin = Clock::now();
    for (int i = 0; i < kDivisions; ++i) fraction = 1.0 / (1.0 + fraction);
    for (int sweep = 0; sweep < kSweeps; ++sweep) y = 0.5 * y + x;
    seconds.push_back(std::chrono::duration<double>(Clock::now() - begin).count());
  }
  // Without a use of the results the work would be left out.
  volatile double used = fraction + y[1];
  static_cast<void>(used);
  return Median(seconds);
}

}  // namespace batten
