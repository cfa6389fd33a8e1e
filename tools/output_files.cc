#include "tools/output_files.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "experiments/atomic_file.h"
#include "tools/flags.h"

namespace batten {
namespace {

namespace fs = std::filesystem;

// By what stands there (links of either kind), or by name where nothing stands yet.
bool AreSameFile(const std::string& a, const std::string& b) {
  std::error_code ignored;
  if (fs::equivalent(a, b, ignored)) return true;
  const fs::path whole_a = fs::weakly_canonical(fs::absolute(a, ignored), ignored);
  return whole_a == fs::weakly_canonical(fs::absolute(b, ignored), ignored);
}

bool CanWrite(const std::string& path, std::string* error) {
  // Trying out a device or a pipe could be seen at its other end.
  if (!IsWrittenDirectly(path)) return AtomicFile().Open(path, error);
  if (access(path.c_str(), W_OK) == 0) return true;
  *error = "cannot write " + path + ": " + std::strerror(errno);
  return false;
}

}  // namespace

bool CheckName(const OutputFile& output, std::string* error) {
  const auto is_control = [](unsigned char c) { return c < 32 || c == 127; };
  if (std::none_of(output.path.begin(), output.path.end(), is_control)) return true;
  *error = RefusedFlag(output.flag, output.path, "a name without control characters");
  return false;
}

bool CheckOutputs(const std::vector<OutputFile>& outputs, const std::vector<std::string>& inputs,
                  std::string* error) {
  for (size_t i = 0; i < outputs.size(); ++i) {
    const OutputFile& output = outputs[i];
    const std::string where = "--" + output.flag + ": ";
    if (output.path == "-") {
      *error = where + "found -; allowed: a file, such as /dev/stdout";
      return false;
    }
    if (!CheckName(output, error)) return false;
    const bool may_stand_twice = IsWrittenDirectly(output.path);
    for (size_t j = 0; j < i && !may_stand_twice; ++j) {
      if (!AreSameFile(output.path, outputs[j].path)) continue;
      *error = where + "found " + output.path + ", which --" + outputs[j].flag +
               " writes; allowed: another file";
      return false;
    }
    for (const std::string& input : inputs) {
      if (may_stand_twice || !AreSameFile(output.path, input)) continue;
      *error = where + "found " + output.path + ", which is read; allowed: another file";
      return false;
    }
    std::string reason;
    if (!CanWrite(output.path, &reason)) {
      *error = where + reason;
      return false;
    }
  }
  return true;
}

std::string WithExtension(const std::string& path, const std::string& extension) {
  return fs::path(path).replace_extension(extension).string();
}

}  // namespace batten
