#ifndef BATTEN_PROBLEMS_PROBLEM_REGISTRY_H_
#define BATTEN_PROBLEMS_PROBLEM_REGISTRY_H_

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "problems/fit_problem.h"

namespace batten {

/// A problem whose data are made by a program, not read from a file.
struct NamedProblem {
  std::string name;
  std::string summary;   ///< One line.
  std::string citation;  ///< Where it is from.
  FitSpec spec;
  /// The same data at each call; nothing, with one sentence in `error`, where it has none.
  std::function<std::optional<DataSet>(std::string* error)> make_data;
  std::string plugin;  ///< The file that it comes from; filled in when it is registered.
};

/// Problems that plugins bring: they stand in the catalogue beside its files.
class ProblemRegistry {
 public:
  static ProblemRegistry& Global();
  void Register(NamedProblem problem);
  std::vector<std::string> Names() const;
  const NamedProblem* Find(const std::string& name) const;  ///< Null for an unknown name.

 private:
  std::map<std::string, NamedProblem> problems_;
};

}  // namespace batten

#endif  // BATTEN_PROBLEMS_PROBLEM_REGISTRY_H_
