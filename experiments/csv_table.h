#ifndef BATTEN_EXPERIMENTS_CSV_TABLE_H_
#define BATTEN_EXPERIMENTS_CSV_TABLE_H_

#include <functional>
#include <string>
#include <vector>

namespace batten {

/// `value` so that it reads back to the same double; empty where it is no finite number.
std::string NumberCell(double value);

/// A small table of text cells with named columns, as it stands in a CSV file: what the verdicts
/// and figures of a reproduction are computed from. Cells hold no commas, quotes or line ends.
class CsvTable {
 public:
  CsvTable() = default;
  explicit CsvTable(std::vector<std::string> columns) : columns_(std::move(columns)) {}

  const std::vector<std::string>& columns() const { return columns_; }
  std::size_t num_rows() const { return rows_.size(); }
  /// One cell per column.
  void AddRow(std::vector<std::string> cells);

  /// A column that is not there is our bug: CHECK.
  const std::string& Text(std::size_t row, const std::string& column) const;
  /// NaN where the cell is no number.
  double Number(std::size_t row, const std::string& column) const;
  void Set(std::size_t row, const std::string& column, const std::string& text);
  /// Rows whose cell in `column` is `text`, in their order.
  CsvTable Where(const std::string& column, const std::string& text) const;
  /// These columns, in this order.
  CsvTable Select(const std::vector<std::string>& columns) const;
  std::vector<double> Numbers(const std::string& column) const;
  /// Different texts of a column in the order of their first row.
  std::vector<std::string> Distinct(const std::string& column) const;

  /// With a header.
  std::string ToCsv() const;
  /// False with one sentence in `error` for text without header or with rows of another length;
  /// lines that begin with # are skipped.
  static bool FromCsv(const std::string& text, CsvTable* table, std::string* error);

 private:
  std::size_t ColumnIndex(const std::string& column) const;

  std::vector<std::string> columns_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_CSV_TABLE_H_
