#ifndef BATTEN_TESTS_EXPERIMENTS_HAND_MADE_TABLES_H_
#define BATTEN_TESTS_EXPERIMENTS_HAND_MADE_TABLES_H_

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "experiments/csv_table.h"
#include "experiments/reproduction.h"

namespace batten {

inline constexpr ClaimVerdict kHolds = ClaimVerdict::kHolds;
inline constexpr ClaimVerdict kInPart = ClaimVerdict::kInPart;
inline constexpr ClaimVerdict kDoesNotHold = ClaimVerdict::kDoesNotHold;
inline constexpr ClaimVerdict kUndecided = ClaimVerdict::kUndecided;

/// Of some columns, by name.
using Cells = std::vector<std::pair<std::string, std::string>>;

/// A row of `table` with these cells, the others empty.
inline void AddCells(const Cells& cells, CsvTable* table) {
  table->AddRow(std::vector<std::string>(table->columns().size()));
  for (const auto& [column, text] : cells) table->Set(table->num_rows() - 1, column, text);
}

inline ClaimVerdict VerdictOn(const Experiment& experiment, const ExperimentTables& tables,
                              std::size_t claim = 0) {
  return experiment.claims.at(claim).judge(tables).verdict;
}

}  // namespace batten

#endif  // BATTEN_TESTS_EXPERIMENTS_HAND_MADE_TABLES_H_
