#ifndef BATTEN_PROBLEMS_DATA_SET_H_
#define BATTEN_PROBLEMS_DATA_SET_H_

#include <istream>
#include <optional>
#include <string>

#include "splines/points.h"

namespace batten {

/// Of the magnitude of a number in a data file: its square, and the sum of many of them, is still a
/// double.
inline constexpr double kLargestNumber = 1e150;

/// Data points with what came along in the file.
struct DataSet {
  std::string name;                           // file name without folder and extension
  Points points;                              // m x d, d = 1..kMaxDimension, finite
  std::optional<Eigen::VectorXd> parameters;  // column `t`, finite, one a point
  std::optional<Eigen::VectorXd> weights;     // column `weight`, finite, >= 0, not all zero
};

/// Reads points: CSV with a header line (coordinate columns x, y, z, w in this order as far as they
/// go; optional columns t and weight anywhere), or rows of numbers separated by white space without
/// a header (1..kMaxDimension columns). Lines that begin with `#` and empty lines are skipped; CR
/// LF and a byte-order mark are accepted. Nothing, with `FILE:LINE:COLUMN: what was found; what is
/// allowed` in `error` (column: 1-based field), for a missing or unknown column, text in a number,
/// NaN, infinity, a number beyond +-1e150 (its square would overflow), rows of different length, or
/// no point at all. A file whose name ends as a registered DataReader says is read by that.
std::optional<DataSet> ReadDataSet(const std::string& path, std::string* error);  // "-": std::cin
std::optional<DataSet> ReadDataSet(std::istream& stream, const std::string& label,
                                   std::string* error);

}  // namespace batten

#endif  // BATTEN_PROBLEMS_DATA_SET_H_
