#ifndef BATTEN_EXPERIMENTS_COMPARISON_RECORDS_H_
#define BATTEN_EXPERIMENTS_COMPARISON_RECORDS_H_

#include <nlohmann/json.hpp>
#include <string>

#include "experiments/comparison.h"

namespace batten {

/// A row of cells.jsonl, for `compare` and `bench` alike (docs/formats.md).
nlohmann::ordered_json CellJson(const ComparisonRow& row, double minimum_energy,
                                const RunSpec& spec);

/// On one line for an indent of -1; bad UTF-8 is replaced, not thrown at.
std::string DumpJson(const nlohmann::ordered_json& json, int indent);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_COMPARISON_RECORDS_H_
