#include <gflags/gflags.h>

#include "experiments/regression.h"
#include "experiments/short_number.h"
#include "tools/command.h"

DEFINE_double(slowdown, batten::RegressionRule().slowdown,
              "A median ratio of costs above 1 by more than this is slower, if it is significant.");
DEFINE_double(significance, batten::RegressionRule().significance,
              "Largest p, after Holm's correction, of a difference that is no chance.");

namespace batten {
namespace {

std::string ReportText(const RegressionReport& report) {
  std::string text = std::to_string(report.matched) + " runs in both\n";
  for (std::size_t row = 0; row < report.tests.num_rows(); ++row) {
    text += report.tests.Text(row, "solver") + ": " + report.tests.Text(row, "cost") + " times " +
            ShortNumber(report.tests.Number(row, "median_ratio"), 3) + ", " +
            report.tests.Text(row, "cells") +
            " cells differ, p = " + ShortNumber(report.tests.Number(row, "p_corrected"), 2) + "\n";
  }
  for (const std::string& sentence : report.differences) {
    text += "differs: " + OneLine(sentence) + "\n";
  }
  for (const std::string& sentence : report.regressions) {
    text += "WORSE: " + OneLine(sentence) + "\n";
  }
  return text;
}

int RunRegress(const std::vector<std::string>& positional, CommandOutput* output) {
  if (positional.size() != 2) {
    return Refuse("regress: found " + std::to_string(positional.size()) +
                      " folders; allowed: two, the results before and those now",
                  output);
  }
  BenchData before, now;
  if (!ReadBenchData(positional[0], &before, &output->error) ||
      !ReadBenchData(positional[1], &now, &output->error)) {
    return kBadInput;
  }
  RegressionRule rule;
  rule.slowdown = FLAGS_slowdown;
  rule.significance = FLAGS_significance;
  const RegressionReport report =
      FindRegressions(before, CollectResults(before), now, CollectResults(now), rule);
  if (report.matched == 0) {
    return Refuse(
        "regress: found no run that both folders have; allowed: results of suites that "
        "share problems, terms and solvers",
        output);
  }
  for (const BenchData* data : {&before, &now}) {
    for (const std::string& bad : data->bad_lines) output->results += bad + "\n";
  }
  output->results += ReportText(report);
  if (report.regressions.empty()) return kDone;
  output->error = std::to_string(report.regressions.size()) +
                  " regressions, the first: " + report.regressions.front();
  return kRegression;
}

}  // namespace

Command RegressCommand() {
  Command command;
  command.name = "regress";
  command.arguments = "BEFORE NOW";
  command.summary = "tells whether a benchmark got worse";
  command.details = {
      "Compares two folders of batten bench, run by run. Worse is: a run that reached what was "
      "asked and no longer does, an end of higher energy, and more evaluations or seconds of one "
      "solver or of all, by Wilcoxon's signed-rank test of the paired ratios. Times are compared "
      "of cells that did not overlap, and divided by how much longer a fixed piece of arithmetic "
      "took; take both from one quiet machine.",
      "Exit status 4: it got worse."};
  command.examples = {"batten regress out/before out/now",
                      "batten regress out/before out/now --slowdown=0.2"};
  command.flags = {NumberFlag("slowdown", "RATIO", 0.0, 100.0),
                   NumberAboveFlag("significance", "P", 0.0, 1.0)};
  command.run = &RunRegress;
  return command;
}

}  // namespace batten
