#ifndef BATTEN_SPLINES_POINTS_H_
#define BATTEN_SPLINES_POINTS_H_

#include <Eigen/Core>

namespace batten {

/// A list of points, one a row; row-major, so that point i stands at data()[i * cols()].
using Points = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Least and greatest of each coordinate, in one pass over at least one point; of coordinates that
/// are no numbers nothing is promised.
void FindBoundingBox(const Points& points, Eigen::RowVectorXd* low, Eigen::RowVectorXd* high);

inline constexpr int kMaxDegree = 9;
inline constexpr int kMaxOrder = kMaxDegree + 1;
inline constexpr int kMaxDimension = 4;
inline constexpr const char* kCoordinateNames[kMaxDimension] = {"x", "y", "z", "w"};

}  // namespace batten

#endif  // BATTEN_SPLINES_POINTS_H_
