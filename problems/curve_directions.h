#ifndef BATTEN_PROBLEMS_CURVE_DIRECTIONS_H_
#define BATTEN_PROBLEMS_CURVE_DIRECTIONS_H_

#include <Eigen/QR>
#include <vector>

namespace batten {

/// Unit vectors, perpendicular to each other and to `direction`, which is not zero.
inline std::vector<Eigen::VectorXd> NormalsOf(const Eigen::VectorXd& direction) {
  const auto d = direction.size();
  const Eigen::MatrixXd q =
      Eigen::MatrixXd(direction).householderQr().householderQ() * Eigen::MatrixXd::Identity(d, d);
  std::vector<Eigen::VectorXd> normals;
  for (Eigen::Index k = 1; k < d; ++k) normals.emplace_back(q.col(k));
  return normals;
}

}  // namespace batten

#endif  // BATTEN_PROBLEMS_CURVE_DIRECTIONS_H_
