#include "experiments/comparison_tables.h"

#include <algorithm>
#include <array>

#include "cost_functions/options.h"
#include "experiments/short_number.h"
#include "experiments/table_text.h"

namespace batten {
namespace {

struct Column {
  const char* top;  // two lines of the text table's header
  const char* bottom;
  const char* whole;
  const char* latex;
};

constexpr std::array<Column, 20> kColumns = {{
    {"", "problem", "problem", "problem"},
    {"", "solver", "solver", "solver"},
    {"claimed", "status", "status", "status"},
    {"veri-", "fied", "verified", "verified"},
    {"iter-", "ations", "iterations", "iterations"},
    {"E", "calls", "E calls", "$E$ calls"},
    {"g", "calls", "g calls", "$g$ calls"},
    {"J", "calls", "J calls", "$J$ calls"},
    {"prod-", "ucts", "products", "products"},
    {"set-up", "ms", "set-up ms", "set-up ms"},
    {"solve", "ms", "solve ms", "solve ms"},
    {"times", "cholesky", "times banded_cholesky", "$\\times$ Cholesky"},
    {"", "E", "E", "$E$"},
    {"", "|g|", "\\|g\\|", "$|g|$"},
    {"", "gap", "gap", "gap"},
    {"distance", "to direct", "distance to direct", "distance"},
    {"E at", "feet", "E at foot points", "$E$ at feet"},
    {"", "basin", "basin", "basin"},
    {"", "length", "length", "length"},
    {"free", "loops", "free loops", "loops"},
}};
constexpr std::size_t kNumNames = 2;  // problem, solver
constexpr std::size_t kFirstNumber = 4;
constexpr std::size_t kWidest = 160;  // of the text table

using Cells = std::vector<std::string>;

/// Below a microsecond the clock tells nothing.
std::string Milliseconds(double seconds) {
  return seconds < 1e-6 ? "<0.001" : ShortNumber(1e3 * seconds, 3);
}

/// Seven digits of an energy, by which solvers are told apart; of one that is rounding noise of the
/// start's, three.
std::string EnergyText(const RunResult& run) {
  constexpr double kNoise = 1e-12;
  return ShortNumber(run.energy, run.energy < kNoise * run.start_energy ? 3 : 7);
}

/// All columns of a row; of a skipped one the names and the reason.
Cells RowCells(const ComparisonRow& row) {
  const RunResult& run = row.run;
  if (!run.skipped.empty()) return {row.problem, row.solver, "skipped: " + run.skipped};
  const bool moves = row.parameter_kind != ParameterKind::kFixed;
  const std::optional<CurveShape>& shape = row.report.shape;
  const char* verified = !row.report.audited                ? "-"
                         : !row.report.verdict.holds        ? "NO"
                         : row.report.audit.covers_gradient ? "yes"
                                                            : "in part";
  return {row.problem,
          row.solver,
          ToString(run.outcome.reason),
          verified,
          std::to_string(run.iterations),
          std::to_string(run.counts.energy_calls),
          std::to_string(run.counts.gradient_calls),
          std::to_string(run.counts.jacobian_calls),
          std::to_string(run.counts.products),
          Milliseconds(row.setup_seconds),
          Milliseconds(row.solve_seconds),
          ShortNumber(row.times_cholesky, 3),
          EnergyText(run),
          ShortNumber(run.gradient_norm, 2),
          ShortNumber(row.gap, 2),
          ShortNumber(row.distance_to_direct, 2),
          moves ? ShortNumber(row.report.energy_at_foot_points, 7) : "-",
          row.basin.has_value() ? std::to_string(*row.basin) : "-",
          moves && shape.has_value() ? ShortNumber(shape->length, 4) : "-",
          moves && shape.has_value() ? std::to_string(shape->num_free_loops) : "-"};
}

/// The columns in which some row has a number, and the rows.
struct Table {
  std::vector<Column> columns;
  std::vector<Cells> rows;

  bool IsWhole(const Cells& row) const { return row.size() == columns.size(); }
};

Table MakeTable(const ComparisonResult& result) {
  std::vector<Cells> rows;
  for (const ComparisonRow& row : result.rows) rows.push_back(RowCells(row));
  Table table;
  table.rows.resize(rows.size());
  for (std::size_t c = 0; c < kColumns.size(); ++c) {
    const bool is_shown =
        c < kFirstNumber || std::any_of(rows.begin(), rows.end(), [c](const Cells& row) {
          return row.size() == kColumns.size() && row[c] != "-";
        });
    if (!is_shown) continue;
    table.columns.push_back(kColumns[c]);
    for (std::size_t r = 0; r < rows.size(); ++r) {
      if (c < rows[r].size()) table.rows[r].push_back(rows[r][c]);
    }
  }
  return table;
}

bool IsFirstOfProblem(const ComparisonResult& result, std::size_t row) {
  return row > 0 && result.rows[row].problem_index != result.rows[row - 1].problem_index;
}

std::string Shortened(const std::string& text, std::size_t width) {
  if (text.size() <= width) return text;
  return text.substr(0, width - 2) + "..";
}

std::size_t Total(const std::vector<std::size_t>& widths, std::size_t separator) {
  std::size_t total = separator * (widths.size() - 1);
  for (const std::size_t width : widths) total += width;
  return total;
}

/// As wide as the cells, names shortened where the table would be too wide.
std::vector<std::size_t> TextWidths(const Table& table, std::size_t* separator) {
  std::vector<std::size_t> widths;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const Column& column = table.columns[c];
    std::size_t width = std::max(std::string(column.top).size(), std::string(column.bottom).size());
    for (const Cells& row : table.rows) {
      if (table.IsWhole(row) || c < kNumNames) width = std::max(width, row[c].size());
    }
    widths.push_back(width);
  }
  *separator = Total(widths, 2) <= kWidest ? 2 : 1;
  constexpr std::size_t kShortest = 8;
  while (Total(widths, *separator) > kWidest) {
    std::size_t& longer = widths[0] > widths[1] ? widths[0] : widths[1];
    if (longer <= kShortest) break;
    --longer;
  }
  return widths;
}

std::string TextLine(const Cells& cells, const std::vector<std::size_t>& widths,
                     std::size_t separator) {
  std::string line;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (c > 0) line.append(separator, ' ');
    if (c >= kNumNames && cells.size() < widths.size()) {
      return Shortened(line + cells[c], kWidest);
    }
    const std::string text = Shortened(cells[c], widths[c]);
    const std::size_t fill = widths[c] - text.size();
    line += c < kFirstNumber ? text + std::string(fill, ' ') : std::string(fill, ' ') + text;
  }
  line.erase(line.find_last_not_of(' ') + 1);
  return line;
}

