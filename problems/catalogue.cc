#include "problems/catalogue.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <system_error>

#include "problems/data_folders.h"
#include "problems/data_reader.h"
#include "problems/problem_registry.h"

namespace batten {
namespace {

namespace fs = std::filesystem;

bool IsPath(const std::string& text) {
  return text.find('/') != std::string::npos || fs::path(text).extension() == ".json";
}

CatalogueEntry EntryOf(const NamedProblem& problem) {
  CatalogueEntry entry;
  entry.name = problem.name;
  entry.path = entry.data_path = problem.plugin;
  entry.spec = problem.spec;
  entry.spec.name = problem.name;
  entry.reference_energy = std::numeric_limits<double>::quiet_NaN();
  entry.citation = problem.citation;
  entry.summary = problem.summary;
  entry.make_data = problem.make_data;
  return entry;
}

}  // namespace

bool ListCatalogue(std::vector<std::string>* names, std::string* error) {
  names->clear();
  std::error_code code;
  fs::directory_iterator file(CatalogueFolder(), code);
  for (; !code && file != fs::directory_iterator(); file.increment(code)) {
    if (file->path().extension() == ".json") names->push_back(file->path().stem());
  }
  const std::vector<std::string> added = ProblemRegistry::Global().Names();
  names->insert(names->end(), added.begin(), added.end());
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
  const NamedProblem* const added = ProblemRegistry::Global().Find(name_or_path);
  if (added != nullptr) {
    *entry = EntryOf(*added);
    return true;
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

std::optional<DataSet> LoadData(const CatalogueEntry& entry, std::string* error) {
  if (entry.make_data == nullptr) return ReadDataSet(entry.data_path, error);
  std::optional<DataSet> data = entry.make_data(error);
  std::string why;
  if (data.has_value() && !CheckDataSet(*data, &why)) {
    *error = "problem " + entry.name + ": " + why;
    return std::nullopt;
  }
  if (data.has_value() && data->name.empty()) data->name = entry.name;
  return data;
}

std::unique_ptr<Problem> LoadProblem(const CatalogueEntry& entry, std::string* error) {
  std::optional<DataSet> data = LoadData(entry, error);
  if (!data.has_value()) return nullptr;
  std::unique_ptr<Problem> problem = MakeFitProblem(std::move(*data), entry.spec, error);
  if (problem == nullptr) *error = entry.path + ": " + *error;
  return problem;
}

}  // namespace batten
