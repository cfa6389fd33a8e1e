#ifndef BATTEN_TESTS_TOOLS_PLUGIN_FILES_H_
#define BATTEN_TESTS_TOOLS_PLUGIN_FILES_H_

#include <cstdlib>
#include <string>

namespace batten {

/// A plugin of tests/plugins/ or plugins/, as it was built.
inline std::string Plugin(const std::string& name) {
  return std::string(BATTEN_PLUGINS) + "/" + name + ".so";
}
inline std::string PluginFlag(const std::string& name) { return "--plugins=" + Plugin(name); }

/// Sets an environment variable for as long as it lives.
class Environment {
 public:
  Environment(const char* name, const std::string& value) : name_(name) {
    setenv(name, value.c_str(), 1);
  }
  ~Environment() { unsetenv(name_); }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  const char* name_;
};

}  // namespace batten

#endif  // BATTEN_TESTS_TOOLS_PLUGIN_FILES_H_
