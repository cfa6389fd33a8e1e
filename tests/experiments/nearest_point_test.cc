#include "experiments/nearest_point.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/roundoff.h"

namespace batten {
namespace {

double ByLookingAtAll(const Points& points, const Eigen::RowVectorXd& query) {
  return (points.rowwise() - query).rowwise().squaredNorm().minCoeff();
}

TEST(NearestPoint, FindsWhatLookingAtAllFinds) {
  std::mt19937 random(20260101);
  std::normal_distribution<double> normal;
  for (const int dimension : {1, 2, 3, 4}) {
    for (const int count : {1, 8, 9, 500}) {
      Points points(count, dimension);
      for (double& value : points.reshaped()) value = normal(random);
      // Half of them on a line, where one axis cannot split them.
      for (int i = 0; i < count / 2; ++i) points(i, 0) = 0.25;
      const NearestPoint nearest(points);
      int guess = 0;
      for (int k = 0; k < 200; ++k) {
        Eigen::RowVectorXd query(dimension);
        for (double& value : query) value = 1.5 * normal(random);
        const NearestPoint::Found found = nearest.Find(query.data(), guess);
        const double expected = ByLookingAtAll(points, query);
        EXPECT_NEAR(found.squared_distance, expected, 8 * kEpsilon * expected);
        guess = found.point;
      }
    }
  }
}

TEST(NearestPoint, FindsPointsThatAreThereManyTimes) {
  Points points = Points::Constant(100, 2, 3.0);
  points.row(57) << -1, -1;
  const NearestPoint nearest(points);
  const double far[] = {3, 7};
  EXPECT_EQ(nearest.Find(far, 0).squared_distance, 16.0);
  const double near[] = {-1, -1};
  EXPECT_EQ(nearest.Find(near, 0).squared_distance, 0.0);
}

}  // namespace
}  // namespace batten
