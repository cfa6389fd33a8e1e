#include "experiments/bench_records.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "experiments/atomic_file.h"
#include "experiments/bench_data.h"
#include "experiments/curve_records.h"
#include "experiments/fit_report.h"

namespace batten {
namespace {

/// Empty, or the file and why it cannot be written; then nothing is left of it.
std::string WriteFile(const std::string& path, const std::function<void(std::ostream*)>& write) {
  errno = 0;
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  write(&file);
  file.close();
  if (!file.fail()) return "";
  const std::string why = errno != 0 ? std::string(": ") + std::strerror(errno) : "";
  std::remove(path.c_str());
  return path + why;
}

/// Lines that have their end.
long CountLines(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  long lines = 0;
  for (std::string line; std::getline(file, line) && !file.eof();) ++lines;
  return lines;
}

bool IsThere(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored);
}

}  // namespace

std::size_t MostIterates(const Problem& problem, int asked) {
  constexpr int kMostNumbers = 20'000;
  constexpr std::size_t kMostBytes = 32u * 1024 * 1024;
  // Each iterate beyond what is held looks through all of them.
  constexpr std::size_t kMost = 20'000;
  const CurveFit* const fit = problem.curve_fit();
  if (fit == nullptr || fit->basis().num_control_points() * fit->dimension() > kMostNumbers) {
    return 0;
  }
  const std::size_t bytes_each = static_cast<std::size_t>(problem.num_variables()) * sizeof(double);
  std::size_t most = std::min(kMost, kMostBytes / std::max<std::size_t>(1, bytes_each));
  if (asked != kAllIterates) most = std::min(most, static_cast<std::size_t>(asked));
  return most < 2 ? 0 : most;  // the first and the last
}

std::string WriteRecords(const Problem& problem, const RunResult& run, const BenchRecords& records,
                         nlohmann::ordered_json* row) {
  (*row)["trace_rows"] = run.trace.size();
  (*row)["iterate_rows"] = run.iterates.size();
  if (!run.skipped.empty()) return "";
  std::string failure =
      WriteFile(records.trace, [&](std::ostream* file) { *file << RunTraceCsv(problem, run); });
  if (!failure.empty() || run.iterates.empty()) return failure;
  const CurveFit& fit = *problem.curve_fit();
  failure = WriteFile(records.iterates, [&](std::ostream* file) {
    for (const Iterate& iterate : run.iterates) *file << ControlPointsJsonLine(fit, iterate);
  });
  if (!failure.empty()) return failure;
  // Other cells may read it, or write the same, at this moment.
  std::string error;
  const bool has_curve =
      IsThere(records.curve) || WriteFileAtomically(records.curve, CurveJson(fit), &error);
  return has_curve ? "" : records.curve;
}

bool HasRecords(const nlohmann::json& row, const BenchRecords& records) {
  const double trace_rows = NumberAt(row, "trace_rows");
  const double iterate_rows = NumberAt(row, "iterate_rows");
  if (std::isnan(trace_rows) || std::isnan(iterate_rows)) return false;
  if (trace_rows > 0.0 && CountLines(records.trace) != trace_rows + 1.0) return false;
  return iterate_rows == 0.0 ||
         (CountLines(records.iterates) == iterate_rows && IsThere(records.curve));
}

}  // namespace batten
