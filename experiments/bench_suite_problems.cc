#include <algorithm>
#include <nlohmann/json.hpp>

#include "cost_functions/options.h"
#include "experiments/bench_suite.h"
#include "problems/data_folders.h"
#include "problems/strict_json.h"

namespace batten {
namespace {

using Presence = StrictObject::Presence;

/// What a problem's grid holds; an empty list leaves the base's value.
struct Grid {
  std::vector<int> control_points;
  std::vector<int> degrees;
  std::vector<std::string> kinds;
};

bool ReadKinds(const StrictObject& object, std::vector<std::string>* kinds) {
  const std::vector<std::string> words = {"fixed", "free", "projected"};
  if (!object.IsList("parameter_kind")) {
    std::string kind;
    if (!object.Word("parameter_kind", Presence::kOptional, words, &kind)) return false;
    if (!kind.empty()) *kinds = {kind};
    return true;
  }
  if (!object.Texts("parameter_kind", Presence::kRequired, kinds)) return false;
  for (std::size_t i = 0; i < kinds->size(); ++i) {
    if (std::find(words.begin(), words.end(), (*kinds)[i]) == words.end()) {
      return object.Complain("parameter_kind/" + std::to_string(i),
                             UnknownNameMessage("kind of parameters", (*kinds)[i], words));
    }
  }
  return true;
}

bool ReadName(const StrictObject& object, StrictObject::Presence presence, std::string* name) {
  constexpr char kCharacters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  if (!object.Text("name", presence, name)) return false;
  return name->find_first_not_of(kCharacters) == std::string::npos ||
         object.Refuse("name", "letters, digits, _ and -");
}

bool ReadGrid(const StrictObject& object, Grid* grid) {
  return object.Integers("control_points", Presence::kOptional, 1, kMaxControlPoints,
                         &grid->control_points) &&
         object.Integers("degree", Presence::kOptional, 1, kMaxDegree, &grid->degrees) &&
         ReadKinds(object, &grid->kinds) &&
         object.IsWithoutRepeats("control_points", grid->control_points) &&
         object.IsWithoutRepeats("degree", grid->degrees) &&
         object.IsWithoutRepeats("parameter_kind", grid->kinds);
}

/// What may be said of any problem beside its grid.
bool ReadDetails(const StrictObject& object, FitSpec* spec) {
  return object.Word("start", Presence::kOptional, {"data", "centroid", "circle", "ellipse"},
                     &spec->start) &&
         object.Flag("hold_ends", Presence::kOptional, &spec->hold_ends) &&
         object.Flag("keep_order", Presence::kOptional, &spec->keep_order);
}

bool ReadParameters(const StrictObject& object, FitSpec* spec) {
  std::string rule = spec->parameters.has_value() ? ToString(*spec->parameters) : "given";
  if (!object.Word("parameters", Presence::kOptional,
                   {"uniform", "chord_length", "centripetal", "given"}, &rule)) {
    return false;
  }
  Parameterization read = Parameterization::kUniform;
  spec->parameters.reset();
  if (FromString(rule, &read)) spec->parameters = read;
  return true;
}

bool ReadDataProblem(const StrictObject& object, const std::string& suite_path,
                     CatalogueEntry* entry) {
  std::string file;
  if (!object.Text("data", Presence::kRequired, &file) ||
      !ReadName(object, Presence::kRequired, &entry->name) ||
      !object.Flag("closed", Presence::kOptional, &entry->spec.closed)) {
    return false;
  }
  entry->data_path = FindDataFile(file, suite_path);
  entry->path = suite_path;
  if (!entry->data_path.empty()) return true;
  return object.Refuse("data", AllowedDataFiles(file, suite_path));
}

bool ReadSynthetic(const StrictObject& object, CatalogueEntry* entry, SyntheticTruth* truth) {
  constexpr int kMostPoints = 10'000'000;
  constexpr double kMostNoise = 1.0;
  if (!object.Word("synthetic", Presence::kRequired, {"star", "wave"}, &truth->shape) ||
      !ReadName(object, Presence::kRequired, &entry->name) ||
      !object.Integer("points", Presence::kRequired, 2, kMostPoints, &truth->points) ||
      !object.Number("noise", Presence::kOptional, 0.0, kMostNoise, &truth->noise)) {
    return false;
  }
  entry->spec.closed = truth->shape == "star";
  entry->spec.parameters.reset();  // its own column t
  entry->spec.domain = {0.0, 1.0};
  return true;
}

bool ReadBase(const StrictObject& object, const std::string& suite_path, BenchProblem* base,
              std::string* error) {
  std::vector<std::string> sources;
  for (const char* key : {"problem", "data", "synthetic"}) {
    if (object.Has(key)) sources.emplace_back(key);
  }
  if (sources.size() != 1) {
    return object.Complain("", "found " + std::to_string(sources.size()) +
                                   " of the keys problem, data, synthetic; allowed: one of them");
  }
  const std::vector<std::string> grid = {"control_points", "degree", "parameter_kind", "name"};
  std::vector<std::string> known = {sources[0]};
  known.insert(known.end(), grid.begin(), grid.end());
  for (const char* key : {"start", "hold_ends", "keep_order"}) known.emplace_back(key);
  if (sources[0] != "synthetic") known.emplace_back("parameters");
  if (sources[0] == "data") known.emplace_back("closed");
  if (sources[0] == "synthetic") known.insert(known.end(), {"points", "noise"});
  if (!object.HasOnly(known)) return false;
  if (sources[0] == "data") return ReadDataProblem(object, suite_path, &base->entry);
  if (sources[0] == "synthetic") {
    base->truth.emplace();
    return ReadSynthetic(object, &base->entry, &*base->truth);
  }
  std::string name;
  if (!object.Text("problem", Presence::kRequired, &name)) return false;
  if (!FindProblem(name, &base->entry, error)) return object.Complain("problem", *error);
  return ReadName(object, Presence::kOptional, &base->entry.name);
}

/// One problem per point of the grid; what stands in a list of several is part of its label.
void Spread(const BenchProblem& base, const Grid& grid, std::vector<BenchProblem>* problems) {
  const std::vector<int> counts = grid.control_points.empty()
                                      ? std::vector<int>{base.entry.spec.control_points}
                                      : grid.control_points;
  const std::vector<int> degrees =
      grid.degrees.empty() ? std::vector<int>{base.entry.spec.degree} : grid.degrees;
  const std::vector<std::string> kinds =
      grid.kinds.empty() ? std::vector<std::string>{ToString(base.entry.spec.parameter_kind)}
                         : grid.kinds;
  for (const int count : counts) {
    for (const int degree : degrees) {
      for (const std::string& kind : kinds) {
        BenchProblem problem = base;
        FitSpec* const spec = &problem.entry.spec;
        spec->control_points = count;
        spec->degree = degree;
        const ParameterKind before = spec->parameter_kind;
        FromString(kind, &spec->parameter_kind);
        // The distance of another kind is another term.
        if (spec->parameter_kind != before) problem.own_terms.clear();
        problem.label = base.entry.name;
        if (counts.size() > 1) problem.label += "/control_points=" + std::to_string(count);
        if (degrees.size() > 1) problem.label += "/degree=" + std::to_string(degree);
        if (kinds.size() > 1) problem.label += "/kind=" + kind;
        spec->name = problem.entry.name = problem.label;
        problems->push_back(std::move(problem));
      }
    }
  }
}

}  // namespace

bool ReadBenchProblems(const StrictObject& entry, const std::string& suite_path,
                       const std::string& place, std::vector<BenchProblem>* problems,
                       std::string* error) {
  BenchProblem base;
  base.place = place;
  std::string name;
  if (entry.IsText(&name)) {
    if (!FindProblem(name, &base.entry, error)) return entry.Complain("", *error);
    base.label = base.entry.name;
    base.own_terms = base.entry.spec.terms;
    problems->push_back(std::move(base));
    return true;
  }
  if (!entry.IsObject()) {
    return entry.Refuse("", "a name of the catalogue, a problem file, or an object");
  }
  Grid grid;
  if (!entry.HasOnly({"problem", "data", "synthetic", "name", "control_points", "degree",
                      "parameter_kind", "parameters", "closed", "start", "hold_ends", "keep_order",
                      "points", "noise"}) ||
      !ReadBase(entry, suite_path, &base, error)) {
    return false;
  }
  base.own_terms = base.entry.spec.terms;
  if (!ReadGrid(entry, &grid) || !ReadDetails(entry, &base.entry.spec) ||
      (!base.truth && !ReadParameters(entry, &base.entry.spec))) {
    return false;
  }
  const bool has_knots = !base.entry.spec.given_knots.empty();
  for (const char* key : {"control_points", "degree"}) {
    if (has_knots && entry.Has(key)) {
      return entry.Refuse(key, "nothing, where the problem's knots are given");
    }
  }
  if (base.entry.spec.control_points == 0 && grid.control_points.empty()) {
    return entry.Refuse("control_points", "a whole number, or a list of them");
  }
  const std::size_t first = problems->size();
  Spread(base, grid, problems);
  for (std::size_t k = first; k < problems->size(); ++k) {
    // Data are made on the spline's own knots, before anything else could see that there are none.
    const FitSpec& spec = (*problems)[k].entry.spec;
    if (!base.truth || spec.closed || spec.control_points > spec.degree) continue;
    return entry.Refuse("control_points", "more than the degree, " + std::to_string(spec.degree));
  }
  return true;
}

}  // namespace batten
