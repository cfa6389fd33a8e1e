#ifndef BATTEN_TOOLS_COMPARISON_CELLS_H_
#define BATTEN_TOOLS_COMPARISON_CELLS_H_

#include <string>
#include <vector>

#include "experiments/atomic_file.h"
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

  /// The lines that are there already, up to one that is too long to be a row; those that are no
  /// rows with a key are left out.
  void Read();
  /// The rows of all `solvers` on this problem are the last ones of it: its figures show them.
  bool AreLast(const CatalogueEntry& entry, const ComparisonSpec& spec) const;
  /// Adds the rows of all `solvers` on this problem, in their order, and what was said about them
  /// to `result`; false, adding nothing, unless they are all here and such as this program writes.
  bool Find(const CatalogueEntry& entry, const ComparisonSpec& spec,
            ComparisonResult* result) const;
  /// Puts the rows of `result`, which are those of `entry`, behind the others and the file into
  /// `batch`.
  bool Append(const CatalogueEntry& entry, const ComparisonResult& result, FileBatch* batch,
              std::string* error);

 private:
  struct Line {
    std::string key;
    std::string problem;
    std::string text;
  };
  void Put(Line line);
  const Line* FindLine(const std::string& key) const;

  std::string path_;
  std::vector<Line> lines_;  // in the order of the file, each key once
};

}  // namespace batten

#endif  // BATTEN_TOOLS_COMPARISON_CELLS_H_
