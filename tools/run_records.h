#ifndef BATTEN_TOOLS_RUN_RECORDS_H_
#define BATTEN_TOOLS_RUN_RECORDS_H_

#include <string>

#include "experiments/atomic_file.h"
#include "experiments/comparison.h"
#include "problems/catalogue.h"

namespace batten {

/// Whether the folders of the records below, as far as they are there, can be written into.
bool CheckRunRecords(const std::string& folder, const ComparisonSpec& spec, std::string* error);

/// What belongs to the rows of one problem but does not fit into them: FOLDER/traces/KEY.csv and,
/// with spec.kept_iterates, FOLDER/iterates/KEY.jsonl of each run that was not skipped, and
/// FOLDER/curves/PROBLEM.json, the spline and the data points to show iterates by. Makes the
/// folders.
bool WriteRunRecords(const CatalogueEntry& entry, const ComparisonResult& result,
                     const std::string& folder, FileBatch* batch, std::string* error);

/// Whether they are all there for rows that were read back.
bool HasRunRecords(const CatalogueEntry& entry, const ComparisonResult& result,
                   const ComparisonSpec& spec, const std::string& folder);

}  // namespace batten

#endif  // BATTEN_TOOLS_RUN_RECORDS_H_
