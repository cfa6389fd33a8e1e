#ifndef BATTEN_TOOLS_KNOT_FILE_H_
#define BATTEN_TOOLS_KNOT_FILE_H_

#include <string>
#include <vector>

namespace batten {

/// What --knots may be, for messages.
inline constexpr char kAllowedKnots[] =
    "uniform, averaged, numbers separated by commas, a file of numbers";

/// Numbers separated by white space or commas; from a word that begins with `#` the rest of its
/// line is skipped. False with `FILE:LINE: found ...; allowed: ...` for anything else, knots that
/// decrease, and more of them than any spline has.
bool ReadKnotFile(const std::string& path, std::vector<double>* knots, std::string* error);

/// What --span_weights may be, for messages.
inline constexpr char kAllowedSpanWeights[] =
    "numbers of 0 or more separated by commas, a file of numbers";
/// The same of weights, in any order.
bool ReadSpanWeightFile(const std::string& path, std::vector<double>* weights, std::string* error);

}  // namespace batten

#endif  // BATTEN_TOOLS_KNOT_FILE_H_
