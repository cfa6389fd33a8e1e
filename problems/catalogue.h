#ifndef BATTEN_PROBLEMS_CATALOGUE_H_
#define BATTEN_PROBLEMS_CATALOGUE_H_

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "problems/fit_problem.h"
#include "problems/problem.h"

namespace batten {

/// A problem file (docs/formats.md): JSON with "name", "data" (path, relative to the data folder or
/// to the file), "spline" {"degree", "closed", "control_points", "knots", "ends"}, "parameters",
/// "terms" (list of names with options), "start", "reference" {"energy", ...}, "citation".
struct CatalogueEntry {
  std::string name;
  std::string path;       // of the problem file
  std::string data_path;  // resolved
  FitSpec spec;
  double reference_energy = 0.0;  // E*; not fixed t: best known at feet; user's units, NaN: none
  std::string citation;
  std::string summary;
  /// Of a plugin's problem, whose file is `path` and `data_path`: its data, instead of read ones.
  std::function<std::optional<DataSet>(std::string* error)> make_data;
};

/// Reads and checks one problem file. False with `FILE: JSON path: found ...; allowed: ...`.
bool ReadProblemFile(const std::string& path, CatalogueEntry* entry, std::string* error);

/// Names of the catalogue's problems: the folder problems/catalogue of the source tree or of the
/// installation, or BATTEN_CATALOGUE, and those of plugins. Sorted; at least one. False with one
/// sentence in `error`, which names the folder.
bool ListCatalogue(std::vector<std::string>* names, std::string* error);

/// A problem by catalogue name or by path of a problem file (anything with a `/` or ending in
/// .json).
bool FindProblem(const std::string& name_or_path, CatalogueEntry* entry, std::string* error);
/// Read or made; nothing with one sentence in `error`.
std::optional<DataSet> LoadData(const CatalogueEntry& entry, std::string* error);
std::unique_ptr<Problem> LoadProblem(const CatalogueEntry& entry, std::string* error);

}  // namespace batten

#endif  // BATTEN_PROBLEMS_CATALOGUE_H_
