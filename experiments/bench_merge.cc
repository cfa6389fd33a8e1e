#include "experiments/bench_merge.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "experiments/atomic_file.h"
#include "experiments/bench_data.h"
#include "experiments/bench_store.h"
#include "experiments/comparison_records.h"

namespace batten {
namespace {

namespace fs = std::filesystem;

bool AreAlike(const BenchData& a, const BenchData& b, std::string* error) {
  for (const auto& [key, what] : {std::pair{"suite_hash", "another suite"},
                                  {"program_hash", "another program"},
                                  {"flags", "other compiler flags"}}) {
    if (TextAt(a.manifest, key) == TextAt(b.manifest, key)) continue;
    *error = b.folder + ": found " + what + " than in " + a.folder +
             "; allowed: parts of one suite run by one program";
    return false;
  }
  return true;
}

bool CopyFile(const std::string& from, const std::string& to, std::string* error) {
  std::error_code failure;
  if (!fs::exists(from, failure)) return true;
  fs::copy_file(from, to, fs::copy_options::overwrite_existing, failure);
  if (failure) *error = "cannot write " + to + ": " + failure.message();
  return !failure;
}

/// All that rows say is there before the rows themselves.
bool CopyCellFiles(const BenchData& data, const nlohmann::json& row, const std::string& out,
                   std::string* error) {
  const std::string key = TextAt(row, "key");
  for (const std::string& name :
       {"/traces/" + key + ".csv", "/iterates/" + key + ".jsonl",
        "/curves/" + TextAt(row, "instance") + ".json", "/logs/" + key + ".log"}) {
    if (!CopyFile(data.folder + name, out + name, error)) return false;
  }
  return true;
}

bool MergeManifests(const std::string& out, const std::vector<BenchData>& parts,
                    std::string* error) {
  nlohmann::json manifest = parts[0].manifest;
  nlohmann::json sessions = nlohmann::json::array();
  for (const BenchData& part : parts) {
    const auto found = part.manifest.find("sessions");
    if (found == part.manifest.end() || !found->is_array()) continue;
    for (const nlohmann::json& session : *found) {
      // Those of a part that was merged before are there already.
      const bool is_there = std::find(sessions.begin(), sessions.end(), session) != sessions.end();
      if (!is_there) sessions.push_back(session);
    }
  }
  manifest["sessions"] = std::move(sessions);
  return WriteFileAtomically(
      out + "/manifest.json",
      manifest.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n", error);
}

/// Appends what is not there yet.
class Merger {
 public:
  explicit Merger(std::string out) : out_(std::move(out)) {}

  bool Open(std::string* error) {
    for (const char* folder : {"", "/traces", "/iterates", "/curves", "/logs"}) {
      if (!CreateDirectories(out_ + folder, error)) return false;
    }
    const auto NoteCell = [this](const std::string& line) {
      const nlohmann::json json = nlohmann::json::parse(line, nullptr, false);
      if (!TextAt(json, "key").empty()) cell_keys_.insert(TextAt(json, "key"));
    };
    const auto NoteInstance = [this](const std::string& line) {
      const nlohmann::json json = nlohmann::json::parse(line, nullptr, false);
      if (!TextAt(json, "key").empty()) instance_keys_[TextAt(json, "key")] = IsMeasured(json);
    };
    return cells_.Open(out_ + "/cells.jsonl", NoteCell, error) &&
           instances_.Open(out_ + "/instances.jsonl", NoteInstance, error);
  }

  bool Add(const BenchData& data, MergeReport* report, std::string* error) {
    for (const auto& [key, instance] : data.instances) {
      // One that is measured takes the place of one that is not: the last line counts.
      const auto [place, is_new] = instance_keys_.emplace(key, IsMeasured(instance));
      if (!is_new && (place->second || !IsMeasured(instance))) continue;
      place->second = IsMeasured(instance);
      if (!instances_.Append(instance.dump(), error)) return false;
    }
    for (const nlohmann::json& row : data.rows) {
      const std::string key = TextAt(row, "key");
      if (!cell_keys_.insert(key).second) {
        ++report->duplicates;
        continue;
      }
      if (!CopyCellFiles(data, row, out_, error) || !cells_.Append(row.dump(), error)) return false;
    }
    return true;
  }

  bool Sync(std::string* error) { return cells_.Sync(error) && instances_.Sync(error); }

 private:
  std::string out_;
  AppendOnlyFile cells_;
  AppendOnlyFile instances_;
  std::set<std::string> cell_keys_;
  std::map<std::string, bool> instance_keys_;  // and whether it is measured
};

}  // namespace

bool MergeBenches(const std::string& out, const std::vector<std::string>& folders,
                  MergeReport* report, std::string* error) {
  std::vector<BenchData> parts;
  std::error_code ignored;
  // What is in OUT already counts as its first part.
  if (fs::exists(out + "/manifest.json", ignored)) {
    parts.emplace_back();
    if (!ReadBenchData(out, &parts.back(), error)) return false;
  }
  const bool has_own = !parts.empty();
  for (const std::string& folder : folders) {
    if (fs::equivalent(folder, out, ignored)) {
      *error = folder + ": found the folder to merge into; allowed: others";
      return false;
    }
    parts.emplace_back();
    if (!ReadBenchData(folder, &parts.back(), error)) return false;
    if (!AreAlike(parts.front(), parts.back(), error)) return false;
    const std::vector<std::string>& bad = parts.back().bad_lines;
    report->bad_lines.insert(report->bad_lines.end(), bad.begin(), bad.end());
  }
  Merger merger(out);
  if (!merger.Open(error)) return false;
  for (std::size_t k = has_own ? 1 : 0; k < parts.size(); ++k) {
    if (!merger.Add(parts[k], report, error)) return false;
  }
  if (!merger.Sync(error) || !MergeManifests(out, parts, error) ||
      !CopyFile(parts.back().folder + "/suite.json", out + "/suite.json", error)) {
    return false;
  }
  BenchData merged;
  if (!ReadBenchData(out, &merged, error)) return false;
  report->cells = static_cast<int>(merged.rows.size());
  report->missing = static_cast<int>(merged.num_cells - merged.rows.size());
  return true;
}

}  // namespace batten
