#include "problems/data_set.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string_view>
#include <vector>

#include "cost_functions/options.h"
#include "problems/data_reader.h"
#include "problems/input_file.h"

namespace batten {
namespace {

/// What stands in the file: it may be a picture.
std::string QuotedField(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  return Quoted(text, kLongest);
}

bool IsBlank(char c) { return c == ' ' || c == '\t'; }

std::string_view Trimmed(std::string_view text) {
  while (!text.empty() && IsBlank(text.front())) text.remove_prefix(1);
  while (!text.empty() && IsBlank(text.back())) text.remove_suffix(1);
  return text;
}

bool ParseField(std::string_view field, double* value) {
  const char* const end = field.data() + field.size();
  const auto result = std::from_chars(field.data(), end, *value);
  // The rare rest, such as +1 and 1e-400, is left to the slower function.
  if (result.ec == std::errc() && result.ptr == end) return std::abs(*value) <= kLargestNumber;
  return ParseNumber(std::string(field), value) && std::abs(*value) <= kLargestNumber;
}

class DataSetReader {
 public:
  DataSetReader(std::istream* stream, std::string label, std::string* error)
      : lines_(stream), label_(std::move(label)), error_(error) {}

  std::optional<DataSet> Read() {
    std::string_view line;
    while (lines_.Next(&line)) {
      line = Trimmed(line);
      if (line.empty() || line.front() == '#') continue;
      const bool is_first = columns_.empty();
      if (is_first && !ReadLayout(line)) return std::nullopt;
      if (is_first && is_csv_) continue;
      if (!ReadRow(line)) return std::nullopt;
    }
    if (!Finish()) return std::nullopt;
    return std::move(data_);
  }

 private:
  static constexpr int kParameter = kMaxDimension;
  static constexpr int kWeight = kMaxDimension + 1;

  bool ReadLayout(std::string_view line) {
    first_line_ = lines_.number();
    const std::string_view begin = line.substr(line.front() == '+' ? 1 : 0);
    double number = 0.0;
    const auto result = std::from_chars(begin.data(), begin.data() + begin.size(), number);
    const bool begins_with_number = result.ec != std::errc::invalid_argument;
    is_csv_ = !begins_with_number || line.find(',') != std::string_view::npos;
    if (is_csv_) return ReadHeader(line);
    for (std::string_view field; NextField(&line, &field); ++dimension_) {
      columns_.push_back(dimension_);
    }
    if (dimension_ <= kMaxDimension) return true;
    return Refuse(kMaxDimension + 1, std::to_string(dimension_) + " columns",
                  "1 to " + std::to_string(kMaxDimension));
  }

  bool ReadHeader(std::string_view line) {
    const std::string coordinates = "xyzw";
    for (std::string_view field; NextField(&line, &field);) {
      int column = -1;
      if (field == "t") column = kParameter;
      if (field == "weight") column = kWeight;
      if (dimension_ < kMaxDimension && field == coordinates.substr(dimension_, 1)) {
        column = dimension_++;
      }
      if (column < 0 || HasColumn(column)) {
        return Refuse(columns_.size() + 1, QuotedField(field) + " as a column name", FreeNames());
      }
      columns_.push_back(column);
    }
    if (HasColumn(kParameter)) data_.parameters.emplace();
    if (HasColumn(kWeight)) data_.weights.emplace();
    if (dimension_ > 0) return true;
    return Refuse(columns_.size() + 1, "no coordinate column", FreeNames());
  }

  bool HasColumn(int column) const {
    return std::find(columns_.begin(), columns_.end(), column) != columns_.end();
  }

  std::string FreeNames() const {
    std::string names = "a header of x, y, z, w in this order";
    if (!HasColumn(kParameter)) names += ", t";
    if (!HasColumn(kWeight)) names += ", weight";
    names += ", separated by commas";
    return columns_.empty() ? names + ", or rows of numbers without commas" : names;
  }

  bool NextField(std::string_view* rest, std::string_view* field) const {
    if (rest->data() == nullptr) return false;
    if (!is_csv_) *rest = Trimmed(*rest);
    if (!is_csv_ && rest->empty()) return false;
    const char* const rest_end = rest->data() + rest->size();
    const char* end = rest->data();
    while (end != rest_end && (is_csv_ ? *end != ',' : !IsBlank(*end))) ++end;
    *field = Trimmed(rest->substr(0, end - rest->data()));
    // A comma at the very end is followed by one more field, an empty one.
    *rest = end == rest_end ? std::string_view() : rest->substr(end - rest->data() + 1);
    return true;
  }

