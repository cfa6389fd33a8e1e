#include <algorithm>
#include <set>

#include "cost_functions/term.h"
#include "experiments/bench_problem.h"
#include "experiments/bench_suite.h"
#include "problems/strict_json.h"

namespace batten {

bool ReadBenchTerms(const StrictObject& file, BenchSuite* suite) {
  std::vector<std::string> texts = {"own"};
  if (!file.Texts("terms", StrictObject::Presence::kOptional, &texts)) return false;
  std::set<std::string> labels;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const std::string place = "terms/" + std::to_string(i);
    BenchTerms terms;
    std::string why;
    if (texts[i] != "own" && !ParseNameSpecList(texts[i], &terms.terms, &why)) {
      return file.Complain(place, why);
    }
    for (const NameSpec& term : terms.terms) {
      // Kinds of parameters have different distances, with like options.
      NameSpec checked = term;
      if (checked.name == "distance") checked.name = "interpolation";
      if (TermRegistry::Global().Find(checked.name) == nullptr) {
        std::vector<std::string> names = TermRegistry::Global().Names();
        names.insert(names.end(), {"distance", "own"});
        return file.Complain(place, UnknownNameMessage("term", checked.name, names));
      }
      const Term* found = nullptr;
      OptionValues options;
      if (!TermRegistry::Global().Resolve(checked, &found, &options, &why)) {
        return file.Complain(place, why);
      }
      // Labels are cells of tables.
      terms.label += (terms.label.empty() ? "" : "+") + term.ToString();
    }
    if (terms.terms.empty()) terms.label = "own";
    if (!labels.insert(terms.label).second) {
      return file.Refuse(place, "each choice of terms once");
    }
    suite->terms.push_back(std::move(terms));
  }
  return true;
}

bool CheckRepeatedTerms(const StrictObject& file, const BenchSuite& suite) {
  const std::vector<BenchProblem>& problems = suite.problems;
  for (std::size_t t = 1; t < suite.terms.size(); ++t) {
    for (std::size_t before = 0; before < t; ++before) {
      const bool are_same =
          std::all_of(problems.begin(), problems.end(), [&](const BenchProblem& problem) {
            return TermsIdentity(problem, suite.terms[t]) ==
                   TermsIdentity(problem, suite.terms[before]);
          });
      if (!are_same) continue;
      return file.Complain("terms/" + std::to_string(t),
                           "found " + suite.terms[t].label +
                               ", on every problem here the same as " + suite.terms[before].label +
                               " of /terms/" + std::to_string(before) +
                               "; allowed: each choice of terms once");
    }
  }
  return true;
}

}  // namespace batten
