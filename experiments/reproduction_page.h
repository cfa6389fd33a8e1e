#ifndef BATTEN_EXPERIMENTS_REPRODUCTION_PAGE_H_
#define BATTEN_EXPERIMENTS_REPRODUCTION_PAGE_H_

#include <string>
#include <vector>

#include "experiments/reproduction.h"

namespace batten {

/// The page in Markdown: verdicts first, then each experiment with text, claims, table, figures and
/// the names of its files.
std::string ReproductionMarkdown(const Reproduction& reproduction,
                                 const std::vector<ExperimentResult>& results);

/// `markdown` as one HTML page that needs no other file: pictures named in it are read from
/// `folder` and put in.
std::string SelfContainedHtml(const std::string& title, const std::string& markdown,
                              const std::string& folder);

/// FOLDER/NAME.md and FOLDER/NAME.html.
bool WritePage(const Reproduction& reproduction, const std::vector<ExperimentResult>& results,
               const std::string& folder, std::string* error);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_REPRODUCTION_PAGE_H_
