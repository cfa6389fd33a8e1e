#include "experiments/report_plots.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "experiments/plot_file.h"
#include "experiments/report_cells.h"
#include "experiments/report_tables.h"
#include "experiments/report_traces.h"
#include "problems/input_file.h"

namespace batten {
namespace {

namespace fs = std::filesystem;

constexpr char kEnding[] = ".plot.json";

struct PlotFile {
  std::string stem;
  OrderedJson panels;
};

bool IsListOfNumbers(const OrderedJson& list) {
  return list.is_array() && std::all_of(list.begin(), list.end(), [](const OrderedJson& entry) {
           return entry.is_number() || entry.is_null();
         });
}

/// The first field of `json` that is not as it has to be, with what may stand there.
class FieldCheck {
 public:
  explicit FieldCheck(std::string place) : place_(std::move(place)) {}

  void Is(const OrderedJson& json, const char* field, bool (OrderedJson::*is_type)() const noexcept,
          const char* allowed) {
    Expect(json.contains(field) && (json[field].*is_type)(), field, allowed);
  }
  void Expect(bool holds, const std::string& field, const char* allowed) {
    if (holds || !wrong_.empty()) return;
    wrong_ = place_ + "/" + field + ": found another thing or nothing; allowed: " + allowed;
  }
  const std::string& wrong() const { return wrong_; }

 private:
  std::string place_;
  std::string wrong_;
};

std::string WrongInSeries(const OrderedJson& series, const std::string& place) {
  FieldCheck check(place);
  if (!series.is_object()) return place + ": found no object; allowed: a series";
  check.Is(series, "label", &OrderedJson::is_string, "text");
  check.Is(series, "color", &OrderedJson::is_number_integer, "a whole number");
  PlotSeries::Style style;
  check.Expect(FromString(TextField(series, "style"), &style), "style",
               "line, points, line_points, dashed, circles, one_of_many");
  for (const char* side : {"x", "mark_x"}) {
    const std::string across = side;
    const std::string up = across == "x" ? "y" : "mark_y";
    if (across != "x" && !series.contains(across)) continue;
    const bool are_lists = series.contains(across) && series.contains(up) &&
                           IsListOfNumbers(series[across]) && IsListOfNumbers(series[up]);
    check.Expect(are_lists && series[across].size() == series[up].size(), across,
                 "two lists of as many numbers");
  }
  return check.wrong();
}

std::string WrongInPanel(const OrderedJson& panel, const std::string& place) {
  FieldCheck check(place);
  if (!panel.is_object()) return place + ": found no object; allowed: a panel";
  for (const char* text : {"title", "x_label", "y_label"}) {
    check.Is(panel, text, &OrderedJson::is_string, "text");
  }
  for (const char* word : {"log_x", "log_y", "equal_scale", "is_share", "legend"}) {
    check.Is(panel, word, &OrderedJson::is_boolean, "true, false");
  }
  for (const char* list : {"x_names", "series"}) {
    check.Is(panel, list, &OrderedJson::is_array, "a list");
  }
  if (!check.wrong().empty()) return check.wrong();
  const OrderedJson& names = panel["x_names"];
  check.Expect(std::all_of(names.begin(), names.end(),
                           [](const OrderedJson& name) { return name.is_string(); }),
               "x_names", "texts");
  std::string wrong = check.wrong();
  for (std::size_t k = 0; wrong.empty() && k < panel["series"].size(); ++k) {
    wrong = WrongInSeries(panel["series"][k], place + "/series/" + std::to_string(k));
  }
  return wrong;
}

bool ReadPlot(const std::string& path, OrderedJson* panels, std::string* error) {
  std::string text;
  if (!ReadWholeFile(path, &text, error)) return false;
  OrderedJson json = OrderedJson::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object() || TextField(json, "format") != "batten.plot/1" ||
      !json.contains("panels") || !json["panels"].is_array()) {
    *error = path + ": found no plot; allowed: an object of format batten.plot/1 with panels";
    return false;
  }
  *panels = std::move(json["panels"]);
  for (std::size_t k = 0; k < panels->size(); ++k) {
    const std::string wrong = WrongInPanel((*panels)[k], "/panels/" + std::to_string(k));
    if (wrong.empty()) continue;
    *error = path + ": " + wrong;
    return false;
  }
  return true;
}

std::size_t NumPoints(const OrderedJson& panels, std::size_t most) {
  std::size_t sum = 0;
  for (const OrderedJson& panel : panels) {
    for (const OrderedJson& series : panel["series"]) sum += std::min(series["x"].size(), most);
  }
  return sum;
}

/// So many points of each series at most that all plots together stay below the limit.
std::size_t MostPoints(const std::vector<PlotFile>& files, const ReportLimits& limits) {
  constexpr std::size_t kFewest = 50;
  std::size_t most = limits.points_per_series;
  const auto all = [&files](std::size_t bound) {
    std::size_t sum = 0;
    for (const PlotFile& file : files) sum += NumPoints(file.panels, bound);
    return sum;
  };
  while (most > kFewest && all(most) > limits.plot_points) most = std::max(kFewest, most / 2);
  return most;
}

/// Evenly, the first and the last among them, as `[1,null,3]`.
std::string ThinnedList(const OrderedJson& list, std::size_t most) {
  const std::size_t count = std::min(list.size(), most);
  std::string text = "[";
  for (std::size_t j = 0; j < count; ++j) {
    const std::size_t k = list.size() <= most ? j : j * (list.size() - 1) / (most - 1);
    text += (j > 0 ? "," : "") + (list[k].is_null() ? "null" : PlotNumber(list[k].get<double>()));
  }
  return text + "]";
}

std::string Dumped(const OrderedJson& json) {
  return json.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
}

std::string PanelJson(const OrderedJson& panel, std::size_t most) {
  std::string text = "{";
  for (const char* field : {"title", "x_label", "y_label", "log_x", "log_y", "equal_scale",
                            "is_share", "legend", "x_names"}) {
    text += "\"" + std::string(field) + "\":" + Dumped(panel[field]) + ",";
  }
  text += "\"series\":[";
  bool is_first = true;
  for (const OrderedJson& series : panel["series"]) {
    text += is_first ? "{" : ",{";
    is_first = false;
    for (const char* field : {"label", "style", "color"}) {
      text += "\"" + std::string(field) + "\":" + Dumped(series[field]) + ",";
    }
    text += "\"num_points\":" + std::to_string(series["x"].size());
    for (const char* field : {"x", "y", "mark_x", "mark_y"}) {
      if (!series.contains(field)) continue;
      text += ",\"" + std::string(field) + "\":" + ThinnedList(series[field], most);
    }
    text += "}";
  }
  return text + "]}";
}

/// The entry of this picture; new where there is no SVG.
OrderedJson& PictureOf(const std::string& name, OrderedJson* pictures) {
  for (OrderedJson& picture : *pictures) {
    if (picture["name"] == name) return picture;
  }
  pictures->push_back({{"name", name}});
  return pictures->back();
}

}  // namespace

