#ifndef BATTEN_TOOLS_PLUGIN_FLAGS_H_
#define BATTEN_TOOLS_PLUGIN_FLAGS_H_

#include <string>

#include "tools/flags.h"

namespace batten {

/// --plugins, which every command has that knows solvers, terms or problems.
FlagInfo PluginsFlag();

/// Loads what BATTEN_PLUGIN_PATH and then --plugins name into LoadedPlugins(). False with one
/// sentence in `error`.
bool LoadPluginsFromFlags(std::string* error);

}  // namespace batten

#endif  // BATTEN_TOOLS_PLUGIN_FLAGS_H_
