#include "tools/plugin_flags.h"

#include <gflags/gflags.h>

#include <cstdlib>
#include <vector>

#include "solvers/plugin_loader.h"
#include "tools/run_flags.h"

DEFINE_string(plugins, "",
              "Shared objects that bring more solvers, terms, cut rules, problems and data "
              "readers, beside those of BATTEN_PLUGIN_PATH (files and folders, with colons "
              "between); docs/plugins.md.");

namespace batten {
namespace {

constexpr char kAllowed[] = "shared objects, separated by commas";

bool Load(const std::string& source, const std::vector<std::string>& paths, std::string* error) {
  *error = LoadPlugins(paths, &LoadedPlugins());
  if (error->empty()) return true;
  *error = source + ": " + *error;
  return false;
}

}  // namespace

FlagInfo PluginsFlag() { return TextFlag("plugins", "A.so,B.so", kAllowed); }

bool LoadPluginsFromFlags(std::string* error) {
  const char* const path = std::getenv("BATTEN_PLUGIN_PATH");
  if (path != nullptr) {
    std::vector<std::string> files;
    if (!PluginsOfPath(path, &files, error)) {
      *error = "BATTEN_PLUGIN_PATH: " + *error;
      return false;
    }
    if (!Load("BATTEN_PLUGIN_PATH", files, error)) return false;
  }
  if (FLAGS_plugins.empty()) return true;
  const std::vector<std::string> files = SplitAtCommas(FLAGS_plugins);
  for (const std::string& file : files) {
    if (!file.empty()) continue;
    *error = RefusedFlag("plugins", FLAGS_plugins, kAllowed);
    return false;
  }
  return Load("--plugins", files, error);
}

}  // namespace batten
