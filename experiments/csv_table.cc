#include "experiments/csv_table.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "cost_functions/options.h"

namespace batten {
namespace {

std::vector<std::string> Split(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',') {
      cells.emplace_back();
    } else if (c != '\r') {
      cells.back() += c;
    }
  }
  return cells;
}

std::string Joined(const std::vector<std::string>& cells) {
  std::string line;
  for (std::size_t k = 0; k < cells.size(); ++k) line += (k > 0 ? "," : "") + cells[k];
  return line + "\n";
}

}  // namespace

std::string NumberCell(double value) { return std::isfinite(value) ? NumberText(value) : ""; }

std::size_t CsvTable::ColumnIndex(const std::string& column) const {
  const auto found = std::find(columns_.begin(), columns_.end(), column);
  CHECK(found != columns_.end()) << "no column " << column;
  return static_cast<std::size_t>(found - columns_.begin());
}

void CsvTable::AddRow(std::vector<std::string> cells) {
  CHECK_EQ(cells.size(), columns_.size());
  for (const std::string& cell : cells) {
    CHECK(cell.find_first_of(",\"\n\r") == std::string::npos) << cell;
  }
  rows_.push_back(std::move(cells));
}

const std::string& CsvTable::Text(std::size_t row, const std::string& column) const {
  return rows_.at(row)[ColumnIndex(column)];
}

double CsvTable::Number(std::size_t row, const std::string& column) const {
  double value = 0.0;
  return ParseNumber(Text(row, column), &value) ? value : std::numeric_limits<double>::quiet_NaN();
}

void CsvTable::Set(std::size_t row, const std::string& column, const std::string& text) {
  rows_.at(row)[ColumnIndex(column)] = text;
}

CsvTable CsvTable::Where(const std::string& column, const std::string& text) const {
  const std::size_t index = ColumnIndex(column);
  CsvTable result(columns_);
  std::copy_if(rows_.begin(), rows_.end(), std::back_inserter(result.rows_),
               [&](const std::vector<std::string>& cells) { return cells[index] == text; });
  return result;
}

CsvTable CsvTable::Select(const std::vector<std::string>& columns) const {
  CsvTable selected(columns);
  for (std::size_t row = 0; row < num_rows(); ++row) {
    std::vector<std::string> cells;
    for (const std::string& column : columns) cells.push_back(Text(row, column));
    selected.AddRow(std::move(cells));
  }
  return selected;
}

std::vector<double> CsvTable::Numbers(const std::string& column) const {
  std::vector<double> values;
  for (std::size_t row = 0; row < rows_.size(); ++row) values.push_back(Number(row, column));
  return values;
}

std::vector<std::string> CsvTable::Distinct(const std::string& column) const {
  const std::size_t index = ColumnIndex(column);
  std::vector<std::string> texts;
  for (const std::vector<std::string>& cells : rows_) {
    if (std::find(texts.begin(), texts.end(), cells[index]) == texts.end()) {
      texts.push_back(cells[index]);
    }
  }
  return texts;
}

std::string CsvTable::ToCsv() const {
  std::string text = Joined(columns_);
  for (const std::vector<std::string>& cells : rows_) text += Joined(cells);
  return text;
}

bool CsvTable::FromCsv(const std::string& text, CsvTable* table, std::string* error) {
  *table = CsvTable();
  std::istringstream lines(text);
  std::string line;
  int number = 0;
  while (std::getline(lines, line)) {
    ++number;
    if (line.empty() || line[0] == '#') continue;
    std::vector<std::string> cells = Split(line);
    if (table->columns_.empty()) {
      table->columns_ = std::move(cells);
    } else if (cells.size() == table->columns_.size()) {
      table->rows_.push_back(std::move(cells));
    } else {
      *error = "line " + std::to_string(number) + ": found " + std::to_string(cells.size()) +
               " cells; allowed: " + std::to_string(table->columns_.size()) + ", as in the header";
      return false;
    }
  }
  if (table->columns_.empty()) *error = "found no header; allowed: CSV with one";
  return !table->columns_.empty();
}

}  // namespace batten
