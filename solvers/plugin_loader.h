#ifndef BATTEN_SOLVERS_PLUGIN_LOADER_H_
#define BATTEN_SOLVERS_PLUGIN_LOADER_H_

#include <string>
#include <vector>

#include "solvers/plugin_card.h"

namespace batten {

/// A shared object whose solvers, terms, cut rules, problems and data readers are registered.
struct LoadedPlugin {
  std::string path;    ///< Absolute, without symbolic links.
  std::string sha256;  ///< Of the file: 64 hexadecimal digits.
  CardFields card;
  std::vector<PluginName> names;
  std::vector<std::string> libraries;  ///< Those it was linked with (NeededLibraries).
};

/// 64 hexadecimal digits; empty where the file cannot be read.
std::string Sha256OfFile(const std::string& path);

/// Loads the shared objects `paths` in their order and appends them to *loaded; one that is loaded
/// already, be it under another name, is passed over. Empty, or one sentence: `PATH: what is wrong;
/// what is allowed`. Of the plugin that it names nothing is registered then. Whole programs only:
/// the program must export its symbols and hold all of the libraries (batten_export_symbols() of
/// the CMake package). Not for several threads at once.
/// @warning The static objects of a plugin are made before its card is read.
std::string LoadPlugins(const std::vector<std::string>& paths, std::vector<LoadedPlugin>* loaded);

/// The files that a text like BATTEN_PLUGIN_PATH means: files, and of folders those that end in
/// .so, in alphabetical order; separated by colons. False with one sentence in `error`.
bool PluginsOfPath(const std::string& text, std::vector<std::string>* paths, std::string* error);

/// What this program has loaded so far: LoadPlugins() with it as `loaded` fills it.
std::vector<LoadedPlugin>& LoadedPlugins();

}  // namespace batten

#endif  // BATTEN_SOLVERS_PLUGIN_LOADER_H_
