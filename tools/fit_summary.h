#ifndef BATTEN_TOOLS_FIT_SUMMARY_H_
#define BATTEN_TOOLS_FIT_SUMMARY_H_

#include <string>
#include <vector>

#include "experiments/fit_report.h"

namespace batten {

/// The lines that `fit` prints: what was fitted, how the run ended, how good the curve is.
std::string FitSummary(const std::string& label, const Problem& problem, const RunResult& run,
                       const FitReport& report, const std::vector<std::string>& files);

/// The run reached what was asked: it says so itself (IsSuccess), or its line search or its library
/// ended it first and the audit finds |g| small enough: at most RunResult::line_search_floor, below
/// which a fall of E can no longer be seen in E itself, or what was asked, if that is more.
bool ReachedTarget(const RunResult& run, const RunSpec& spec, const FitReport& report);

/// One sentence for a run that did not.
std::string NotReachedMessage(const RunResult& run, const RunSpec& spec);

}  // namespace batten

#endif  // BATTEN_TOOLS_FIT_SUMMARY_H_
