#ifndef BATTEN_TOOLS_REPORT_PAGE_H_
#define BATTEN_TOOLS_REPORT_PAGE_H_

#include <string>

#include "experiments/report_document.h"

namespace batten {

/// A file of tools/report/, compiled into the program so that it needs no installed files. CHECK:
/// there is one of this name.
std::string ReportAsset(const std::string& name);

/// The page: one HTML file that asks for no other.
std::string ReportPage(const ReportDocument& document);

/// JSON that can stand in a <script> element: `<` and the line ends U+2028, U+2029 are escaped, so
/// that no text in it ends the element or begins a comment.
std::string JsonForScript(const std::string& json);

}  // namespace batten

#endif  // BATTEN_TOOLS_REPORT_PAGE_H_
