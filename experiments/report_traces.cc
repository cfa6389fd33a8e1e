#include "experiments/report_traces.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iterator>
#include <utility>

#include "cost_functions/options.h"
#include "experiments/kept_rows.h"

namespace batten {
namespace {

std::string Place(const std::string& path, long number) {
  return path + ":" + std::to_string(number) + ": ";
}

/// Takes the lines of a trace, the header first; columns may stand in any order.
class TraceReader {
 public:
  const std::vector<ReportTrace::Row>& rows() const { return rows_; }
  std::vector<std::string> Terms() const;
  /// False with what is wrong.
  bool Take(std::string_view line, std::string* wrong);

 private:
  enum Column { kIteration, kEnergy, kGradientNorm, kSeconds, kCpuSeconds, kFirstCount };
  static constexpr const char* kColumns[] = {"iteration",      "energy",         "gradient_norm",
                                             "seconds",        "cpu_seconds",    "energy_calls",
                                             "gradient_calls", "jacobian_calls", "products"};

  bool TakeHeader(std::vector<std::string> names, std::string* wrong);
  /// NaN where there is no such column.
  double At(int column) const {
    return places_[column] < 0 ? NAN : numbers_[static_cast<std::size_t>(places_[column])];
  }

  std::vector<std::string> names_;
  int places_[std::size(kColumns)] = {};
  std::vector<double> numbers_;  // of the line at hand
  std::vector<ReportTrace::Row> rows_;
};

bool TraceReader::TakeHeader(std::vector<std::string> names, std::string* wrong) {
  names_ = std::move(names);
  std::transform(std::begin(kColumns), std::end(kColumns), places_, [this](const char* name) {
    const auto found = std::find(names_.begin(), names_.end(), name);
    return found == names_.end() ? -1 : static_cast<int>(found - names_.begin());
  });
  if (places_[kIteration] >= 0 && places_[kEnergy] >= 0) return true;
  *wrong = "found no columns iteration and energy; allowed: a trace";
  return false;
}

bool TraceReader::Take(std::string_view line, std::string* wrong) {
  std::vector<std::string> fields = CsvFields(line);
  if (names_.empty()) return TakeHeader(std::move(fields), wrong);
  if (fields.size() != names_.size()) {
    *wrong = "found " + std::to_string(fields.size()) +
             " fields; allowed: " + std::to_string(names_.size()) + ", as in the header";
    return false;
  }
  numbers_.assign(fields.size(), NAN);
  for (std::size_t k = 0; k < fields.size(); ++k) {
    if (fields[k].empty() || ParseNumber(fields[k], &numbers_[k])) continue;
    *wrong = "found \"" + fields[k].substr(0, 40) + "\"; allowed: a number";
    return false;
  }
  double evaluations = 0.0;
  for (int count = kFirstCount; count < static_cast<int>(std::size(kColumns)); ++count) {
    if (places_[count] >= 0) evaluations += At(count);
  }
  rows_.push_back(
      {At(kIteration), evaluations, At(kSeconds), At(kCpuSeconds), At(kEnergy), At(kGradientNorm)});
  return true;
}

std::vector<std::string> TraceReader::Terms() const {
  const std::string prefix = "energy_";
  std::vector<std::string> terms;
  for (const std::string& name : names_) {
    if (name == "energy_calls" || name.compare(0, prefix.size(), prefix) != 0) continue;
    terms.push_back(name.substr(prefix.size()));
  }
  return terms;
}

}  // namespace

std::vector<std::string> CsvFields(std::string_view line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const char c = line[k];
    if (quoted && c == '"' && k + 1 < line.size() && line[k + 1] == '"') {
      fields.back() += c;
      ++k;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      fields.emplace_back();
    } else if (c != '\r' || k + 1 < line.size()) {
      fields.back() += c;
    }
  }
  return fields;
}

bool ReadReportTrace(const std::string& path, std::size_t most, ReportTrace* trace,
                     std::vector<std::string>* notes, std::string* error) {
  TraceReader reader;
  const auto take = [&](std::string_view line, long number, bool is_torn) {
    // Also where it can be read: a number may have lost its last digits.
    if (is_torn) {
      notes->push_back(Place(path, number) + "the last line is torn and was left out");
      return true;
    }
    std::string wrong;
    if (reader.Take(line, &wrong)) return true;
    *error = Place(path, number) + wrong;
    return false;
  };
  if (!ReadLines(path, take, error)) return false;
  trace->num_rows = reader.rows().size();
  trace->terms = reader.Terms();
  for (const std::size_t k : KeptRows(reader.rows().size(), most)) {
    trace->rows.push_back(reader.rows()[k]);
  }
  return true;
}

std::vector<double> ReportTargets(const std::vector<double>& suite) {
  std::vector<double> targets = {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10};
  targets.insert(targets.end(), suite.begin(), suite.end());
  std::sort(targets.begin(), targets.end(), std::greater<>());
  targets.erase(std::unique(targets.begin(), targets.end()), targets.end());
  return targets;
}

std::string TargetHits(const std::vector<ReportTrace::Row>& rows,
                       const std::vector<double>& targets, double start, double minimum,
                       double truth) {
  using Row = ReportTrace::Row;
  if (std::isnan(start)) start = rows[0].energy;
  std::vector<const Row*> hits;
  for (const double target : targets) {
    const auto is_there = [&](const Row& row) {
      if (target == 0.0) return row.energy <= truth;
      // A start that is the minimum has reached all gaps.
      return row.energy <= minimum || (row.energy - minimum) / (start - minimum) <= target;
    };
    const auto found = std::find_if(rows.begin(), rows.end(), is_there);
    hits.push_back(found == rows.end() ? nullptr : &*found);
  }
  std::string text = "[";
  for (double Row::*column :
       {&Row::iteration, &Row::evaluations, &Row::seconds, &Row::cpu_seconds}) {
    text += text.size() > 1 ? ",[" : "[";
    for (std::size_t k = 0; k < hits.size(); ++k) {
      text += (k > 0 ? "," : "") + (hits[k] == nullptr ? "null" : PlotNumber(hits[k]->*column));
    }
    text += "]";
  }
  return text + "]";
}

std::string PlotNumber(double value) {
  if (!std::isfinite(value)) return "null";
  char text[32];
  std::snprintf(text, sizeof(text), "%.6g", value);
  return text;
}

}  // namespace batten
