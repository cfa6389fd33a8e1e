#include "problems/data_folders.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "problems/data_paths.h"
#include "problems/input_file.h"

namespace batten {
namespace {

namespace fs = std::filesystem;

bool IsFile(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored) && !fs::is_directory(path, ignored);
}

}  // namespace

std::string DataRoot() {
  std::error_code ignored;
  // Of an installation the program itself says where it is, wherever that has been moved to.
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  const fs::path beside = program.parent_path().parent_path() / kDataBesidePrograms;
  if (fs::is_directory(beside / "problems", ignored)) return beside;
  const bool has_source = fs::is_directory(fs::path(kSourceDataDirectory) / "problems", ignored);
  return has_source ? kSourceDataDirectory : kInstallDataDirectory;
}

std::string CatalogueFolder() {
  const char* folder = std::getenv("BATTEN_CATALOGUE");
  if (folder != nullptr && *folder != '\0') return folder;
  return fs::path(DataRoot()) / "problems" / "catalogue";
}

std::vector<std::string> DataFolders(const std::string& problem_file) {
  const fs::path own = fs::path(problem_file).parent_path();
  std::vector<std::string> folders;
  const auto add = [&folders](const fs::path& folder) {
    const std::string text = folder.empty() ? "." : folder.lexically_normal().string();
    if (std::find(folders.begin(), folders.end(), text) == folders.end()) folders.push_back(text);
  };
  add(own);
  // A whole tree may have been moved: its catalogue finds its data without being told.
  if (own.filename() == "catalogue") add(own / ".." / ".." / "data");
  add(fs::path(DataRoot()) / "data");
  return folders;
}

std::string FindDataFile(const std::string& name, const std::string& problem_file) {
  if (fs::path(name).is_absolute()) return IsFile(name) ? name : "";
  for (const std::string& folder : DataFolders(problem_file)) {
    const fs::path path = fs::path(folder) / name;
    if (IsFile(path)) return path;
  }
  return "";
}

std::string AllowedDataFiles(const std::string& name, const std::string& problem_file) {
  std::string folders;
  std::string nearest;
  for (const std::string& folder : DataFolders(problem_file)) {
    folders += (folders.empty() ? "" : " or ") + folder;
    if (nearest.empty()) nearest = NearestFileText(fs::path(folder) / name);
  }
  return "a file in " + folders + nearest;
}

}  // namespace batten