  bool ReadRow(std::string_view line) {
    double values[kMaxDimension + 2];
    size_t count = 0;
    std::string_view field;
    for (; NextField(&line, &field); ++count) {
      if (count >= columns_.size()) continue;
      double* const value = &values[columns_[count]];
      const bool is_weight = columns_[count] == kWeight;
      if (!ParseField(field, value) || (is_weight && *value < 0.0)) {
        return Refuse(count + 1, QuotedField(field),
                      is_weight ? "a weight from 0 to 1e150" : "a number from -1e150 to 1e150");
      }
    }
    if (count != columns_.size()) {
      return Refuse(std::min(count, columns_.size()) + 1, "row length " + std::to_string(count),
                    std::to_string(columns_.size()) + " as in line " + std::to_string(first_line_));
    }
    if (num_points_ == data_.points.rows()) Resize(std::max<Eigen::Index>(64, 2 * num_points_));
    std::copy_n(values, dimension_, data_.points.data() + num_points_ * dimension_);
    if (data_.parameters) (*data_.parameters)[num_points_] = values[kParameter];
    if (data_.weights) (*data_.weights)[num_points_] = values[kWeight];
    ++num_points_;
    return true;
  }

  // Large blocks grow by remapping pages, so that doubling neither copies nor fills the new half.
  void Resize(Eigen::Index size) {
    data_.points.conservativeResize(size, dimension_);
    if (data_.parameters) data_.parameters->conservativeResize(size);
    if (data_.weights) data_.weights->conservativeResize(size);
  }

  bool Finish() {
    if (lines_.has_failed()) {
      *error_ = CannotBeRead(label_, lines_.error_number());
      return false;
    }
    if (lines_.is_too_long()) {
      return Refuse(1, "a line of more than " + std::to_string(kLongestLine) + " bytes",
                    "shorter lines");
    }
    if (num_points_ == 0) return Refuse(1, "no data point up to the end", "at least one");
    Resize(num_points_);
    if (data_.weights && !(data_.weights->array() > 0.0).any()) {
      const auto column = std::find(columns_.begin(), columns_.end(), kWeight) - columns_.begin();
      return RefuseAt(first_line_, column + 1, "only zeros in column weight",
                      "at least one weight above 0");
    }
    data_.name = label_ == "-" ? "stdin" : std::filesystem::path(label_).stem().string();
    return true;
  }

  bool Refuse(size_t column, const std::string& found, const std::string& allowed) const {
    return RefuseAt(std::max<int64_t>(1, lines_.number()), column, found, allowed);
  }

  bool RefuseAt(int64_t line, size_t column, const std::string& found,
                const std::string& allowed) const {
    *error_ = label_ + ":" + std::to_string(line) + ":" + std::to_string(column) + ": found " +
              found + "; allowed: " + allowed;
    return false;
  }

  LineReader lines_;
  const std::string label_;
  std::string* const error_;
  std::vector<int> columns_;  // coordinate, kParameter or kWeight; empty before the first line
  bool is_csv_ = false;
  int64_t first_line_ = 0;
  int dimension_ = 0;
  Eigen::Index num_points_ = 0;
  DataSet data_;
};

std::optional<DataSet> ReadBy(const DataReader& reader, const std::string& path,
                              std::string* error) {
  std::optional<DataSet> data = reader.read(path, error);
  if (!data.has_value()) return std::nullopt;
  std::string why;
  if (!CheckDataSet(*data, &why)) {
    *error = path + ": data reader " + reader.name + ": " + why;
    return std::nullopt;
  }
  if (data->name.empty()) data->name = std::filesystem::path(path).stem().string();
  return data;
}

}  // namespace

std::optional<DataSet> ReadDataSet(std::istream& stream, const std::string& label,
                                   std::string* error) {
  return DataSetReader(&stream, label, error).Read();
}

std::optional<DataSet> ReadDataSet(const std::string& path, std::string* error) {
  if (path == "-") return ReadDataSet(std::cin, path, error);
  const DataReader* const reader = DataReaderRegistry::Global().ForFile(path);
  if (reader != nullptr) return ReadBy(*reader, path, error);
  std::ifstream file;
  if (!OpenInput(path, &file, error)) return std::nullopt;
  return ReadDataSet(file, path, error);
}

}  // namespace batten
