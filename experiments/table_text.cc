#include "experiments/table_text.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>
#include <vector>

#include "cost_functions/options.h"

namespace batten {
namespace {

std::string Replaced(const std::string& text,
                     const std::vector<std::pair<char, std::string>>& replacements) {
  std::string result;
  for (const char c : text) {
    const auto found = std::find_if(replacements.begin(), replacements.end(),
                                    [c](const auto& pair) { return pair.first == c; });
    result += found == replacements.end() ? std::string(1, c) : found->second;
  }
  return result;
}

/// Numbers to the right, words to the left.
char AlignmentOf(const CsvTable& table, const std::string& column) {
  double ignored = 0.0;
  for (std::size_t row = 0; row < table.num_rows(); ++row) {
    const std::string& text = table.Text(row, column);
    if (!text.empty() && !ParseNumber(text, &ignored)) return 'l';
  }
  return 'r';
}

/// `alignment`: a letter for each of `columns`.
std::string LatexFloat(const CsvTable& table, const std::vector<std::string>& columns,
                       const std::string& alignment, const std::vector<std::size_t>& rows,
                       const std::string& caption) {
  std::string text =
      "\\begin{table*}\n\\centering\\scriptsize\\setlength{\\tabcolsep}{3pt}\n\\caption{" +
      LatexText(caption) + "}\n\\begin{tabular}{" + alignment + "}\n\\toprule\n";
  for (const std::string& column : columns) {
    text += (&column == &columns.front() ? "" : " & ") + LatexText(column);
  }
  text += " \\\\\n\\midrule\n";
  for (const std::size_t row : rows) {
    for (const std::string& column : columns) {
      text += (&column == &columns.front() ? "" : " & ") + LatexNumber(table.Text(row, column));
    }
    text += " \\\\\n";
  }
  return text + "\\bottomrule\n\\end{tabular}\n\\end{table*}\n";
}

}  // namespace

std::string MarkdownText(const std::string& text) {
  return Replaced(text, {{'|', "\\|"},
                         {'\\', "\\\\"},
                         {'<', "&lt;"},
                         {'*', "\\*"},
                         {'`', "\\`"},
                         {'\n', " "},
                         {'\r', " "}});
}

std::string LatexText(const std::string& text) {
  return Replaced(text, {{'\\', "\\textbackslash{}"},
                         {'_', "\\_"},
                         {'&', "\\&"},
                         {'%', "\\%"},
                         {'#', "\\#"},
                         {'$', "\\$"},
                         {'{', "\\{"},
                         {'}', "\\}"},
                         {'^', "\\textasciicircum{}"},
                         {'~', "\\textasciitilde{}"},
                         {'|', "\\textbar{}"},
                         {'<', "\\textless{}"},
                         {'>', "\\textgreater{}"},
                         {'\n', " "},
                         {'\r', " "}});
}

std::string LatexNumber(const std::string& text) {
  const std::size_t exponent = text.find('e');
  double value = 0.0;
  if (exponent == std::string::npos || !ParseNumber(text, &value)) return LatexText(text);
  return "$" + text.substr(0, exponent) + "\\cdot10^{" +
         std::to_string(std::stoi(text.substr(exponent + 1))) + "}$";
}

std::string TableMarkdown(const CsvTable& table) {
  std::string text = "|", rule = "|";
  for (const std::string& column : table.columns()) {
    text += " " + MarkdownText(column) + " |";
    rule += " --- |";
  }
  text += "\n" + rule + "\n";
  for (std::size_t row = 0; row < table.num_rows(); ++row) {
    text += "|";
    for (const std::string& column : table.columns()) {
      text += " " + MarkdownText(table.Text(row, column)) + " |";
    }
    text += "\n";
  }
  return text;
}

std::string TablesLatex(const CsvTable& table, const std::string& caption,
                        const std::vector<std::string>& by, const std::vector<std::string>& shown) {
  std::vector<std::string> columns;
  std::copy_if(shown.begin(), shown.end(), std::back_inserter(columns), [&](const auto& column) {
    const std::vector<std::string> texts = table.Distinct(column);
    return std::any_of(texts.begin(), texts.end(), [](const auto& text) { return !text.empty(); });
  });
  std::string alignment;
  for (const std::string& column : columns) alignment += AlignmentOf(table, column);
  // In the order of their first rows.
  std::vector<std::string> names;
  std::map<std::string, std::vector<std::size_t>> rows_of;
  for (std::size_t row = 0; row < table.num_rows(); ++row) {
    std::string name;
    for (const std::string& column : by) {
      const std::string& text = table.Text(row, column);
      if (!text.empty()) name += (name.empty() ? "" : ", ") + column + " " + text;
    }
    std::vector<std::size_t>& rows = rows_of[name];
    if (rows.empty()) names.push_back(name);
    rows.push_back(row);
  }
  std::string text = "% Needs \\usepackage{booktabs}.\n";
  // LaTeX holds back no more than 18 floats.
  constexpr int kMostHeld = 10;
  int num_floats = 0;
  for (const std::string& name : names) {
    const std::vector<std::size_t>& rows = rows_of[name];
    for (std::size_t begin = 0; begin < rows.size(); begin += kMostLatexRows) {
      if (num_floats > 0 && num_floats % kMostHeld == 0) text += "\\clearpage\n";
      ++num_floats;
      const std::string of = (name.empty() ? "" : ": " + name) + (begin > 0 ? ", continued" : "");
      text += LatexFloat(table, columns, alignment,
                         {rows.begin() + static_cast<std::ptrdiff_t>(begin),
                          rows.begin() + static_cast<std::ptrdiff_t>(
                                             std::min(begin + kMostLatexRows, rows.size()))},
                         caption + of);
    }
  }
  return text;
}

}  // namespace batten
