#ifndef BATTEN_EXPERIMENTS_TABLE_TEXT_H_
#define BATTEN_EXPERIMENTS_TABLE_TEXT_H_

#include <string>

#include "experiments/csv_table.h"

namespace batten {

// Text as it stands in tables of documents, on one line.

std::string MarkdownText(const std::string& text);
std::string LatexText(const std::string& text);
/// 1.2e-10 as a power of ten; what is no such number as LatexText().
std::string LatexNumber(const std::string& text);

std::string TableMarkdown(const CsvTable& table);
/// A table environment; needs \usepackage{booktabs}.
std::string TableLatex(const CsvTable& table, const std::string& caption);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_TABLE_TEXT_H_
