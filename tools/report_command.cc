#include <gflags/gflags_declare.h>

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/atomic_file.h"
#include "experiments/report_document.h"
#include "tools/command.h"
#include "tools/output_files.h"
#include "tools/report_page.h"

DECLARE_string(out);

namespace batten {
namespace {

int RunReport(const std::vector<std::string>& positional, CommandOutput* output) {
  if (positional.size() != 1) {
    return Refuse("report: found " + std::to_string(positional.size()) +
                      " folders; allowed: one, as in batten report out/compare",
                  output);
  }
  const std::string& folder = positional.front();
  const std::string file =
      WasGiven("out") ? FLAGS_out : (std::filesystem::path(folder) / "report.html").string();
  ReportDocument document;
  if (!ReadReportDocument(folder, ReportLimits(), &document, &output->error)) return kBadInput;
  const std::vector<std::string> inputs = {
      (std::filesystem::path(folder) / "cells.jsonl").string(),
      (std::filesystem::path(folder) / "manifest.json").string()};
  if (!CheckOutputs({{"out", file}}, inputs, &output->error)) return kBadInput;
  if (!WriteFileAtomically(file, ReportPage(document), &output->error)) return kBadInput;
  output->results = "Page: " + file + "  (" + std::to_string(document.num_cells) + " rows)\n";
  return kDone;
}

}  // namespace

Command ReportCommand() {
  Command command;
  command.name = "report";
  command.arguments = "FOLDER";
  command.summary = "turns a folder of results into one interactive page";
  command.details = {
      "Reads what compare, bench or reproduce has written into FOLDER: rows, traces, iterates, "
      "logs, "
      "tables, pictures. Writes one HTML file that needs no network and no other file: filters, "
      "plots that zoom and show values, a player of the curves, failures, audits; data, SVG and "
      "PNG of each plot. Traces and iterates are thinned in it. docs/report.md has the details."};
  command.examples = {
      "batten compare --problems=rhino,cat --solvers=lbfgs,cg,lspia --keep_iterates=40 "
      "--out=out/compare",
      "batten report out/compare"};
  command.flags = {TextFlag("out", "FILE", "a file", "The page. Not given: FOLDER/report.html.")};
  command.run = &RunReport;
  return command;
}

}  // namespace batten
