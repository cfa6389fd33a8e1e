#include "experiments/bench_manifest.h"

#include <ceres/version.h>
#include <sys/utsname.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>
#include <tuple>

#include "experiments/atomic_file.h"
#include "experiments/bench_matrix.h"
#include "experiments/build_info.h"
#include "experiments/comparison_records.h"
#include "experiments/content_hash.h"
#include "problems/input_file.h"
#include "solvers/plugin_loader.h"

namespace batten {
namespace {

using Json = nlohmann::ordered_json;

std::string ProcessorName() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos) {
      return line.substr(colon + 2);
    }
  }
  return "unknown";
}

std::string TimeNow() {
  char text[32];
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::strftime(text, sizeof(text), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

Json Versions() {
  const auto Joined = [](int a, int b, int c) {
    return std::to_string(a) + "." + std::to_string(b) + "." + std::to_string(c);
  };
  Json json;
  json["eigen"] = Joined(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION);
  json["ceres"] = CERES_VERSION_STRING;
  json["nlohmann_json"] =
      Joined(NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH);
#if defined(__GLIBC__)
  json["glibc"] = std::to_string(__GLIBC__) + "." + std::to_string(__GLIBC_MINOR__);
#endif
  return json;
}

std::string FileName(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

Json PluginJson(const LoadedPlugin& plugin) {
  Json names = Json::array();
  for (const PluginName& name : plugin.names) names.push_back(name.kind + " " + name.name);
  Json libraries = Json::array();
  for (const std::string& path : plugin.libraries) {
    libraries.push_back({{"file", FileName(path)}, {"sha256", Sha256OfFile(path)}});
  }
  return {{"file", FileName(plugin.path)},
          {"sha256", plugin.sha256},
          {"names", names},
          {"libraries", libraries}};
}

Json SessionJson(const BenchSession& session) {
  utsname system{};
  uname(&system);
  double load[3] = {};
  const bool has_load = getloadavg(load, 3) == 3;
  Json json;
  json["begun"] = TimeNow();
  json["jobs"] = session.jobs;
  json["shard"] = std::to_string(session.shard) + "/" + std::to_string(session.num_shards);
  json["processor"] = ProcessorName();
  json["processors"] = std::thread::hardware_concurrency();
  json["system"] = std::string(system.sysname) + " " + system.release + " " + system.machine;
  json["load"] = has_load ? Json({load[0], load[1], load[2]}) : Json();
  return json;
}

/// Keys of all cells, whatever the shard, in the order of the suite: what tables are made of.
std::vector<std::string> OrderedKeys(const BenchSuite& suite) {
  BenchSuite ordered = suite;
  ordered.shuffled = false;
  std::vector<BenchCell> cells = BenchMatrix(ordered);
  std::stable_sort(cells.begin(), cells.end(), [](const BenchCell& a, const BenchCell& b) {
    return std::tie(a.instance, a.solver, a.seeds.solver) <
           std::tie(b.instance, b.solver, b.seeds.solver);
  });
  std::vector<std::string> keys;
  for (const BenchCell& cell : cells) keys.push_back(BenchCellKey(suite, cell));
  return keys;
}

}  // namespace

bool WriteManifest(const BenchSuite& suite, const BenchSession& session, const std::string& folder,
                   std::string* error) {
  const std::string path = folder + "/manifest.json";
  std::string before;
  std::string ignored;
  Json sessions = Json::array();
  if (ReadWholeFile(path, &before, &ignored)) {
    const Json read = Json::parse(before, nullptr, /*allow_exceptions=*/false);
    if (read.is_object() && read.contains("sessions") && read["sessions"].is_array()) {
      sessions = read["sessions"];
    }
  }
  sessions.push_back(SessionJson(session));
  Json json;
  json["format"] = "batten.manifest/1";
  json["suite"] = suite.name;
  json["suite_hash"] = SuiteHash(suite);
  json["gap_targets"] = suite.gap_targets;
  json["cells"] = OrderedKeys(suite);
  json["repeated_terms"] = RepeatedTerms(suite);
  json["program_hash"] = ProgramDigits();
  json["version"] = kVersion;
  json["commit"] = kGitCommit;
  json["compiler"] = kCompiler;
  json["flags"] = kFlags;
  json["libraries"] = Versions();
  json["plugins"] = Json::array();
  for (const LoadedPlugin& plugin : LoadedPlugins()) json["plugins"].push_back(PluginJson(plugin));
  json["sessions"] = std::move(sessions);
  return WriteFileAtomically(path, DumpJson(json, 1) + "\n", error);
}

}  // namespace batten
