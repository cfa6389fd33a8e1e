#include "cost_functions/block_reach.h"

#include <algorithm>
#include <cstdlib>
#include <vector>

namespace batten {

int LargestReach(const BsplineBasis& basis, int dimension, const BlockFamily& term,
                 const Eigen::VectorXd& any) {
  const int n = basis.num_control_points();
  std::vector<int> offsets, sizes;
  int reach = 0;
  for (int block = 0; block < term.size(); ++block) {
    term.Bind(any, block, &offsets, &sizes);
    for (const int a : offsets) {
      for (const int b : offsets) {
        const int apart = std::abs(a - b) / dimension;
        reach = std::max(reach, basis.periodic() ? std::min(apart, n - apart) : apart);
      }
    }
  }
  return reach;
}

}  // namespace batten
