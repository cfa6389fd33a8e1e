#include "experiments/report_curves.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>

#include "experiments/kept_rows.h"
#include "problems/input_file.h"

namespace batten {
namespace {

namespace fs = std::filesystem;

/// Bytes of one iterate: `compare` keeps all variables of a fit, millions of them if asked to.
constexpr std::size_t kLongestIterate = std::size_t{1} << 28;

/// One run's file, looked through once.
struct IteratesFile {
  std::string key;
  std::string path;
  std::string curve;  // what it is drawn by
  std::size_t num_lines = 0;
  std::size_t numbers_each = 0;  // coordinates of one iterate
};

struct ShownIterate {
  double iteration = 0.0;
  std::vector<std::vector<double>> points;
};

/// `list` as points; null, as of a run that diverged, is NaN. Empty: it is none.
std::vector<std::vector<double>> PointsOf(const OrderedJson& list) {
  std::vector<std::vector<double>> points;
  if (!list.is_array()) return {};
  for (const OrderedJson& row : list) {
    if (!row.is_array() || row.empty() || row.size() != list[0].size()) return {};
    points.emplace_back();
    for (const OrderedJson& x : row) {
      if (!x.is_number() && !x.is_null()) return {};
      points.back().push_back(x.is_null() ? std::numeric_limits<double>::quiet_NaN()
                                          : x.get<double>());
    }
  }
  return points;
}

bool ParseIterate(std::string_view line, ShownIterate* iterate) {
  const OrderedJson json = OrderedJson::parse(line, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object() || !json.contains("iteration") || !json["iteration"].is_number() ||
      !json.contains("control_points")) {
    return false;
  }
  iterate->iteration = json["iteration"].get<double>();
  iterate->points = PointsOf(json["control_points"]);
  return !iterate->points.empty();
}

bool RefuseIterate(const IteratesFile& file, long number, std::string* error) {
  *error = file.path + ":" + std::to_string(number) +
           ": found no iterate; allowed: {\"iteration\": 0, \"control_points\": [[x, y], ...]}";
  return false;
}

/// How many iterates there are, and how large they are.
bool LookThrough(IteratesFile* file, std::vector<std::string>* notes, std::string* error) {
  const auto take = [&](std::string_view line, long number, bool is_torn) {
    if (is_torn) {
      notes->push_back(file->path + ":" + std::to_string(number) +
                       ": the last line is torn and was left out");
      return true;
    }
    ShownIterate iterate;
    if (file->num_lines == 0) {
      if (!ParseIterate(line, &iterate)) return RefuseIterate(*file, number, error);
      file->numbers_each = iterate.points.size() * iterate.points[0].size();
    }
    ++file->num_lines;
    return true;
  };
  return ReadLines(file->path, take, error, kLongestIterate);
}

bool ReadKept(const IteratesFile& file, std::size_t most, std::vector<ShownIterate>* iterates,
              std::string* error) {
  const std::vector<std::size_t> kept = KeptRows(file.num_lines, most);
  std::size_t index = 0;
  std::size_t next = 0;
  const auto take = [&](std::string_view line, long number, bool /*is_torn*/) {
    if (next == kept.size() || index++ != kept[next]) return true;
    ++next;
    iterates->emplace_back();
    return ParseIterate(line, &iterates->back()) || RefuseIterate(file, number, error);
  };
  return ReadLines(file.path, take, error, kLongestIterate);
}

/// Corner and longest side of a box around the points of the first iterate, the start.
void Measure(const ShownIterate& start, std::vector<double>* origin, double* size) {
  *origin = start.points[0];
  std::vector<double> highest = start.points[0];
  for (const std::vector<double>& point : start.points) {
    for (std::size_t c = 0; c < point.size(); ++c) {
      (*origin)[c] = std::min((*origin)[c], point[c]);
      highest[c] = std::max(highest[c], point[c]);
    }
  }
  *size = 0.0;
  for (std::size_t c = 0; c < highest.size(); ++c) {
    *size = std::max(*size, highest[c] - (*origin)[c]);
  }
  if (*size == 0.0) *size = 1.0;
}

std::string RunJson(const IteratesFile& file, const std::vector<ShownIterate>& iterates) {
  std::vector<double> origin;
  double size = 1.0;
  Measure(iterates[0], &origin, &size);
  const double unit = 1e-4 * size;
  std::string iterations, points;
  for (const ShownIterate& iterate : iterates) {
    iterations += (iterations.empty() ? "" : ",") + OrderedJson(iterate.iteration).dump();
    points += points.empty() ? "[" : ",[";
    bool first = true;
    for (const std::vector<double>& point : iterate.points) {
      for (std::size_t c = 0; c < point.size() && c < origin.size(); ++c) {
        const double steps = std::round((point[c] - origin[c]) / unit);
        // What has gone so far is no curve any more, and its digits would fill the page.
        const bool is_far = !(std::abs(steps) < 1e9);
        points += (first ? "" : ",") +
                  (is_far ? std::string("null") : std::to_string(static_cast<long>(steps)));
        first = false;
      }
    }
    points += "]";
  }
  return "{\"curve\":" + OrderedJson(file.curve).dump() +
         ",\"origin\":" + OrderedJson(origin).dump() + ",\"unit\":" + OrderedJson(unit).dump() +
         ",\"iterates\":" + std::to_string(file.num_lines) + ",\"iterations\":[" + iterations +
         "],\"points\":[" + points + "]}";
}

/// The spline and the data points of a problem.
bool ReadSetting(const std::string& path, OrderedJson* setting, std::string* error) {
  std::string text;
  if (!ReadWholeFile(path, &text, error)) return false;
  *setting = OrderedJson::parse(text, nullptr, /*allow_exceptions=*/false);
  const OrderedJson& json = *setting;
  const bool is_good =
      json.is_object() && json.contains("degree") && json["degree"].is_number_unsigned() &&
      json.contains("periodic") && json["periodic"].is_boolean() && json.contains("knots") &&
      json["knots"].is_array() && json.contains("points") && !PointsOf(json["points"]).empty();
  if (!is_good) *error = path + ": found no spline; allowed: degree, periodic, knots, points";
  return is_good;
}

/// Data points are drawn as dots: no more than fill a panel.
void ThinPoints(OrderedJson* setting) {
  constexpr std::size_t kMostPoints = 500;
  // A new key moves all values of an ordered object: no reference is taken before it.
  if (!setting->contains("num_points")) {
    const std::size_t num_points = (*setting)["points"].size();
    (*setting)["num_points"] = num_points;
  }
  OrderedJson& points = (*setting)["points"];
  if (points.size() <= kMostPoints) return;
  OrderedJson kept = OrderedJson::array();
  const std::size_t step = (points.size() + kMostPoints - 1) / kMostPoints;
  for (std::size_t i = 0; i < points.size(); i += step) kept.push_back(points[i]);
  points = std::move(kept);
}

/// The splines and data points that runs are drawn by, alike ones once: instances of bench differ
/// in terms and starts more often than in these.
class Settings {
 public:
  explicit Settings(std::string folder) : folder_(std::move(folder)) {}

