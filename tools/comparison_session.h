#ifndef BATTEN_TOOLS_COMPARISON_SESSION_H_
#define BATTEN_TOOLS_COMPARISON_SESSION_H_

#include <memory>
#include <string>
#include <vector>

#include "experiments/comparison.h"
#include "problems/catalogue.h"
#include "tools/command.h"
#include "tools/comparison_cells.h"
#include "tools/progress.h"

namespace batten {

/// A problem to compare on, checked before anything runs.
struct Contest {
  std::string written;  // name or path, by the user
  CatalogueEntry entry;
  std::shared_ptr<const Problem> problem;
};

/// Where a comparison is written, and how it shows.
struct ComparisonFiles {
  std::string folder;  // empty: nowhere
  bool figures = true;
  bool resume = false;
  bool strict = false;
  bool quiet = false;
};

/// The comparison, problem by problem, so that what is finished is written.
class ComparisonSession {
 public:
  ComparisonSession(std::vector<Contest> contests, ComparisonSpec spec, ComparisonFiles files);

  /// Makes the folder and tries all files in it, before anything runs.
  bool Prepare(std::string* error) const;
  /// An exit status.
  int Run(CommandOutput* output);

 private:
  std::string InFolder(const std::string& name) const;
  std::vector<std::string> TableFiles() const;
  std::vector<std::string> FigureFiles(const std::string& problem) const;
  int EndEarly(size_t num_finished, CommandOutput* output);
  bool RunOrTakeOver(size_t index, Progress* progress, ComparisonResult* result,
                     std::string* error);
  bool RunOne(size_t index, Progress* progress, ComparisonResult* result, std::string* error);
  bool HasFigures(const std::string& problem) const;
  void Add(size_t index, ComparisonResult result);
  bool WriteProblem(size_t index, const ComparisonResult& result, std::string* error);
  bool DrawFigures(const ComparisonResult& result, FileBatch* batch, std::string* error);
  bool WriteTables(std::string* error) const;
  std::string FileList() const;
  int Judge(CommandOutput* output) const;

  std::vector<Contest> contests_;
  ComparisonSpec spec_;
  ComparisonFiles files_;
  ComparisonCells cells_;
  ComparisonResult all_;
  std::vector<std::string> notes_;
  std::string not_drawn_;  // the first picture that gnuplot owes, and why
};

}  // namespace batten

#endif  // BATTEN_TOOLS_COMPARISON_SESSION_H_
