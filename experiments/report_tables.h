#ifndef BATTEN_EXPERIMENTS_REPORT_TABLES_H_
#define BATTEN_EXPERIMENTS_REPORT_TABLES_H_

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/report_document.h"

namespace batten {

/// The CSV tables that stand in `folder` itself, but `skipped` ones: a list of {"name", "columns",
/// "rows", "num_rows"}; rows beyond the limits are left out. Lines that begin with # are comments.
/// False with `FILE:LINE: ...` for a row of another length than the header's.
bool ReadReportTables(const std::string& folder, const std::vector<std::string>& skipped,
                      const ReportLimits& limits, nlohmann::ordered_json* tables,
                      std::vector<std::string>* notes, std::string* error);

/// The SVG files that stand in `folder` itself: a list of {"name", "svg", "data"}, the last the
/// file NAME.dat that was plotted, where there is one; what is beyond the limit is named in the
/// notes.
bool ReadReportPictures(const std::string& folder, const ReportLimits& limits,
                        nlohmann::ordered_json* pictures, std::vector<std::string>* notes,
                        std::string* error);

/// What the pages that `reproduce` has written into `folder` (experiments/reproduction_page.cc) say
/// beside their tables: a list of {"title", "sections": [{"title", "claims": [{"quote", "verdict",
/// "because", "rule"}], "pictures": [{"name", "caption"}], "tables": [names]}]}.
bool ReadReproductionPages(const std::string& folder, nlohmann::ordered_json* pages,
                           std::string* error);

/// The files of `folder` itself with this ending (".csv"), by name.
std::vector<std::string> FilesEndingIn(const std::string& folder, const std::string& ending);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_REPORT_TABLES_H_
