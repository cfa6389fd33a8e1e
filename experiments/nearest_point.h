#ifndef BATTEN_EXPERIMENTS_NEAREST_POINT_H_
#define BATTEN_EXPERIMENTS_NEAREST_POINT_H_

#include <vector>

#include "splines/points.h"

namespace batten {

/// Finds the nearest of many points: a k-d tree, halved along the longest side of its boxes.
class NearestPoint {
 public:
  /// At least one point, all finite.
  explicit NearestPoint(const Points& points);

  struct Found {
    int point = 0;  ///< Place inside; a guess for queries near by.
    double squared_distance = 0.0;
  };
  /// `query` has d coordinates. The nearer to it the `guess` is, the less is searched.
  Found Find(const double* query, int guess) const;

 private:
  void Build(int begin, int end);
  void Search(const double* query, int begin, int end, Found* best) const;
  double SquaredDistance(const double* query, int point) const;

  Points points_;           // in the order of the tree: the middle of a range splits it
  std::vector<int> order_;  // while it is built: rows of the points given
  std::vector<signed char> axes_;
};

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_NEAREST_POINT_H_
