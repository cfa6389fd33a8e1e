#include "experiments/report_document.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "experiments/build_info.h"
#include "experiments/report_bench.h"
#include "experiments/report_cells.h"
#include "experiments/report_curves.h"
#include "experiments/report_groups.h"
#include "experiments/report_plots.h"
#include "experiments/report_tables.h"
#include "experiments/report_traces.h"
#include "problems/input_file.h"

namespace batten {
namespace {

namespace fs = std::filesystem;

/// What one reading of a folder holds.
class FolderReader {
 public:
  FolderReader(std::string folder, const ReportLimits& limits)
      : folder_(std::move(folder)), limits_(limits) {}

  bool Read(ReportDocument* document, std::string* error);

 private:
  std::string InFolder(const std::string& name) const {
    return (fs::path(folder_) / name).string();
  }
  bool Has(const std::string& name) const {
    std::error_code ignored;
    return fs::is_regular_file(InFolder(name), ignored);
  }
  bool IsBench() const { return Has("instances.jsonl"); }
  bool ReadTraces(std::string* error);
  void ReadBench();
  bool ReadLogs(std::string* error);
  bool ReadManifest(std::string* error);
  void LeaveOutOtherCells();
  bool ReadBenchNotes(std::string* error);
  bool TracesJson(std::string* json, std::string* error);

  const std::string folder_;
  const ReportLimits limits_;
  std::vector<std::string> notes_;
  std::vector<OrderedJson> cells_;
  std::vector<ReportTrace> traces_;  // one per cell, without rows where there is none
  BenchFacts bench_;
  std::vector<double> targets_;  // of the page's profiles
  ReportGroups groups_;
  OrderedJson logs_ = OrderedJson::object();
  OrderedJson manifest_;
  OrderedJson bench_notes_ = OrderedJson::array();
};

std::string Joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ",") + word;
  return text;
}

bool FolderReader::ReadTraces(std::string* error) {
  std::map<std::string, std::string> terms;  // by problem
  for (OrderedJson& cell : cells_) {
    traces_.emplace_back();
    const std::string key = TextField(cell, "key");
    const std::string name = "traces/" + key + ".csv";
    if (key.empty() || !Has(name)) continue;
    if (!ReadReportTrace(InFolder(name), limits_.rows_per_trace, &traces_.back(), &notes_, error)) {
      return false;
    }
    terms.emplace(TextField(cell, "problem"), Joined(traces_.back().terms));
    if (!cell.contains("terms")) cell["terms"] = Joined(traces_.back().terms);
  }
  // Runs without a trace, skipped ones above all, belong to the problem as the others ran it.
  for (OrderedJson& cell : cells_) {
    const auto found = terms.find(TextField(cell, "problem"));
    if (!cell.contains("terms") && found != terms.end()) cell["terms"] = found->second;
  }
  return true;
}

/// Rows of `bench` name no basin: which there are shows only when all runs are there.
void FolderReader::ReadBench() {
  if (!IsBench()) return;
  bench_ = ReadBenchFacts(folder_);
  for (OrderedJson& cell : cells_) {
    const auto basin = bench_.basin.find(TextField(cell, "key"));
    if (basin != bench_.basin.end()) cell["basin"] = basin->second;
  }
}

bool FolderReader::ReadLogs(std::string* error) {
  std::size_t bytes = 0;
  std::size_t left_out = 0;
  for (const OrderedJson& cell : cells_) {
    const std::string key = TextField(cell, "key");
    const std::string name = "logs/" + key + ".log";
    if (key.empty() || !Has(name)) continue;
    std::string text;
    if (!ReadWholeFile(InFolder(name), &text, error)) return false;
    if (text.size() > limits_.log_bytes) {
      text = "[the last " + std::to_string(limits_.log_bytes) + " of " +
             std::to_string(text.size()) + " bytes]\n" +
             text.substr(text.size() - limits_.log_bytes);
    }
    bytes += text.size();
    if (bytes > limits_.all_log_bytes) {
      ++left_out;
    } else {
      logs_[key] = std::move(text);
    }
  }
  if (left_out > 0) notes_.push_back(std::to_string(left_out) + " logs are not in the page");
  return true;
}

bool FolderReader::ReadManifest(std::string* error) {
  if (!Has("manifest.json")) return true;
  std::string text;
  if (!ReadWholeFile(InFolder("manifest.json"), &text, error)) return false;
  manifest_ = OrderedJson::parse(text, nullptr, /*allow_exceptions=*/false);
  if (manifest_.is_object()) return true;
  *error = InFolder("manifest.json") + ": found no JSON object; allowed: one";
  return false;
}

/// What a folder of `bench` has from before its suite, data or program changed is not in its
/// tables.
void FolderReader::LeaveOutOtherCells() {
  if (!manifest_.is_object() || !manifest_.contains("cells")) return;
  const std::size_t others = KeepCells(manifest_["cells"], &cells_);
  if (others == 0) return;
  notes_.push_back("cells.jsonl: rows that are left out, of cells that the suite had before: " +
                   std::to_string(others));
}

/// The paragraphs and points of what `bench` says about its results.
bool FolderReader::ReadBenchNotes(std::string* error) {
  if (!IsBench() || !Has("notes.md")) return true;
  std::string text;
  if (!ReadWholeFile(InFolder("notes.md"), &text, error)) return false;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty() && line.front() != '#') bench_notes_.push_back(line);
  }
  return true;
}

