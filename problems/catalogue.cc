#include "problems/catalogue.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "problems/data_folders.h"

namespace batten {
namespace {

namespace fs = std::filesystem;

bool IsPath(const std::string& text) {
  return text.find('/') != std::string::npos || fs::path(text).extension() == ".json";
}

}  // namespace

bool ListCatalogue(std::vector<std::string>* names, std::string* error) {
  names->clear();
  std::error_code code;
  fs::directory_iterator file(CatalogueFolder(), code);
  for (; !code && file != fs::directory_iterator(); file.increment(code)) {
    if (file->path().extension() == ".json") names->push_back(file->path().stem());
  }
  std::sort(names->begin(), names->end());
  if (!code && !names->empty()) return true;
  *error = CatalogueFolder() + ": found no problem files" +
           (code ? " (" + code.message() + ")" : "") +
           "; allowed: a folder of .json files, as BATTEN_CATALOGUE names it";
  return false;
}

bool FindProblem(const std::string& name_or_path, CatalogueEntry* entry, std::string* error) {
  if (IsPath(name_or_path)) return ReadProblemFile(name_or_path, entry, error);
  std::vector<std::string> names;
  if (!ListCatalogue(&names, error)) return false;
  if (!std::binary_search(names.begin(), names.end(), name_or_path)) {
    *error = UnknownNameMessage("problem", name_or_path, names);
    return false;
  }
  const std::string path = fs::path(CatalogueFolder()) / (name_or_path + ".json");
  CatalogueEntry read;
  if (!ReadProblemFile(path, &read, error)) return false;
  if (read.name != name_or_path) {
    *error = path + ": /name: found \"" + read.name + "\"; allowed: \"" + name_or_path +
             "\", as the file is called";
    return false;
  }
  *entry = std::move(read);
  return true;
}

std::unique_ptr<Problem> LoadProblem(const CatalogueEntry& entry, std::string* error) {
  std::optional<DataSet> data = ReadDataSet(entry.data_path, error);
  if (!data.has_value()) return nullptr;
  std::unique_ptr<Problem> problem = MakeFitProblem(std::move(*data), entry.spec, error);
  if (problem == nullptr) *error = entry.path + ": " + *error;
  return problem;
}

}  // namespace batten
