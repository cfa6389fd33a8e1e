#include "tools/report_page.h"

#include <glog/logging.h>

#include "tools/report_assets.h"

namespace batten {
namespace {

/// Puts `text` in the place of the one `{{name}}` of the template; texts are not looked into.
std::string Filled(const std::string& page, const ReportDocument& document) {
  std::string result;
  std::size_t begin = 0;
  while (true) {
    const std::size_t open = page.find("{{", begin);
    if (open == std::string::npos) return result + page.substr(begin);
    const std::size_t close = page.find("}}", open);
    CHECK_NE(close, std::string::npos);
    const std::string name = page.substr(open + 2, close - open - 2);
    result.append(page, begin, open - begin);
    if (name == "summary") {
      result += JsonForScript(document.summary);
    } else if (name == "traces") {
      result += JsonForScript(document.traces);
    } else if (name == "curves") {
      result += JsonForScript(document.curves);
    } else if (name == "plots") {
      result += JsonForScript(document.plots);
    } else {
      result += ReportAsset(name);
    }
    begin = close + 2;
  }
}

}  // namespace

std::string ReportAsset(const std::string& name) {
  for (const ReportAssetText& asset : kReportAssets) {
    if (name == asset.name) return std::string(asset.text, asset.size);
  }
  LOG(FATAL) << "no asset " << name;
}

std::string JsonForScript(const std::string& json) {
  std::string text;
  text.reserve(json.size());
  for (std::size_t k = 0; k < json.size(); ++k) {
    const bool is_line_end = json.compare(k, 2, "\xe2\x80") == 0 && k + 2 < json.size() &&
                             (json[k + 2] == '\xa8' || json[k + 2] == '\xa9');
    if (json[k] == '<') {
      text += "\\u003c";
    } else if (is_line_end) {
      text += json[k + 2] == '\xa8' ? "\\u2028" : "\\u2029";
      k += 2;
    } else {
      text += json[k];
    }
  }
  return text;
}

std::string ReportPage(const ReportDocument& document) {
  return Filled(ReportAsset("template.html"), document);
}

}  // namespace batten
