#ifndef BATTEN_EXPERIMENTS_TABLE_TEXT_H_
#define BATTEN_EXPERIMENTS_TABLE_TEXT_H_

#include <string>
#include <vector>

#include "experiments/csv_table.h"

namespace batten {

// Text as it stands in tables of documents, on one line.

std::string MarkdownText(const std::string& text);
std::string LatexText(const std::string& text);
/// 1.2e-10 as a power of ten; what is no such number as LatexText().
std::string LatexNumber(const std::string& text);

std::string TableMarkdown(const CsvTable& table);
/// Floats that fit on a page each: one for each of the texts that the columns `by` have together,
/// which its caption names behind `caption`, and of its rows kMostLatexRows at most. They show the
/// columns `shown` but those without a text in any row of `table`. Needs \usepackage{booktabs}.
std::string TablesLatex(const CsvTable& table, const std::string& caption,
                        const std::vector<std::string>& by, const std::vector<std::string>& shown);
inline constexpr std::size_t kMostLatexRows = 50;

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_TABLE_TEXT_H_
