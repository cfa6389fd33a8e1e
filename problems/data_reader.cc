#include "problems/data_reader.h"

#include <glog/logging.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "cost_functions/options.h"

namespace batten {
namespace {

std::string LowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool IsWithinRange(const Eigen::Ref<const Eigen::VectorXd>& numbers) {
  return (numbers.array().abs() <= kLargestNumber).all();
}

}  // namespace

DataReaderRegistry& DataReaderRegistry::Global() {
  static DataReaderRegistry& registry = *new DataReaderRegistry;
  return registry;
}

std::string DataReaderRegistry::WhyNot(const DataReader& reader) const {
  const std::string& extension = reader.extension;
  const bool is_extension = extension.size() > 1 && extension.front() == '.' &&
                            extension.find('/') == std::string::npos &&
                            extension == LowerCase(extension);
  if (!is_extension) {
    constexpr std::size_t kLongest = 40;
    return "registers a data reader for files ending in " + Quoted(extension, kLongest) +
           "; allowed: a dot and lower-case letters";
  }
  for (const auto& [name, other] : readers_) {
    if (other.extension == extension) {
      return "registers a data reader for " + extension + ", which " + name + " reads already";
    }
  }
  return "";
}

void DataReaderRegistry::Register(DataReader reader) {
  const std::string name = reader.name;
  CHECK(readers_.emplace(name, std::move(reader)).second) << "two readers are named " << name;
}

std::vector<std::string> DataReaderRegistry::Names() const {
  std::vector<std::string> names;
  for (const auto& [name, reader] : readers_) names.push_back(name);
  return names;
}

const DataReader* DataReaderRegistry::Find(const std::string& name) const {
  const auto found = readers_.find(name);
  return found == readers_.end() ? nullptr : &found->second;
}

const DataReader* DataReaderRegistry::ForFile(const std::string& path) const {
  const std::string extension = LowerCase(std::filesystem::path(path).extension().string());
  for (const auto& [name, reader] : readers_) {
    if (reader.extension == extension) return &reader;
  }
  return nullptr;
}

bool CheckDataSet(const DataSet& data, std::string* error) {
  const Eigen::Index count = data.points.rows();
  const Eigen::Index dimension = data.points.cols();
  const auto fits = [count](const std::optional<Eigen::VectorXd>& column) {
    return !column.has_value() || (column->size() == count && IsWithinRange(*column));
  };
  const Eigen::Map<const Eigen::VectorXd> numbers(data.points.data(), data.points.size());
  if (count < 1 || dimension < 1 || dimension > kMaxDimension) {
    *error = "found " + std::to_string(count) + " points of " + std::to_string(dimension) +
             " coordinates; allowed: at least one, of 1 to " + std::to_string(kMaxDimension);
  } else if (!IsWithinRange(numbers)) {
    *error = "found a coordinate that is no number from -1e150 to 1e150";
  } else if (!fits(data.parameters)) {
    *error = "found parameters that are not one finite number a point";
  } else if (!fits(data.weights) ||
             (data.weights.has_value() &&
              (!(data.weights->array() >= 0.0).all() || !(data.weights->array() > 0.0).any()))) {
    *error = "found weights that are not one number from 0 to 1e150 a point, or are all 0";
  } else {
    return true;
  }
  return false;
}

}  // namespace batten
