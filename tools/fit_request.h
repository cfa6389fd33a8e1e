#ifndef BATTEN_TOOLS_FIT_REQUEST_H_
#define BATTEN_TOOLS_FIT_REQUEST_H_

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiments/fairing_choice.h"
#include "problems/catalogue.h"
#include "problems/fit_problem.h"
#include "tools/flags.h"

namespace batten {

/// What `fit` is asked to fit, as far as it is known before the data are read.
struct FitRequest {
  FitSpec spec;
  CatalogueEntry entry;                  // its data_path "-": standard input
  std::string label;                     // what the summary calls it
  std::string source;                    // the file of data or of the problem, for messages
  std::vector<std::string> input_files;  // all that are read: none of them may be an output
};

/// Flags that say what is fitted: --problem, --closed, --degree, --control_points, --parameters,
/// --knots, --ends, --domain, --terms, --start, --max_distance and more.
std::vector<FlagInfo> FitRequestFlags();

/// From those flags and the positional FILE; a flag that is given overrides the named problem's
/// value. Reads problem and knot files, not the data. False with one sentence in `error`.
bool MakeFitRequest(const std::vector<std::string>& positional, FitRequest* request,
                    std::string* error);

/// Reads the data and makes the problem; null with one sentence in `error`.
std::unique_ptr<Problem> LoadFit(const FitRequest& request, std::optional<FairingChoice>* choice,
                                 std::string* error);

}  // namespace batten

#endif  // BATTEN_TOOLS_FIT_REQUEST_H_
