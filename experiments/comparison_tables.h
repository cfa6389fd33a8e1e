#ifndef BATTEN_EXPERIMENTS_COMPARISON_TABLES_H_
#define BATTEN_EXPERIMENTS_COMPARISON_TABLES_H_

#include <string>
#include <vector>

#include "experiments/comparison.h"

namespace batten {

// For people: numbers short. Rows in the order of the result, notes below.

/// At most 160 columns wide, ASCII.
std::string ComparisonText(const ComparisonResult& result);
std::string ComparisonMarkdown(const ComparisonResult& result);
/// A table environment; needs \usepackage{booktabs}.
std::string ComparisonLatex(const ComparisonResult& result);

/// What belongs below a table, one sentence each: the problems, the rule of the runs, what solvers
/// had to say ("rhino, gim: spectral radius of I - A 0.667, observed rate 0.666"), claims that
/// failed their audit, disagreements.
std::vector<std::string> ComparisonNotes(const ComparisonResult& result);

/// Of a catalogue's problem (as written in a list of them) whose parameters move: how far above or
/// below the best known energy `lowest`, at foot points, is. Empty where none is stated or `lowest`
/// is not finite.
std::string BesideBestKnown(const std::string& problem, double lowest);

// For programs: numbers read back to the same double; what is no finite number is null or empty.

/// One line per row; the fields of the JSON rows, `options` and `notes` as text.
std::string ComparisonCsv(const ComparisonResult& result);
/// {"format": "batten.comparison/1", "mode", ..., "rows": [...], "disagreements", "interrupted"}.
std::string ComparisonJson(const ComparisonResult& result);
/// Lines for cells.jsonl: one row each ("format": "batten.cell/1", docs/formats.md).
std::string ComparisonJsonLines(const ComparisonResult& result);

/// A claimed minimum or value of some row failed its audit.
bool SomeClaimFailed(const ComparisonResult& result);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_COMPARISON_TABLES_H_
