#ifndef BATTEN_EXPERIMENTS_TABLE_TEXT_H_
#define BATTEN_EXPERIMENTS_TABLE_TEXT_H_

#include <string>

namespace batten {

/// `text` as one cell of a Markdown table.
std::string MarkdownText(const std::string& text);

/// `text` as LaTeX shows it.
std::string LatexText(const std::string& text);

/// A number as a cell of a LaTeX table, 1.2e-10 as a power of ten; other text as LatexText.
std::string LatexNumber(const std::string& text);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_TABLE_TEXT_H_
