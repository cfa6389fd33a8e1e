#include <gflags/gflags.h>

#include "experiments/bench_merge.h"
#include "tools/bench_output.h"
#include "tools/command.h"

DECLARE_bool(strict);
DECLARE_bool(figures);

namespace batten {
namespace {

int RunMerge(const std::vector<std::string>& positional, CommandOutput* output) {
  if (positional.size() < 2) {
    return Refuse("merge: found " + std::to_string(positional.size()) +
                      " folders; allowed: the one to merge into, then at least one part",
                  output);
  }
  MergeReport report;
  const std::vector<std::string> parts(positional.begin() + 1, positional.end());
  if (!MergeBenches(positional[0], parts, &report, &output->error)) return kBadInput;
  const int status = WriteBenchResults(positional[0], FLAGS_figures, FLAGS_strict, output);
  std::string bad_lines;
  for (const std::string& bad : report.bad_lines) bad_lines += bad + "\n";
  output->results = bad_lines + std::to_string(report.cells) + " cells, " +
                    std::to_string(report.missing) + " missing, " +
                    std::to_string(report.duplicates) + " that were there more than once\n" +
                    output->results;
  return status;
}

}  // namespace

Command MergeCommand() {
  Command command;
  command.name = "merge";
  command.arguments = "OUT PART...";
  command.summary = "puts parts of a benchmark, run on several machines, into one folder";
  command.details = {
      "The parts are folders of batten bench --shard=I/N, of one suite and one program. OUT is "
      "created if missing and keeps what it has; then its tables and figures are made anew. "
      "Merging twice changes nothing."};
  command.examples = {"batten merge out/bench out/part_1 out/part_2 out/part_3"};
  for (const char* name : {"figures", "strict"}) command.flags.push_back(SwitchFlag(name));
  command.run = &RunMerge;
  return command;
}

}  // namespace batten
