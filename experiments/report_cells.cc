#include "experiments/report_cells.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>

namespace batten {
namespace {

/// Whether the file ends within a line.
bool EndsWithinLine(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file.seekg(-1, std::ios::end)) return false;  // empty
  return file.get() != '\n';
}

std::string Shortened(std::string_view text) {
  constexpr std::size_t kMost = 40;
  return text.size() <= kMost ? std::string(text) : std::string(text.substr(0, kMost)) + "...";
}

/// Names files, so that it must not lead out of the folder.
bool IsGoodKey(const std::string& key) {
  return key.size() <= 200 && std::all_of(key.begin(), key.end(), [](unsigned char c) {
           return std::isalnum(c) != 0 || c == '-' || c == '_';
         });
}

}  // namespace

bool ReadLines(const std::string& path,
               const std::function<bool(std::string_view line, long number, bool is_torn)>& take,
               std::string* error, std::size_t longest_line) {
  std::ifstream file;
  if (!OpenInput(path, &file, error)) return false;
  const bool is_torn = EndsWithinLine(path);
  LineReader reader(&file, longest_line);
  // One line is held back, since only the last one may be torn.
  std::string held;
  long held_number = 0;
  for (std::string_view line; reader.Next(&line);) {
    if (!held.empty() && !take(held, held_number, false)) return false;
    held.assign(line);
    held_number = reader.number();
  }
  if (reader.is_too_long()) {
    *error = path + ":" + std::to_string(reader.number() + 1) + ": found a line of more than " +
             std::to_string(longest_line) + " bytes; allowed: shorter ones";
    return false;
  }
  if (reader.has_failed()) {
    *error = CannotBeRead(path, reader.error_number());
    return false;
  }
  return held.empty() || take(held, held_number, is_torn);
}

bool ReadCells(const std::string& path, std::vector<OrderedJson>* cells,
               std::vector<std::string>* notes, std::string* error) {
  std::map<std::string, std::size_t> places;
  const auto take = [&](std::string_view line, long number, bool is_torn) {
    OrderedJson cell = OrderedJson::parse(line, nullptr, /*allow_exceptions=*/false);
    const std::string place = path + ":" + std::to_string(number);
    if (!cell.is_object()) {
      if (!is_torn) {
        *error = place + ": found \"" + Shortened(line) + "\"; allowed: one JSON object a line";
        return false;
      }
      notes->push_back(place + ": the last line is torn and was left out");
      return true;
    }
    const std::string key = TextField(cell, "key");
    if (!IsGoodKey(key)) {
      *error =
          place + ": /key: found \"" + Shortened(key) + "\"; allowed: letters, digits, `-` and `_`";
      return false;
    }
    const auto [found, is_new] = places.emplace(key, cells->size());
    if (key.empty() || is_new) {
      cells->push_back(std::move(cell));
    } else {
      (*cells)[found->second] = std::move(cell);
    }
    return true;
  };
  return ReadLines(path, take, error);
}

std::size_t KeepCells(const OrderedJson& keys, std::vector<OrderedJson>* cells) {
  std::map<std::string, std::size_t> places;
  for (const OrderedJson& key : keys) {
    if (key.is_string()) places.emplace(key.get<std::string>(), places.size());
  }
  const std::size_t before = cells->size();
  const auto is_other = [&places](const OrderedJson& cell) {
    return places.count(TextField(cell, "key")) == 0;
  };
  cells->erase(std::remove_if(cells->begin(), cells->end(), is_other), cells->end());
  std::sort(cells->begin(), cells->end(), [&places](const OrderedJson& a, const OrderedJson& b) {
    return places.at(TextField(a, "key")) < places.at(TextField(b, "key"));
  });
  return before - cells->size();
}

std::string TextField(const OrderedJson& cell, const char* field) {
  const auto found = cell.find(field);
  return found != cell.end() && found->is_string() ? found->get<std::string>() : "";
}

double NumberField(const OrderedJson& cell, const char* field) {
  const auto found = cell.find(field);
  return found != cell.end() && found->is_number() ? found->get<double>() : std::nan("");
}

OrderedJson CellsByColumn(const std::vector<OrderedJson>& cells) {
  std::vector<std::string> fields;
  std::map<std::string, bool> is_common;  // of each field seen
  for (const OrderedJson& cell : cells) {
    for (const auto& [field, value] : cell.items()) {
      if (is_common.emplace(field, true).second) fields.push_back(field);
    }
  }
  for (auto& entry : is_common) {
    const std::string& field = entry.first;
    const auto first = cells.front().find(field);
    entry.second = cells.size() > 1 && first != cells.front().end() &&
                   std::all_of(cells.begin(), cells.end(), [&](const OrderedJson& cell) {
                     const auto found = cell.find(field);
                     return found != cell.end() && *first == *found;
                   });
  }
  OrderedJson result = {{"common", OrderedJson::object()},
                        {"fields", OrderedJson::array()},
                        {"rows", OrderedJson::array()}};
  for (const std::string& field : fields) {
    if (is_common[field]) {
      result["common"][field] = cells.front()[field];
    } else {
      result["fields"].push_back(field);
    }
  }
  for (const OrderedJson& cell : cells) {
    OrderedJson row = OrderedJson::array();
    for (const std::string& field : fields) {
      if (is_common[field]) continue;
      const auto found = cell.find(field);
      row.push_back(found == cell.end() ? OrderedJson() : *found);
    }
    result["rows"].push_back(std::move(row));
  }
  return result;
}

}  // namespace batten
