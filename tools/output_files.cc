#include "tools/output_files.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "experiments/atomic_file.h"

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

// A device, a pipe: it may be named twice, and trying it out could be seen at the other end.
bool IsSpecial(const std::string& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

bool CanWrite(const std::string& path, std::string* error) {
  if (!IsSpecial(path)) return AtomicFile().Open(path, error);
  if (access(path.c_str(), W_OK) == 0) return true;
  *error = "cannot write " + path + ": " + std::strerror(errno);
  return false;
}

}  // namespace

bool CheckOutputs(const std::vector<OutputFile>& outputs, const std::vector<std::string>& inputs,
                  std::string* error) {
  for (size_t i = 0; i < outputs.size(); ++i) {
    const OutputFile& output = outputs[i];
    const std::string where = "--" + output.flag + ": ";
    if (output.path == "-") {
      *error = where + "found -; allowed: a file, such as /dev/stdout";
      return false;
    }
    for (size_t j = 0; j < i && !IsSpecial(output.path); ++j) {
      if (!AreSameFile(output.path, outputs[j].path)) continue;
      *error = where + "found " + output.path + ", which --" + outputs[j].flag +
               " writes; allowed: another file";
      return false;
    }
    for (const std::string& input : inputs) {
      if (IsSpecial(output.path) || !AreSameFile(output.path, input)) continue;
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

bool IsWriteError(const FigureResult& figure) {
  return !figure.drawn && figure.message.compare(0, 12, "cannot write") == 0;
}

std::string WithExtension(const std::string& path, const std::string& extension) {
  return fs::path(path).replace_extension(extension).string();
}

}  // namespace batten
