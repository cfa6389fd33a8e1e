#ifndef BATTEN_TOOLS_OUTPUT_FILES_H_
#define BATTEN_TOOLS_OUTPUT_FILES_H_

#include <string>
#include <vector>

namespace batten {

/// A file that is going to be written, and the flag that asks for it.
struct OutputFile {
  std::string flag;
  std::string path;
};

/// Control characters in names have no place in scripts, lists and terminals. False with one
/// sentence in `error`.
bool CheckName(const OutputFile& output, std::string* error);

/// Before the work: each name is good, each path can be written (tried where it is a regular file
/// or none yet), no two are the same file, none is one of `inputs`. False with one sentence in
/// `error`.
bool CheckOutputs(const std::vector<OutputFile>& outputs, const std::vector<std::string>& inputs,
                  std::string* error);

/// `path` with another ending: a figure's script and data stand beside it.
std::string WithExtension(const std::string& path, const std::string& extension);

}  // namespace batten

#endif  // BATTEN_TOOLS_OUTPUT_FILES_H_
