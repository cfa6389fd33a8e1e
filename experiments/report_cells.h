#ifndef BATTEN_EXPERIMENTS_REPORT_CELLS_H_
#define BATTEN_EXPERIMENTS_REPORT_CELLS_H_

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "problems/input_file.h"

namespace batten {

using OrderedJson = nlohmann::ordered_json;

/// Hands each line of `path` but empty ones to `take`, with whether it is the last one and has no
/// end: a program that was killed left it. Stops at the first false of `take`, which fills `error`,
/// and with one sentence at a line of more than `longest_line` bytes.
bool ReadLines(const std::string& path,
               const std::function<bool(std::string_view line, long number, bool is_torn)>& take,
               std::string* error, std::size_t longest_line = kLongestLine);

/// The rows of cells.jsonl, each an object; of rows with one `key` the last. A torn last line is
/// left out and added to `notes`. False with one sentence in `error` for any other line that is no
/// object, and for a key that cannot be part of a file's name.
bool ReadCells(const std::string& path, std::vector<OrderedJson>* cells,
               std::vector<std::string>* notes, std::string* error);

/// Leaves the rows whose key is among `keys`, an array of texts, in the order of these: rows stand
/// in the order in which they were finished. Returns how many are gone.
std::size_t KeepCells(const OrderedJson& keys, std::vector<OrderedJson>* cells);

/// The field as text; "" where it is missing or of another type.
std::string TextField(const OrderedJson& cell, const char* field);
/// NaN where it is missing, null or no number.
double NumberField(const OrderedJson& cell, const char* field);

/// {"common": {field: value}, "fields": [...], "rows": [[...]]}: what is the same in all rows
/// stands once, what is missing in one is null.
OrderedJson CellsByColumn(const std::vector<OrderedJson>& cells);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_REPORT_CELLS_H_
