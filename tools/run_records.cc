#include "tools/run_records.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "experiments/curve_records.h"
#include "experiments/fit_report.h"
#include "problems/fit_problem.h"
#include "tools/comparison_cells.h"

namespace batten {
namespace {

namespace fs = std::filesystem;

std::string Path(const std::string& folder, const char* kind, const std::string& file) {
  return (fs::path(folder) / kind / file).string();
}

/// The folders of the records.
std::vector<std::string> Kinds(const ComparisonSpec& spec) {
  if (spec.kept_iterates == 0) return {"traces"};
  return {"traces", "iterates", "curves"};
}

long CountLines(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return std::count(std::istreambuf_iterator<char>(file), {}, '\n');
}

}  // namespace

bool CheckRunRecords(const std::string& folder, const ComparisonSpec& spec, std::string* error) {
  std::error_code ignored;
  for (const std::string& kind : Kinds(spec)) {
    const std::string path = (fs::path(folder) / kind).string();
    const bool is_folder = fs::is_directory(path, ignored);
    if (!is_folder && fs::exists(path, ignored)) {
      *error = "--out: cannot write into " + path + ": it is no folder";
      return false;
    }
    std::string reason;
    if (is_folder && !AtomicFile().Open(path + "/0", &reason)) {
      *error = "--out: " + reason;
      return false;
    }
  }
  return true;
}

bool WriteRunRecords(const CatalogueEntry& entry, const ComparisonResult& result,
                     const std::string& folder, FileBatch* batch, std::string* error) {
  const Problem& problem = *result.problems.at(0);
  const CurveFit* const fit = problem.curve_fit();
  for (const std::string& kind : Kinds(result.spec)) {
    if (!CreateDirectories((fs::path(folder) / kind).string(), error)) return false;
  }
  const bool has_iterates = result.spec.kept_iterates > 0 && fit != nullptr;
  for (std::size_t k = 0; k < result.rows.size(); ++k) {
    const RunResult& run = result.rows[k].run;
    if (!run.skipped.empty()) continue;
    const std::string key = CellKey(entry, result.spec.solvers.at(k), result.spec);
    if (batch->Write(Path(folder, "traces", key + ".csv"), RunTraceCsv(problem, run), error) ==
        nullptr) {
      return false;
    }
    if (has_iterates && batch->Write(Path(folder, "iterates", key + ".jsonl"),
                                     IteratesJsonLines(problem, run), error) == nullptr) {
      return false;
    }
  }
  return !has_iterates || batch->Write(Path(folder, "curves", entry.name + ".json"),
                                       CurveJson(*fit), error) != nullptr;
}

bool HasRunRecords(const CatalogueEntry& entry, const ComparisonResult& result,
                   const ComparisonSpec& spec, const std::string& folder) {
  std::error_code ignored;
  for (std::size_t k = 0; k < result.rows.size(); ++k) {
    if (!result.rows[k].run.skipped.empty()) continue;
    const std::string key = CellKey(entry, spec.solvers.at(k), spec);
    if (!fs::is_regular_file(Path(folder, "traces", key + ".csv"), ignored)) return false;
    if (spec.kept_iterates == 0) continue;
    const std::string iterates = Path(folder, "iterates", key + ".jsonl");
    if (!fs::is_regular_file(iterates, ignored)) return false;
    // An earlier run may have kept fewer; none is what does not fit.
    const long lines = CountLines(iterates);
    const long asked = std::min<long>(spec.kept_iterates, result.rows[k].run.iterations + 1);
    if (lines > 0 && lines < asked) return false;
  }
  return true;
}

}  // namespace batten
