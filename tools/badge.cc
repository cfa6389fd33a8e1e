#include "tools/badge.h"

#include <nlohmann/json.hpp>

namespace batten {
namespace {

std::string Escaped(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    escaped += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  }
  return escaped;
}

std::string Field(int begin, int width, const char* colour, const std::string& text) {
  const std::string x = std::to_string(begin);
  const std::string middle = std::to_string(begin + width / 2);
  return "<rect x=\"" + x + "\" width=\"" + std::to_string(width) + "\" height=\"20\" fill=\"" +
         colour + "\"/>\n<text x=\"" + middle + "\" y=\"14\">" + Escaped(text) + "</text>\n";
}

/// Of 11 px Verdana and its like, a little more than it takes.
int WidthOf(const std::string& text) {
  constexpr int kPixels = 7;
  constexpr int kMargins = 12;
  return kPixels * static_cast<int>(text.size()) + kMargins;
}

}  // namespace

std::string BadgeSvg(const std::string& label, const std::string& message, bool is_good) {
  const int left = WidthOf(label);
  const int right = WidthOf(message);
  const std::string title = Escaped(label + ": " + message);
  // White on these has a contrast above 4.5.
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + std::to_string(left + right) +
         "\" height=\"20\" role=\"img\" aria-label=\"" + title + "\">\n<title>" + title +
         "</title>\n<g fill=\"#fff\" text-anchor=\"middle\" "
         "font-family=\"Verdana,DejaVu Sans,sans-serif\" font-size=\"11\">\n" +
         Field(0, left, "#555", label) +
         Field(left, right, is_good ? "#2a7d2a" : "#b3261e", message) + "</g>\n</svg>\n";
}

std::string BadgeJson(const std::string& label, const std::string& message, bool is_good) {
  const nlohmann::ordered_json json = {{"schemaVersion", 1},
                                       {"label", label},
                                       {"message", message},
                                       {"color", is_good ? "success" : "critical"},
                                       {"isError", !is_good}};
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace batten
