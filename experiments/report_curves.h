#ifndef BATTEN_EXPERIMENTS_REPORT_CURVES_H_
#define BATTEN_EXPERIMENTS_REPORT_CURVES_H_

#include <string>
#include <vector>

#include "experiments/report_cells.h"
#include "experiments/report_document.h"

namespace batten {

/// What the player of the page needs: for the rows whose FOLDER/iterates/KEY.jsonl is there, some
/// control points, as whole multiples of 1e-4 of their problem's size; for their problems
/// FOLDER/curves/PROBLEM.json as it stands. One JSON object. Runs beyond limits.curve_numbers are
/// left out with a note. False with one sentence in `error` for a broken file.
bool ReadReportCurves(const std::string& folder, const std::vector<OrderedJson>& cells,
                      const ReportLimits& limits, std::string* json,
                      std::vector<std::string>* notes, std::string* error);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_REPORT_CURVES_H_