/// {KEY: [rows in the file, iterations, evaluations, seconds, processor seconds, E - E*, |g|,
/// TargetHits, and the same to the run's own basin where it is known]}. E* is taken off here, where
/// E has all its digits.
bool FolderReader::TracesJson(std::string* json, std::string* error) {
  using Row = ReportTrace::Row;
  constexpr double Row::*kColumns[] = {&Row::iteration,   &Row::evaluations, &Row::seconds,
                                       &Row::cpu_seconds, &Row::energy,      &Row::gradient_norm};
  std::string text = "{";
  for (std::size_t k = 0; k < cells_.size(); ++k) {
    const ReportTrace& trace = traces_[k];
    if (trace.rows.empty()) continue;
    const std::string key = TextField(cells_[k], "key");
    const ReportGroup& group = groups_.list[groups_.of_cell[k]];
    const double minimum = group.minimum();
    const auto common = bench_.start.find(key);
    const double start =
        common != bench_.start.end() ? common->second : NumberField(cells_[k], "start_energy");
    text += (text.size() > 1 ? ",\"" : "\"") + key + "\":[" + std::to_string(trace.num_rows);
    for (double Row::*column : kColumns) {
      text += ",[";
      for (std::size_t i = 0; i < trace.rows.size(); ++i) {
        const double value = trace.rows[i].*column;
        if (i > 0) text += ',';
        text += PlotNumber(column == &Row::energy ? value - minimum : value);
      }
      text += ']';
    }
    // E* is known only now, and all rows of all traces need not fit into the memory.
    ReportTrace whole;
    std::vector<std::string> known_notes;
    if (trace.rows.size() < trace.num_rows &&
        !ReadReportTrace(InFolder("traces/" + key + ".csv"), trace.num_rows, &whole, &known_notes,
                         error)) {
      return false;
    }
    const std::vector<Row>& rows = whole.rows.empty() ? trace.rows : whole.rows;
    text += ',' + TargetHits(rows, targets_, start, minimum, group.truth);
    const auto own = bench_.own.find(key);
    if (own != bench_.own.end())
      text += ',' + TargetHits(rows, targets_, start, own->second, group.truth);
    text += ']';
  }
  *json = text + "}";
  return true;
}

bool FolderReader::Read(ReportDocument* document, std::string* error) {
  const bool has_cells = Has("cells.jsonl");
  if (has_cells && !ReadCells(InFolder("cells.jsonl"), &cells_, &notes_, error)) return false;
  if (!ReadManifest(error)) return false;
  LeaveOutOtherCells();
  if (!ReadTraces(error) || !ReadLogs(error) || !ReadBenchNotes(error)) return false;
  ReadBench();
  targets_ = ReportTargets(bench_.targets);
  groups_ = FindReportGroups(cells_, traces_, bench_);
  OrderedJson tables, pictures, pages;
  // Of compare the rows of cells.jsonl once more; that of bench has basins and costs beside them.
  const std::vector<std::string> skipped(has_cells && !IsBench() ? 1 : 0, "table.csv");
  if (!ReadReportTables(folder_, skipped, limits_, &tables, &notes_, error) ||
      !ReadReportPictures(folder_, limits_, &pictures, &notes_, error) ||
      !ReadReportPlots(folder_, limits_, &pictures, &document->plots, &notes_, error) ||
      !ReadReproductionPages(folder_, &pages, error) ||
      !ReadReportCurves(folder_, cells_, limits_, &document->curves, &notes_, error) ||
      !TracesJson(&document->traces, error)) {
    return false;
  }
  if (!has_cells && tables.empty()) {
    *error = folder_ + ": found no results; allowed: a folder that compare, bench or reproduce " +
             "has written (cells.jsonl or CSV tables)";
    return false;
  }
  std::error_code ignored;
  const fs::path whole = fs::weakly_canonical(folder_, ignored);
  OrderedJson summary = {{"format", "batten.report/1"},
                         {"name", (whole.empty() ? fs::path(folder_) : whole).filename().string()},
                         {"version", kVersion},
                         {"commit", kGitCommit},
                         {"cells", CellsByColumn(cells_)},
                         {"group_of", groups_.of_cell},
                         {"groups", GroupsJson(groups_)},
                         {"targets", targets_},
                         {"suite_targets", bench_.targets},
                         {"pages", std::move(pages)},
                         {"tables", std::move(tables)},
                         {"pictures", std::move(pictures)},
                         {"logs", logs_},
                         {"manifest", manifest_},
                         {"bench_notes", bench_notes_},
                         {"notes", notes_}};
  // Logs and tables may hold anything: bad UTF-8 is replaced, not thrown at.
  document->summary = summary.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
  document->num_cells = static_cast<int>(cells_.size());
  return true;
}

}  // namespace

bool ReadReportDocument(const std::string& folder, const ReportLimits& limits,
                        ReportDocument* document, std::string* error) {
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) {
    *error = folder + (fs::exists(folder, ignored) ? ": found a file" : ": found nothing there") +
             "; allowed: a folder that compare, bench or reproduce has written";
    return false;
  }
  return FolderReader(folder, limits).Read(document, error);
}

}  // namespace batten
