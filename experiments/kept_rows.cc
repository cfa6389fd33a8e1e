#include "experiments/kept_rows.h"

#include <algorithm>
#include <cmath>

namespace batten {

std::vector<std::size_t> KeptRows(std::size_t count, std::size_t most) {
  std::vector<std::size_t> kept;
  const std::size_t number = std::min(count, most);
  for (std::size_t j = 0; j < number; ++j) {
    // Below the straight line only at the beginning, where j itself is taken; beyond, the parabola
    // rises by more than 1 a step, so that no index comes twice.
    const double part = number == 1 ? 0.0 : static_cast<double>(j) / static_cast<double>(most - 1);
    const double place = std::round(part * part * static_cast<double>(count - 1));
    kept.push_back(count <= most ? j : std::max(j, static_cast<std::size_t>(place)));
  }
  return kept;
}

std::size_t LeastMissed(const std::vector<double>& numbers) {
  std::size_t least = 1;
  double smallest = HUGE_VAL;
  for (std::size_t k = 1; k + 1 < numbers.size(); ++k) {
    const double ratio = (1.0 + numbers[k + 1]) / (1.0 + numbers[k - 1]);
    if (ratio < smallest) {
      smallest = ratio;
      least = k;
    }
  }
  return least;
}

}  // namespace batten
