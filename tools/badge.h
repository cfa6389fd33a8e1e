#ifndef BATTEN_TOOLS_BADGE_H_
#define BATTEN_TOOLS_BADGE_H_

#include <string>

namespace batten {

/// A flat badge of two fields, grey and green or red, as an SVG file of its own.
std::string BadgeSvg(const std::string& label, const std::string& message, bool is_good);
/// The same as the JSON that shields.io's endpoint badges read.
std::string BadgeJson(const std::string& label, const std::string& message, bool is_good);

}  // namespace batten

#endif  // BATTEN_TOOLS_BADGE_H_
