#ifndef BATTEN_PROBLEMS_DATA_READER_H_
#define BATTEN_PROBLEMS_DATA_READER_H_

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "problems/data_set.h"

namespace batten {

/// Reads points from files of one kind, known by how their names end.
struct DataReader {
  std::string name;
  std::string summary;    ///< One line.
  std::string extension;  ///< ".ply": with the dot, in lower case; files are matched in any case.
  /// Nothing, with `PATH: what was found; what is allowed` in `error`, where it cannot.
  std::function<std::optional<DataSet>(const std::string& path, std::string* error)> read;
};

/// Readers that plugins bring. ReadDataSet() asks them before it reads a file as text.
class DataReaderRegistry {
 public:
  static DataReaderRegistry& Global();
  /// Empty, or one sentence: an extension that is none or is taken.
  std::string WhyNot(const DataReader& reader) const;
  void Register(DataReader reader);
  std::vector<std::string> Names() const;
  const DataReader* Find(const std::string& name) const;  ///< Null for an unknown name.
  /// The one for a file of that name; null: none.
  const DataReader* ForFile(const std::string& path) const;

 private:
  std::map<std::string, DataReader> readers_;
};

/// Whether `data` are what ReadDataSet() promises: 1..kMaxDimension coordinates, at least one
/// point, numbers within +-1e150, weights and parameters one a point, weights >= 0 and not all 0.
/// False with one sentence in `error`.
bool CheckDataSet(const DataSet& data, std::string* error);

}  // namespace batten

#endif  // BATTEN_PROBLEMS_DATA_READER_H_
