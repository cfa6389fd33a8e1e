#ifndef BATTEN_EXPERIMENTS_REPORT_PLOTS_H_
#define BATTEN_EXPERIMENTS_REPORT_PLOTS_H_

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/report_document.h"

namespace batten {

/// The files STEM.plot.json of `folder` (docs/formats.md) into `plots`, {STEM: [panels]}, numbers
/// to six digits and long series thinned, which the notes say; the titles of the panels into the
/// picture STEM.svg of `pictures`, which is added where gnuplot has drawn none. False with one
/// sentence in `error` (`FILE: /panels/0/...: found ...; allowed: ...`) for a file that is no plot.
bool ReadReportPlots(const std::string& folder, const ReportLimits& limits,
                     nlohmann::ordered_json* pictures, std::string* plots,
                     std::vector<std::string>* notes, std::string* error);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_REPORT_PLOTS_H_
