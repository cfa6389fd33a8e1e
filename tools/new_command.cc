#include <algorithm>
#include <cctype>
#include <filesystem>

#include "cost_functions/term.h"
#include "experiments/atomic_file.h"
#include "experiments/build_info.h"
#include "solvers/plugin_loader.h"
#include "solvers/solver_registry.h"
#include "tools/command.h"
#include "tools/skeletons.h"

namespace batten {
namespace {

constexpr std::size_t kLongestName = 40;

bool IsOneOf(const std::string& text, const std::vector<std::string>& words) {
  return std::find(words.begin(), words.end(), text) != words.end();
}

/// Empty, or what is wrong with a name that becomes a file, a class and a target of CMake.
std::string WhyNoName(const std::string& name) {
  const bool has_letters = !name.empty() && name.size() <= kLongestName &&
                           std::islower(name.front()) != 0 &&
                           std::all_of(name.begin(), name.end(), [](unsigned char c) {
                             return std::islower(c) != 0 || std::isdigit(c) != 0 || c == '_';
                           });
  if (!has_letters || name.back() == '_' || name.find("__") != std::string::npos) {
    return "found " + Quoted(name, kLongestName) +
           " as a name; allowed: a lower-case letter, then lower-case letters, digits and single "
           "_, at most " +
           std::to_string(kLongestName);
  }
  // A suite means a problem's terms by these.
  if (IsOneOf(name, {"own", "distance"})) {
    return "found " + name + " as a name, which has a meaning in suites; allowed: any other";
  }
  // There are targets of these names already, of CMake itself and of the packages that Batten
  // needs.
  if (IsOneOf(name, {"all", "clean", "help", "install", "package", "package_source", "preinstall",
                     "edit_cache", "rebuild_cache", "test"})) {
    return "found " + name + " as a name, which is one of CMake's own; allowed: any other";
  }
  if (IsOneOf(name, {"ceres", "gflags", "gflags_nothreads_shared", "gflags_nothreads_static",
                     "gflags_shared", "gflags_static", "glog", "nlohmann_json", "pugixml"})) {
    return "found " + name + " as a name, which is a library that Batten needs; allowed: any other";
  }
  return "";
}

/// "my_method" to "MyMethodSolver", "my_solver" to "MySolver". With its kind at the end no name
/// hides what the source uses: Eigen, SimpleStepper, ...
std::string ClassName(const std::string& name, const std::string& kind) {
  std::string text;
  bool is_first = true;
  for (const char c : name) {
    if (c != '_') text += is_first ? static_cast<char>(std::toupper(c)) : c;
    is_first = c == '_';
  }
  const std::string ending = kind == "solver" ? "Solver" : "Term";
  const bool has_ending = text.size() > ending.size() &&
                          text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
  return has_ending ? text : text + ending;
}

std::string Filled(std::string text, const std::string& name, const std::string& kind) {
  const std::pair<std::string, std::string> fields[] = {
      {"@NAME@", name}, {"@CLASS@", ClassName(name, kind)}, {"@VERSION@", kVersion}};
  for (const auto& [field, value] : fields) {
    for (std::size_t at = text.find(field); at != std::string::npos; at = text.find(field)) {
      text.replace(at, field.size(), value);
    }
  }
  return text;
}

int RunNew(const std::vector<std::string>& positional, CommandOutput* output) {
  const std::vector<std::string> kinds = {"solver", "term"};
  if (positional.size() != 2) {
    return Refuse("new: found " + std::to_string(positional.size()) +
                      " words; allowed: solver NAME, term NAME",
                  output);
  }
  const std::string& kind = positional[0];
  const std::string& name = positional[1];
  if (!IsOneOf(kind, kinds))
    return Refuse("new: " + UnknownNameMessage("kind", kind, kinds), output);
  std::string why = WhyNoName(name);
  if (why.empty() && (SolverRegistry::Global().Find(name) != nullptr ||
                      TermRegistry::Global().Find(name) != nullptr)) {
    why = "found " + name + ", which is a solver or term already; allowed: any other name";
  }
  if (!why.empty()) return Refuse("new: " + why, output);
  std::error_code code;
  if (std::filesystem::symlink_status(name, code).type() != std::filesystem::file_type::not_found) {
    return Refuse(
        "new: " + name + " is there already; allowed: a name that is no file or folder here",
        output);
  }
  if (!CreateDirectories(name, &output->error)) return kBadInput;
  const bool is_solver = kind == "solver";
  const std::string source = name + "/" + name + ".cc";
  const std::string build = name + "/CMakeLists.txt";
  FileBatch files;
  const bool is_written =
      files.Write(source, Filled(is_solver ? kSolverSkeleton : kTermSkeleton, name, kind),
                  &output->error) != nullptr &&
      files.Write(build,
                  Filled(std::string(kBuild) + (is_solver ? kSolverTest : kTermTest), name, kind),
                  &output->error) != nullptr &&
      files.Commit(&output->error);
  if (!is_written) {
    std::filesystem::remove(name, code);
    return kBadInput;
  }
  output->results = "wrote " + source + " and " + build + "; next:\n  cmake -S " + name + " -B " +
                    name + "/build && cmake --build " + name + "/build\n  batten check " + name +
                    "/build/" + name + ".so\n";
  return kDone;
}

}  // namespace

Command NewCommand() {
  Command command;
  command.name = "new";
  command.arguments = "solver|term NAME";
  command.summary = "writes a plugin that works, to be changed: a source, a CMake file and a test";
  command.details = {
      "NAME becomes a folder here, the file, the class and what --solver or --terms "
      "call it. The test is batten check on the plugin and a comparison with a "
      "solver of ours: ctest --test-dir NAME/build."};
  command.examples = {"batten new solver my_method", "batten new term my_term"};
  command.run = &RunNew;
  return command;
}

}  // namespace batten
