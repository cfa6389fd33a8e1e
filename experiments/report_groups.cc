#include "experiments/report_groups.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

namespace batten {
namespace {

void AddFacts(const BenchFacts& bench, const std::string& key, ReportGroup* group) {
  const auto Take = [&key](const std::map<std::string, double>& facts, double* value) {
    const auto found = facts.find(key);
    if (found != facts.end()) *value = found->second;
  };
  Take(bench.unit_seconds, &group->unit_seconds);
  Take(bench.truth, &group->truth);
  Take(bench.num_variables, &group->num_variables);
  const auto basin = bench.best.find(key);
  if (basin != bench.best.end()) group->best = std::min(group->best, basin->second);
}

}  // namespace

ReportGroups FindReportGroups(const std::vector<OrderedJson>& cells,
                              const std::vector<ReportTrace>& traces, const BenchFacts& bench) {
  ReportGroups groups;
  std::map<std::string, std::size_t> places;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const OrderedJson& cell = cells[k];
    OrderedJson names = OrderedJson::object();
    for (const char* field : {"problem", "terms", "data_seed", "start_seed"}) {
      if (cell.contains(field)) names[field] = cell[field];
    }
    const std::size_t place = places.emplace(names.dump(), groups.list.size()).first->second;
    if (place == groups.list.size()) {
      groups.list.emplace_back();
      groups.list.back().names = std::move(names);
    }
    groups.of_cell.push_back(place);
    ReportGroup& group = groups.list[place];
    const double direct = NumberField(cell, "minimum_energy");
    if (std::isfinite(direct)) group.direct = std::min(group.direct, direct);
    AddFacts(bench, TextField(cell, "key"), &group);
    const double energy = NumberField(cell, "energy");
    if (std::isfinite(energy)) group.lowest = std::min(group.lowest, energy);
    for (const ReportTrace::Row& row : traces[k].rows) {
      if (std::isfinite(row.energy)) group.lowest = std::min(group.lowest, row.energy);
    }
  }
  return groups;
}

OrderedJson GroupsJson(const ReportGroups& groups) {
  OrderedJson json = OrderedJson::array();
  for (const ReportGroup& group : groups.list) {
    OrderedJson shown = group.names;
    shown["minimum"] = std::isfinite(group.minimum()) ? OrderedJson(group.minimum()) : nullptr;
    shown["direct"] = group.is_direct();
    shown["basins"] = group.has_basins();
    for (const auto& [name, value] : {std::pair{"unit_seconds", group.unit_seconds},
                                      {"truth", group.truth},
                                      {"num_variables", group.num_variables}}) {
      if (std::isfinite(value)) shown[name] = value;
    }
    json.push_back(std::move(shown));
  }
  return json;
}

}  // namespace batten
