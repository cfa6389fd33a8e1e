#include "experiments/table_text.h"

#include <algorithm>
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

std::string TableLatex(const CsvTable& table, const std::string& caption) {
  std::string text = "% Needs \\usepackage{booktabs}.\n\\begin{table*}\n\\centering\\scriptsize\n";
  text += "\\caption{" + LatexText(caption) + "}\n\\begin{tabular}{" +
          std::string(table.columns().size(), 'l') + "}\n\\toprule\n";
  std::string line;
  for (const std::string& column : table.columns()) {
    line += (line.empty() ? "" : " & ") + LatexText(column);
  }
  text += line + " \\\\\n\\midrule\n";
  for (std::size_t row = 0; row < table.num_rows(); ++row) {
    line.clear();
    for (std::size_t c = 0; c < table.columns().size(); ++c) {
      line += (c > 0 ? " & " : "") + LatexNumber(table.Text(row, table.columns()[c]));
    }
    text += line + " \\\\\n";
  }
  return text + "\\bottomrule\n\\end{tabular}\n\\end{table*}\n";
}

}  // namespace batten
