#ifndef BATTEN_TOOLS_COMPARISON_CELLS_H_
#define BATTEN_TOOLS_COMPARISON_CELLS_H_

#include <map>
#include <string>
#include <vector>

#include "experiments/comparison.h"
#include "problems/catalogue.h"

namespace batten {

/// What decides whether a row of an earlier comparison is the row that would be computed now: this
/// program, the problem file, its data, the solver with its options, the rule of the runs. 16
/// hexadecimal digits.
std::string CellKey(const CatalogueEntry& entry, const NameSpec& solver,
                    const ComparisonSpec& spec);

/// The rows of OUT/cells.jsonl, with the "key" and the "disagreement" (or null) of each.
class ComparisonCells {
 public:
  explicit ComparisonCells(std::string path) : path_(std::move(path)) {}

  /// The lines that are there already; those that are no rows with a key are left out.
  void Read();
  /// Adds the rows of all `solvers` on this problem, in their order, and what was said about them
  /// to `result`; false, adding nothing, unless they are all here.
  bool Find(const CatalogueEntry& entry, const ComparisonSpec& spec,
            ComparisonResult* result) const;
  /// Puts the rows of `result`, which are those of `entry`, behind the others and writes the file.
  bool Append(const CatalogueEntry& entry, const ComparisonResult& result, std::string* error);

 private:
  void Put(const std::string& key, const std::string& line);

  std::string path_;
  std::vector<std::string> keys_;  // in the order of the file
  std::map<std::string, std::string> line_of_key_;
};

}  // namespace batten

#endif  // BATTEN_TOOLS_COMPARISON_CELLS_H_
