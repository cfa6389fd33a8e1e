#include "tools/bench_output.h"

#include "cost_functions/options.h"
#include "experiments/bench_tables.h"
#include "experiments/short_number.h"

namespace batten {
namespace {

void AddRows(std::string head, const CsvTable& rows, std::string* text) {
  std::size_t width = head.size();
  for (std::size_t row = 0; row < rows.num_rows(); ++row) {
    width = std::max(width, rows.Text(row, "solver").size());
  }
  head.resize(width, ' ');
  *text += "\n" + head + "   solved  evaluations   work units     seconds\n";
  for (std::size_t row = 0; row < rows.num_rows(); ++row) {
    std::string line = rows.Text(row, "solver");
    line.resize(width, ' ');
    const auto Add = [&line](const std::string& cell, std::size_t columns) {
      line += std::string(columns > cell.size() ? columns - cell.size() : 1, ' ') + cell;
    };
    const double not_run = rows.Number(row, "not_run");
    Add(rows.Text(row, "solved") + "/" + NumberText(rows.Number(row, "instances") - not_run), 9);
    for (const char* column : {"evaluations", "work_units", "seconds"}) {
      Add(ShortNumber(rows.Number(row, column), 3), column[0] == 's' ? 12 : 13);
    }
    if (not_run > 0.0) line += "   " + NumberText(not_run) + " not run";
    *text += line + "\n";
  }
}

/// For the terminal: per target and kind of parameters, the solvers as they stand.
std::string Summary(const BenchResults& results) {
  const CsvTable table = SolverTable(results);
  std::string text = results.suite + ": " + std::to_string(results.num_finished) + " of " +
                     std::to_string(results.num_cells) + " cells\n";
  for (const BenchTarget& target : results.targets) {
    const CsvTable of_target = table.Where("target", target.label);
    for (const std::string& kind : of_target.Distinct("kind")) {
      AddRows(target.label + ", " + kind, of_target.Where("kind", kind), &text);
    }
  }
  return text;
}

std::string NotesText(const BenchResults& results) {
  constexpr std::size_t kMost = 20;
  std::string text;
  for (std::size_t k = 0; k < results.notes.size() && k < kMost; ++k) {
    text += OneLine(results.notes[k]) + "\n";
  }
  if (results.notes.size() > kMost) {
    text += "and " + std::to_string(results.notes.size() - kMost) + " more: notes.md\n";
  }
  return text.empty() ? "" : "\n" + text;
}

int Judge(const BenchResults& results, bool strict, CommandOutput* output) {
  if (results.some_claim_failed) {
    output->error =
        "a claim failed its audit, a solver disagrees with the direct answer, or a plugin has a "
        "fault: notes.md";
    return kDisagreement;
  }
  if (strict && results.some_failed) {
    output->error = "some run did not reach what was asked: table.csv";
    return kNotReached;
  }
  return kDone;
}

}  // namespace

int WriteBenchResults(const std::string& folder, bool figures, bool strict, CommandOutput* output) {
  BenchData data;
  if (!ReadBenchData(folder, &data, &output->error)) return kBadInput;
  const BenchResults results = CollectResults(data);
  FileBatch batch;
  if (!WriteBenchTables(results, folder, &batch, &output->error)) return kBadInput;
  std::string not_drawn;
  if (figures) {
    for (const FigureResult& figure : DrawBenchFigures(results, folder, &batch)) {
      if (IsWriteError(figure)) return Refuse(figure.message, output);
      if (figure.written && !figure.drawn) not_drawn = figure.message;
    }
  }
  if (!batch.Commit(&output->error)) return kBadInput;
  output->results = Summary(results) + NotesText(results) + "\nFiles in " + folder +
                    ": table, solvers and pairs (.csv, .md, .tex), notes.md, manifest.json, "
                    "cells.jsonl, traces" +
                    (figures ? ", figures (.svg)\n" : "\n");
  if (!not_drawn.empty()) return Refuse("--figures: " + not_drawn + ", or --nofigures", output);
  return Judge(results, strict, output);
}

}  // namespace batten
