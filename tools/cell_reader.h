#ifndef BATTEN_TOOLS_CELL_READER_H_
#define BATTEN_TOOLS_CELL_READER_H_

#include <string>

#include "experiments/comparison.h"

namespace batten {

/// A line of cells.jsonl, read back.
struct Cell {
  ComparisonRow row;            // without its trace and end
  double minimum_energy = 0.0;  // NaN: not known
  std::string disagreement;     // empty: none
};

/// False unless `line` is a row of `solver` on `problem` that a run of `spec` can have written:
/// every field is there, of its type and in its range, every word a known one. Somebody may have
/// edited the file.
bool ReadCell(const std::string& line, const std::string& problem, const NameSpec& solver,
              const ComparisonSpec& spec, Cell* cell);

}  // namespace batten

#endif  // BATTEN_TOOLS_CELL_READER_H_