bool ReadReportPlots(const std::string& folder, const ReportLimits& limits, OrderedJson* pictures,
                     std::string* plots, std::vector<std::string>* notes, std::string* error) {
  std::vector<PlotFile> files;
  const std::string ending = kEnding;
  for (const std::string& name : FilesEndingIn(folder, ".json")) {
    if (name.size() <= ending.size()) continue;
    const std::size_t stem = name.size() - ending.size();
    if (name.compare(stem, ending.size(), ending) != 0) continue;
    files.push_back({name.substr(0, stem), {}});
    if (!ReadPlot((fs::path(folder) / name).string(), &files.back().panels, error)) return false;
  }
  const std::size_t most = MostPoints(files, limits);
  *plots = "{";
  for (const PlotFile& file : files) {
    OrderedJson titles = OrderedJson::array();
    std::string panels;
    for (const OrderedJson& panel : file.panels) {
      titles.push_back(panel["title"]);
      panels += (panels.empty() ? "" : ",") + PanelJson(panel, most);
    }
    *plots += (plots->size() > 1 ? "," : "") + Dumped(file.stem) + ":[" + panels + "]";
    PictureOf(file.stem + ".svg", pictures)["panels"] = std::move(titles);
    const std::size_t all = NumPoints(file.panels, SIZE_MAX), kept = NumPoints(file.panels, most);
    if (kept == all) continue;
    notes->push_back(file.stem + ": the plot has " + std::to_string(kept) + " of " +
                     std::to_string(all) + " points, spread evenly over each line; its picture " +
                     "and data have them all");
  }
  *plots += "}";
  return true;
}

}  // namespace batten