/// Broken at spaces, continued lines indented; a word longer than a line stays whole.
std::string Wrapped(const std::string& text) {
  std::string result;
  std::string line;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    if (!line.empty() && line.size() + 1 + (end - begin) > kWidest) {
      result += line + "\n";
      line = "   ";
    }
    line += (line.empty() ? "" : " ") + text.substr(begin, end - begin);
    begin = end + 1;
  }
  return result + line + "\n";
}

std::string LatexLine(const Cells& cells, std::size_t num_columns) {
  std::string line;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (c > 0) line += " & ";
    if (c >= kNumNames && cells.size() < num_columns) {
      line +=
          "\\multicolumn{" + std::to_string(num_columns - c) + "}{l}{" + LatexText(cells[c]) + "}";
    } else {
      line += c < kFirstNumber ? LatexText(cells[c]) : LatexNumber(cells[c]);
    }
  }
  return line + " \\\\\n";
}

}  // namespace

std::string ComparisonText(const ComparisonResult& result) {
  const Table table = MakeTable(result);
  const std::vector<Cells>& rows = table.rows;
  std::size_t separator = 2;
  const std::vector<std::size_t> widths = TextWidths(table, &separator);
  Cells top;
  Cells bottom;
  for (const Column& column : table.columns) {
    top.push_back(column.top);
    bottom.push_back(column.bottom);
  }
  std::string text = TextLine(top, widths, separator) + "\n" + TextLine(bottom, widths, separator) +
                     "\n" + std::string(Total(widths, separator), '-') + "\n";
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (IsFirstOfProblem(result, r)) text += "\n";
    text += TextLine(rows[r], widths, separator) + "\n";
  }
  text += "\n";
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const bool cut = !table.IsWhole(rows[r]) &&
                     Total({widths[0], widths[1], rows[r].back().size()}, separator) > kWidest;
    if (cut) text += Wrapped(rows[r][0] + ", " + rows[r][1] + ": " + rows[r][2]);
  }
  for (const std::string& note : ComparisonNotes(result)) text += Wrapped(note);
  return text;
}

std::string ComparisonMarkdown(const ComparisonResult& result) {
  const Table table = MakeTable(result);
  std::string text = "|";
  std::string rule = "|";
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    text += std::string(" ") + table.columns[c].whole + " |";
    rule += c < kFirstNumber ? " --- |" : " ---: |";
  }
  text += "\n" + rule + "\n";
  for (Cells cells : table.rows) {
    cells.resize(table.columns.size());
    text += "|";
    for (const std::string& cell : cells) text += " " + MarkdownText(cell) + " |";
    text += "\n";
  }
  text += "\n";
  for (const std::string& note : ComparisonNotes(result)) text += "- " + MarkdownText(note) + "\n";
  return text;
}

std::string ComparisonLatex(const ComparisonResult& result) {
  const Table table = MakeTable(result);
  // A float a problem: one of several pages would not be set.
  std::string begin =
      "\\begin{table*}\n\\centering\\scriptsize\\setlength{\\tabcolsep}{3pt}\n"
      "\\begin{tabular}{" +
      std::string(kFirstNumber, 'l') + std::string(table.columns.size() - kFirstNumber, 'r') +
      "}\n\\toprule\n";
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    begin += (c > 0 ? " & " : "") + std::string(table.columns[c].latex);
  }
  begin += " \\\\\n\\midrule\n";
  const std::string end = "\\bottomrule\n\\end{tabular}\n\\end{table*}\n";
  std::string text = "% Needs \\usepackage{booktabs}.\n";
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    if (r == 0 || IsFirstOfProblem(result, r)) text += (r > 0 ? end : "") + begin;
    text += LatexLine(table.rows[r], table.columns.size());
  }
  if (!table.rows.empty()) text += end;
  text += "\n{\\raggedright\\scriptsize\n";
  for (const std::string& note : ComparisonNotes(result)) text += LatexText(note) + "\\par\n";
  return text + "}\n";
}

}  // namespace batten
