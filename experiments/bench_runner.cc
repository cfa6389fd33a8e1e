#include "experiments/bench_runner.h"

#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "experiments/atomic_file.h"
#include "experiments/bench_data.h"
#include "experiments/comparison_records.h"

namespace batten {
namespace {

using Json = nlohmann::ordered_json;

double Now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

BenchRunner::BenchRunner(const BenchSuite& suite, std::vector<BenchCell> cells, BenchFolder folder,
                         int jobs)
    : suite_(suite), cells_(std::move(cells)), folder_(std::move(folder)), jobs_(jobs) {
  for (const BenchCell& cell : cells_) {
    keys_.push_back(BenchCellKey(suite_, cell));
    wanted_[keys_.back()] = keys_.size() - 1;
  }
}

BenchRecords BenchRunner::RecordsOf(std::size_t cell) const {
  // Absolute: a solver may leave its cell's process in another folder.
  const BenchFolder folder{std::filesystem::absolute(folder_.path)};
  return folder.records(keys_[cell], InstanceKey(suite_, cells_[cell]));
}

void BenchRunner::TakeOver(const std::string& line) {
  nlohmann::json row = nlohmann::json::parse(line, nullptr, /*allow_exceptions=*/false);
  if (!IsFinishedRow(row)) return;  // ReadBenchData() says so
  const std::string key = row["key"];
  const auto cell = wanted_.find(key);
  if (cell == wanted_.end() || !HasRecords(row, RecordsOf(cell->second))) return;
  rows_[key] = std::move(row);
}

bool BenchRunner::Open(std::string* error) {
  for (const char* name : {"traces", "iterates", "curves", "logs"}) {
    if (!CreateDirectories(folder_ / name, error)) return false;
  }
  const auto ReadInstance = [this](const std::string& line) {
    nlohmann::json instance = nlohmann::json::parse(line, nullptr, /*allow_exceptions=*/false);
    if (!instance.is_object() || !instance.contains("key") || !instance["key"].is_string()) return;
    const std::string key = instance["key"];
    instances_[key] = std::move(instance);
  };
  if (!cell_file_.Open(
          folder_ / "cells.jsonl", [this](const std::string& line) { TakeOver(line); }, error) ||
      !instance_file_.Open(folder_ / "instances.jsonl", ReadInstance, error)) {
    return false;
  }
  num_taken_over_ = rows_.size();
  return true;
}

bool BenchRunner::Run(const Progress& progress, std::string* error) {
  if (!MeasureInstances(progress, error)) return false;
  started_ = Now();
  finished_at_start_ = rows_.size();
  next_ = 0;
  std::vector<Running> running;
  while (!InterruptRequested()) {
    while (running.size() < static_cast<std::size_t>(jobs_) && next_ < cells_.size()) {
      if (!StartNext(&running, error)) return false;
    }
    if (running.empty()) break;
    if (!Attend(&running, progress, error)) return false;
  }
  return cell_file_.Sync(error);
}

bool BenchRunner::MeasureInstances(const Progress& progress, std::string* error) {
  std::map<std::string, const BenchCell*> missing;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const std::string key = InstanceKey(suite_, cells_[i]);
    const auto measured = instances_.find(key);
    if (measured == instances_.end() || !IsMeasured(measured->second)) missing[key] = &cells_[i];
  }
  int done = 0;
  for (const auto& [key, cell] : missing) {
    if (InterruptRequested()) return true;
    if (progress) {
      progress(done++, static_cast<int>(missing.size()), std::nan(""),
               "work unit of " + suite_.problems[cell->problem].label);
    }
    if (!MeasureOne(*cell, key, error)) return false;
  }
  return instance_file_.Sync(error);
}

bool BenchRunner::MeasureOne(const BenchCell& cell, const std::string& key, std::string* error) {
  const auto process = ChildProcess::Start(
      LimitsOf(suite_), "/dev/null", [&] { return MeasureInstance(suite_, cell); }, error);
  if (process == nullptr) return false;
  constexpr int kInterval = 100;  // milliseconds
  bool overlapped = false;
  for (bool ended = false; !ended;) {
    if (InterruptRequested()) return true;
    overlapped = overlapped || machine_.OthersMeasure();
    pollfd file = {process->file(), POLLIN, 0};
    poll(&file, 1, kInterval);
    ended = process->Attend();
  }
  ChildEnd end = process->Finish();
  Json instance = Json::parse(end.answer, nullptr, /*allow_exceptions=*/false);
  if (!instance.is_object()) {
    instance = {{"format", "batten.instance/1"},
                {"problem", suite_.problems[cell.problem].label},
                {"failure", end.message}};
  }
  instance["overlapped"] = overlapped || machine_.OthersMeasure();
  instance["key"] = key;
  const std::string line = DumpJson(instance, -1);
  if (!instance_file_.Append(line, error)) return false;
  instances_[key] = nlohmann::json::parse(line);
  return true;
}

bool BenchRunner::StartNext(std::vector<Running>* running, std::string* error) {
  const std::size_t cell = next_++;
  const std::string& key = keys_[cell];
  if (rows_.count(key) > 0) return true;
  Running started;
  started.cell = cell;
  started.overlapped = jobs_ > 1;
  started.process = ChildProcess::Start(
      LimitsOf(suite_), folder_.log(key),
      [&] { return RunBenchCell(suite_, cells_[cell], RecordsOf(cell)); }, error);
  if (started.process == nullptr) return false;
  running->push_back(std::move(started));
  return true;
}

/// Before each wait and behind it: who measured in between for longer than a wait is seen.
void BenchRunner::LookForOthers(std::vector<Running>* running) const {
  if (!machine_.OthersMeasure()) return;
  for (Running& one : *running) one.overlapped = true;
}

bool BenchRunner::Attend(std::vector<Running>* running, const Progress& progress,
                         std::string* error) {
  Tell(progress, *running);
  LookForOthers(running);
  if (!cell_file_.SyncWhenDue(error)) return false;
  constexpr double kLongest = 0.1;  // seconds; interrupts and progress are looked at in between
  double wait = kLongest;
  std::vector<pollfd> files;
  for (const Running& one : *running) {
    files.push_back({one.process->file(), POLLIN, 0});
    wait = std::min(wait, std::max(0.0, one.process->seconds_left()));
  }
  poll(files.data(), files.size(), static_cast<int>(std::ceil(1e3 * wait)));
  LookForOthers(running);
  for (std::size_t i = 0; i < running->size();) {
    if (!(*running)[i].process->Attend()) {
      ++i;
      continue;
    }
    const Running ended = std::move((*running)[i]);
    running->erase(running->begin() + static_cast<std::ptrdiff_t>(i));
    if (!FinishCell(ended, ended.process->Finish(), error)) return false;
  }
  return true;
}

std::string BenchRunner::MessageOf(const ChildEnd& end, const std::string& log) const {
  const std::string said = end.how == ChildEnd::How::kCrashed ? LastLineOfLog(log) : "";
  return said.empty() ? end.message : end.message + "; its log ends with: " + said;
}

bool BenchRunner::FinishCell(const Running& ended, ChildEnd end, std::string* error) {
  const BenchCell& cell = cells_[ended.cell];
  const std::string& key = keys_[ended.cell];
  const std::string log = folder_.log(key);
  if (end.answer.rfind(kCannotWrite, 0) == 0) {
    *error = end.answer;
    return false;
  }
  Json row = Json::parse(end.answer, nullptr, /*allow_exceptions=*/false);
  if (end.how == ChildEnd::How::kAnswered && !row.is_object()) {
    end.how = ChildEnd::How::kCrashed;
    end.message = "gave no row";
  }
  end.message = MessageOf(end, log);
  if (end.how != ChildEnd::How::kAnswered) row = FailedRow(suite_, cell, end);
  // One that ended because the program was told to end is not finished.
  if (row["stop"] == "interrupted") return true;
  std::error_code ignored;
  const bool has_log = std::filesystem::file_size(log, ignored) > 0 && !ignored;
  if (!has_log) std::filesystem::remove(log, ignored);
  row["overlapped"] = ended.overlapped;
  row["process_seconds"] = end.wall_seconds;
  row["process_cpu_seconds"] = end.cpu_seconds;
  row["peak_memory_mb"] = static_cast<double>(end.peak_memory_kb) / 1024.0;
  row["log"] = has_log ? Json("logs/" + key + ".log") : Json();
  row["instance"] = InstanceKey(suite_, cell);
  row["key"] = key;
  const std::string line = DumpJson(row, -1);
  if (!cell_file_.Append(line, error)) return false;
  rows_[key] = nlohmann::json::parse(line);
  return true;
}

void BenchRunner::Tell(const Progress& progress, const std::vector<Running>& running) const {
  if (!progress || running.empty()) return;
  const auto done = rows_.size();
  const auto new_ones = static_cast<double>(done - finished_at_start_);
  const double left =
      new_ones > 0.0 ? (Now() - started_) / new_ones * static_cast<double>(cells_.size() - done)
                     : std::nan("");
  progress(static_cast<int>(done), static_cast<int>(cells_.size()), left,
           CellText(suite_, cells_[running.front().cell]));
}

std::vector<const nlohmann::json*> BenchRunner::Rows() const {
  std::vector<const nlohmann::json*> rows;
  for (const std::string& key : keys_) {
    const auto found = rows_.find(key);
    rows.push_back(found == rows_.end() ? nullptr : &found->second);
  }
  return rows;
}

}  // namespace batten
