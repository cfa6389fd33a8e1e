#include <gflags/gflags.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "experiments/atomic_file.h"
#include "experiments/bench_manifest.h"
#include "experiments/bench_runner.h"
#include "problems/input_file.h"
#include "tools/bench_output.h"
#include "tools/command.h"
#include "tools/interrupts.h"
#include "tools/output_files.h"
#include "tools/progress.h"
#include "tools/run_flags.h"

DEFINE_bool(dry_run, false, "Print the matrix, and run nothing.");
DEFINE_int32(jobs, 1,
             "Cells at once. With more than one their times disturb each other: they are marked, "
             "and left out of tables and figures of time.");
DEFINE_string(shard, "1/1",
              "Of the matrix, part I of N, as I/N: every N-th instance with all its solvers. The "
              "folders of all parts are put together by batten merge.");
DECLARE_bool(strict);
DECLARE_bool(figures);

namespace batten {
namespace {

constexpr int kMostShards = 100'000;

bool ParseShard(const std::string& text, BenchSession* session) {
  const std::size_t slash = text.find('/');
  double shard = 0.0, count = 0.0;
  if (slash == std::string::npos || !ParseNumber(text.substr(0, slash), &shard) ||
      !ParseNumber(text.substr(slash + 1), &count)) {
    return false;
  }
  const bool whole = shard == std::trunc(shard) && count == std::trunc(count);
  if (!whole || count < 1 || count > kMostShards || shard < 1 || shard > count) return false;
  session->shard = static_cast<int>(shard);
  session->num_shards = static_cast<int>(count);
  return true;
}

std::string MatrixText(const BenchSuite& suite, const std::vector<BenchCell>& cells) {
  std::string text;
  for (const BenchCell& cell : cells) text += CellText(suite, cell) + "\n";
  for (const std::string& left_out : RepeatedTerms(suite)) text += left_out + "\n";
  int instances = 0;
  std::vector<int> seen;
  for (const BenchCell& cell : cells) seen.push_back(cell.instance);
  std::sort(seen.begin(), seen.end());
  instances = static_cast<int>(std::unique(seen.begin(), seen.end()) - seen.begin());
  return text + std::to_string(cells.size()) + " cells: " + std::to_string(instances) +
         " instances, " + std::to_string(suite.solvers.size()) + " solvers, " +
         std::to_string(suite.repetitions) + " repetitions\n";
}

std::string TimeText(double seconds) {
  if (!std::isfinite(seconds)) return "";
  const auto whole = static_cast<long>(std::lround(seconds));
  if (whole < 60) return ", " + std::to_string(whole) + " s left";
  if (whole < 3600) return ", " + std::to_string(whole / 60) + " min left";
  return ", " + std::to_string(whole / 3600) + " h " + std::to_string(whole / 60 % 60) +
         " min left";
}

BenchRunner::Progress Shown(Progress* progress) {
  return [progress](int done, int total, double left, const std::string& running) {
    if (!progress->IsDue()) return;
    progress->Show(
        static_cast<double>(done) / total,
        std::to_string(done) + " / " + std::to_string(total) + TimeText(left) + ", " + running);
  };
}

/// Of a folder that holds another suite's results; else empty.
std::string OtherSuiteText(const BenchSuite& suite) {
  std::ifstream file(FLAGS_out + "/manifest.json");
  const auto manifest = nlohmann::json::parse(file, nullptr, /*allow_exceptions=*/false);
  if (!manifest.is_object() || !manifest.contains("suite") || !manifest["suite"].is_string()) {
    return "";
  }
  const std::string before = manifest["suite"];
  if (before == suite.name) return "";
  return FLAGS_out + " held results of the suite " + before + "; its tables are now those of " +
         suite.name + ", its cells stay in cells.jsonl\n";
}

/// The suite as it was, beside its results. Made before anything runs.
bool PrepareFolder(const BenchSuite& suite, const BenchSession& session, std::string* error) {
  if (!CheckName({"out", FLAGS_out}, error)) return false;
  std::string text;
  if (!CreateDirectories(FLAGS_out, error)) {
    *error = "--out: " + *error;
    return false;
  }
  return ReadWholeFile(suite.path, &text, error) &&
         WriteFileAtomically(FLAGS_out + "/suite.json", text, error) &&
         WriteManifest(suite, session, FLAGS_out, error);
}

int RunSuite(const BenchSuite& suite, const std::vector<BenchCell>& cells, int jobs,
             const BenchSession& session, CommandOutput* output) {
  std::string* const error = &output->error;
  const std::string other_suite = OtherSuiteText(suite);
  BenchRunner runner(suite, cells, {FLAGS_out}, jobs);
  if (!PrepareFolder(suite, session, error) || !runner.Open(error)) return kBadInput;
  const InterruptibleRun interruptible;
  {
    Progress progress(FLAGS_quiet);
    if (!runner.Run(Shown(&progress), error)) return kBadInput;
  }
  const bool is_interrupted = InterruptRequested();
  const int status = WriteBenchResults(FLAGS_out, FLAGS_figures, FLAGS_strict, output);
  output->results += other_suite;
  if (is_interrupted) {
    *error = "interrupted after " + std::to_string(runner.num_finished()) + " of " +
             std::to_string(runner.num_cells()) + " cells; the same command goes on";
    return kInterruptedStatus;
  }
  return status;
}

int RunBench(const std::vector<std::string>& positional, CommandOutput* output) {
  if (positional.size() != 1) {
    return Refuse("bench: found " + std::to_string(positional.size()) +
                      " files; allowed: one suite, as in batten bench suite.json --out=out/bench",
                  output);
  }
  BenchSession session;
  session.jobs = FLAGS_jobs;
  if (!ParseShard(FLAGS_shard, &session)) {
    return Refuse(RefusedFlag("shard", FLAGS_shard, "I/N, as 2/8: part I of N, from 1 to N"),
                  output);
  }
  BenchSuite suite;
  if (!ReadBenchSuite(positional[0], &suite, &output->error)) return kBadInput;
  const std::vector<BenchCell> cells =
      ShardOf(BenchMatrix(suite), session.shard, session.num_shards);
  if (FLAGS_dry_run) {
    output->results = MatrixText(suite, cells);
    return kDone;
  }
  if (!WasGiven("out")) {
    return Refuse("bench: found no --out; allowed: --out=FOLDER, or --dry_run", output);
  }
  return RunSuite(suite, cells, FLAGS_jobs, session, output);
}

}  // namespace

Command BenchCommand() {
  Command command;
  command.name = "bench";
  command.arguments = "SUITE.json";
  command.summary = "runs a scripted benchmark, cell by cell, and makes its tables";
  command.details = {
      "A suite (docs/formats.md) names problems, terms, solvers with grids of options, seeds, "
      "targets and budgets. Each cell of the matrix runs in a process of its own, whose time and "
      "memory are limited: one that crashes or hangs is a row that says so.",
      "What is finished stays: the same command goes on where it was interrupted, killed or ran "
      "out of disk, and runs again only cells of which the program, a loaded plugin, the problem, "
      "the data or an option has changed."};
  command.examples = {"batten bench suite.json --dry_run",
                      "batten bench suite.json --out=out/bench",
                      "batten bench suite.json --out=out/part_2 --shard=2/8"};
  command.flags = {TextFlag("out", "FOLDER", "a folder", "Folder for results, created if missing."),
                   SwitchFlag("dry_run"), NumberFlag("jobs", "N", 1.0, 1024.0),
                   TextFlag("shard", "I/N", "I/N, as 2/8")};
  for (const char* name : {"figures", "strict", "quiet"}) {
    command.flags.push_back(SwitchFlag(name));
  }
  command.run = &RunBench;
  return command;
}

}  // namespace batten
