#include "experiments/report_tables.h"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "experiments/report_cells.h"
#include "experiments/report_traces.h"
#include "problems/input_file.h"

namespace batten {
namespace {

namespace fs = std::filesystem;

std::string InFolder(const std::string& folder, const std::string& name) {
  return (fs::path(folder) / name).string();
}

bool ReadTable(const std::string& path, std::size_t most_rows, OrderedJson* table,
               std::string* error) {
  std::size_t num_columns = 0, num_rows = 0;
  const auto take = [&](std::string_view line, long number, bool /*is_torn*/) {
    if (line.front() == '#') return true;
    const std::vector<std::string> fields = CsvFields(line);
    if (num_columns == 0) {
      num_columns = fields.size();
      (*table)["columns"] = fields;
      return true;
    }
    if (fields.size() != num_columns) {
      *error = path + ":" + std::to_string(number) + ": found " + std::to_string(fields.size()) +
               " fields; allowed: " + std::to_string(num_columns) + ", as in the header";
      return false;
    }
    if (++num_rows <= most_rows) (*table)["rows"].push_back(fields);
    return true;
  };
  (*table)["columns"] = OrderedJson::array();
  (*table)["rows"] = OrderedJson::array();
  const bool is_read = ReadLines(path, take, error);
  (*table)["num_rows"] = num_rows;
  return is_read;
}

bool BeginsWith(const std::string& text, const std::string& begin) {
  return text.compare(0, begin.size(), begin) == 0;
}

/// The text between `begin` and `end`, which come one behind the other; "" if not.
std::string Between(const std::string& text, const std::string& begin, const std::string& end) {
  const std::size_t first = text.find(begin);
  if (first == std::string::npos) return "";
  const std::size_t from = first + begin.size();
  const std::size_t to = text.find(end, from);
  return to == std::string::npos ? "" : text.substr(from, to - from);
}

/// Reads the page line by line; what it does not know is prose.
class PageReader {
 public:
  void Take(const std::string& line);
  OrderedJson page() const { return page_; }
  bool has_claims() const { return has_claims_; }

 private:
  OrderedJson page_ = {{"title", ""}, {"sections", OrderedJson::array()}};
  std::string last_picture_;
  bool has_claims_ = false;
};

void PageReader::Take(const std::string& line) {
  OrderedJson& sections = page_["sections"];
  if (BeginsWith(line, "# ")) page_["title"] = line.substr(2);
  if (BeginsWith(line, "## ")) {
    sections.push_back({{"title", line.substr(3)},
                        {"claims", OrderedJson::array()},
                        {"pictures", OrderedJson::array()},
                        {"tables", OrderedJson::array()}});
  }
  if (sections.empty()) return;
  OrderedJson& section = sections.back();
  OrderedJson& claims = section["claims"];
  if (BeginsWith(line, "> ")) {
    claims.push_back({{"quote", line.substr(2)}, {"verdict", ""}, {"because", ""}, {"rule", ""}});
  } else if (BeginsWith(line, "**") && !claims.empty()) {
    has_claims_ = true;
    claims.back()["verdict"] = Between(line, "**", "**");
    const std::size_t because = line.find("**: ");
    if (because == std::string::npos) return;
    const std::string text = line.substr(because + 4);
    claims.back()["because"] = text.substr(0, text.find_last_not_of(' ') + 1);
  } else if (BeginsWith(line, "Rule: ") && !claims.empty()) {
    claims.back()["rule"] = line.substr(6);
  } else if (BeginsWith(line, "![")) {
    section["pictures"].push_back({{"name", Between(line, "](", ")")}, {"caption", ""}});
  } else if (BeginsWith(line, "*") && !section["pictures"].empty()) {
    section["pictures"].back()["caption"] = Between(line, "*", "*");
  } else if (BeginsWith(line, "Data: ")) {
    std::istringstream names(line.substr(6));
    for (std::string name; std::getline(names, name, '(');) {
      const std::size_t end = name.find(')');
      if (end != std::string::npos) section["tables"].push_back(name.substr(0, end));
    }
  }
}

}  // namespace

std::vector<std::string> FilesEndingIn(const std::string& folder, const std::string& ending) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    const bool is_wanted = entry.is_regular_file(ignored) && entry.path().extension() == ending;
    if (is_wanted) names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

bool ReadReportTables(const std::string& folder, const std::vector<std::string>& skipped,
                      const ReportLimits& limits, OrderedJson* tables,
                      std::vector<std::string>* notes, std::string* error) {
  *tables = OrderedJson::array();
  std::size_t bytes = 0;
  for (const std::string& name : FilesEndingIn(folder, ".csv")) {
    if (std::find(skipped.begin(), skipped.end(), name) != skipped.end()) continue;
    const std::string path = InFolder(folder, name);
    std::error_code ignored;
    const std::size_t size = fs::file_size(path, ignored);
    const bool fits = bytes + size <= limits.table_bytes;
    OrderedJson table = {{"name", name}};
    if (!ReadTable(path, fits ? limits.rows_per_table : 20, &table, error)) return false;
    if (fits) bytes += size;
    const std::size_t shown = table["rows"].size();
    if (shown < table["num_rows"].get<std::size_t>()) {
      notes->push_back(name + ": the page has the first " + std::to_string(shown) + " of " +
                       table["num_rows"].dump() + " rows");
    }
    tables->push_back(std::move(table));
  }
  return true;
}

bool ReadReportPictures(const std::string& folder, const ReportLimits& limits,
                        OrderedJson* pictures, std::vector<std::string>* notes,
                        std::string* error) {
  *pictures = OrderedJson::array();
  std::size_t bytes = 0;
  for (const std::string& name : FilesEndingIn(folder, ".svg")) {
    std::string svg;
    if (!ReadWholeFile(InFolder(folder, name), &svg, error)) return false;
    if (bytes + svg.size() > limits.picture_bytes) {
      notes->push_back(name + ": the picture is not in the page, which would grow too large");
      continue;
    }
    bytes += svg.size();
    pictures->push_back({{"name", name}, {"svg", std::move(svg)}});
    // What is plotted: of some figures there is none, and a picture without it still serves.
    const std::string path = InFolder(folder, fs::path(name).stem().string() + ".dat");
    std::error_code failure;
    const std::uintmax_t size = fs::file_size(path, failure);
    if (failure) continue;
    if (bytes + size > limits.picture_bytes) {
      notes->push_back(name + ": what it plots is not in the page, which would grow too large");
      continue;
    }
    std::string data;
    if (!ReadWholeFile(path, &data, error)) return false;
    bytes += data.size();
    pictures->back()["data"] = std::move(data);
  }
  return true;
}

bool ReadReproductionPages(const std::string& folder, OrderedJson* pages, std::string* error) {
  *pages = OrderedJson::array();
  for (const std::string& name : FilesEndingIn(folder, ".md")) {
    std::string text;
    if (!ReadWholeFile(InFolder(folder, name), &text, error)) return false;
    PageReader reader;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) reader.Take(line);
    if (reader.has_claims()) pages->push_back(reader.page());
  }
  return true;
}

}  // namespace batten
