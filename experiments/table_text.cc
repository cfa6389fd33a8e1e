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

}  // namespace batten
