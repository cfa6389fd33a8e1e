#ifndef BATTEN_TOOLS_MAX_DISTANCE_FLAGS_H_
#define BATTEN_TOOLS_MAX_DISTANCE_FLAGS_H_

#include <string>
#include <vector>

#include "problems/fit_problem.h"
#include "tools/flags.h"

namespace batten {

/// --max_distance.
FlagInfo MaxDistanceFlag();
bool AsksForMaxDistance();
double MaxDistance();
/// Of the flags of the command, those that say how a curve of given knots is solved for are refused
/// beside --max_distance. Also what a named problem has of them. False with one sentence in
/// `error`.
bool CheckMaxDistanceFlags(const std::vector<FlagInfo>& flags, const FitSpec& spec,
                           std::string* error);

}  // namespace batten

#endif  // BATTEN_TOOLS_MAX_DISTANCE_FLAGS_H_