  /// The name under which the first of `names` that has a file stands in all(); "" if none has.
  /// False with one sentence in `error` for a broken file.
  bool Find(const std::vector<std::string>& names, std::string* found, std::string* error) {
    found->clear();
    for (const std::string& name : names) {
      const std::string path = (fs::path(folder_) / "curves" / (name + ".json")).string();
      std::error_code ignored;
      const bool is_name = !name.empty() && name.find('/') == std::string::npos;
      if (!is_name || !fs::is_regular_file(path, ignored)) continue;
      const auto [place, is_new] = known_.emplace(name, "");
      if (is_new && !Read(path, name, &place->second, error)) return false;
      *found = place->second;
      return true;
    }
    return true;
  }
  const OrderedJson& all() const { return all_; }

 private:
  bool Read(const std::string& path, const std::string& name, std::string* found,
            std::string* error) {
    OrderedJson setting;
    if (!ReadSetting(path, &setting, error)) return false;
    ThinPoints(&setting);
    *found = names_.emplace(setting.dump(), name).first->second;
    if (*found == name) all_[name] = std::move(setting);
    return true;
  }

  std::string folder_;
  std::map<std::string, std::string> known_;  // by the file's name
  std::map<std::string, std::string> names_;  // by contents
  OrderedJson all_ = OrderedJson::object();
};

/// The files of the rows that have some iterates. Of bench those of an instance share what they
/// are drawn by, of compare those of a problem.
bool FindIterates(const std::string& folder, const std::vector<OrderedJson>& cells,
                  Settings* settings, std::vector<IteratesFile>* files,
                  std::vector<std::string>* notes, std::string* error) {
  for (const OrderedJson& cell : cells) {
    IteratesFile file;
    file.key = TextField(cell, "key");
    file.path = (fs::path(folder) / "iterates" / (file.key + ".jsonl")).string();
    std::error_code ignored;
    if (file.key.empty() || !fs::is_regular_file(file.path, ignored)) continue;
    if (!LookThrough(&file, notes, error)) return false;
    if (file.num_lines == 0) continue;
    if (!settings->Find({TextField(cell, "instance"), TextField(cell, "problem")}, &file.curve,
                        error)) {
      return false;
    }
    files->push_back(std::move(file));
  }
  return true;
}

}  // namespace

bool ReadReportCurves(const std::string& folder, const std::vector<OrderedJson>& cells,
                      const ReportLimits& limits, std::string* json,
                      std::vector<std::string>* notes, std::string* error) {
  std::vector<IteratesFile> files;
  Settings settings(folder);
  if (!FindIterates(folder, cells, &settings, &files, notes, error)) return false;
  std::size_t numbers_in_all = 0;
  for (const IteratesFile& file : files) numbers_in_all += file.numbers_each;
  const std::size_t most = std::clamp<std::size_t>(
      limits.curve_numbers / std::max<std::size_t>(1, numbers_in_all), 2, limits.iterates_per_run);
  std::string runs;
  std::size_t numbers = 0, left_out = 0;
  for (const IteratesFile& file : files) {
    numbers += file.numbers_each * std::min(most, file.num_lines);
    if (numbers > 2 * limits.curve_numbers) {
      ++left_out;
      continue;
    }
    std::vector<ShownIterate> iterates;
    if (!ReadKept(file, most, &iterates, error)) return false;
    runs += (runs.empty() ? "\"" : ",\"") + file.key + "\":" + RunJson(file, iterates);
  }
  if (left_out > 0) {
    notes->push_back("iterates of " + std::to_string(left_out) + " runs are not in the page");
  }
  *json = "{\"runs\":{" + runs + "},\"problems\":" + settings.all().dump() + "}";
  return true;
}

}  // namespace batten
