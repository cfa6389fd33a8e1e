#include "problems/svg_file.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <pugixml.hpp>
#include <string_view>

#include "cost_functions/options.h"
#include "problems/input_file.h"

namespace batten {
namespace {

constexpr std::string_view kGroups[] = {"svg", "g", "a", "switch"};
// SVG 1.1 and 2: "never rendered", descriptions, paint servers, animations.
constexpr std::string_view kNotDrawn[] = {
    "defs",      "symbol",        "clipPath",         "mask",
    "marker",    "pattern",       "linearGradient",   "filter",
    "title",     "desc",          "metadata",         "script",
    "animate",   "animateMotion", "animateTransform", "radialGradient",
    "set",       "view",          "cursor",           "font",
    "font-face", "color-profile", "solidcolor"};

template <std::size_t size>
bool IsOneOf(const std::string_view (&names)[size], std::string_view name) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

bool IsSpace(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }
bool IsBlank(std::string_view text) { return std::all_of(text.begin(), text.end(), &IsSpace); }
bool IsNameCharacter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_';
}

/// The value of a CSS property, up to `;` or `}`; null where `css` does not set it.
const char* FindProperty(std::string_view css, std::string_view property) {
  for (std::size_t at = css.find(property); at != std::string_view::npos;
       at = css.find(property, at + 1)) {
    if (at > 0 && IsNameCharacter(css[at - 1])) continue;
    std::size_t next = at + property.size();
    while (next < css.size() && IsSpace(css[next])) ++next;
    if (next == css.size() || css[next] != ':') continue;
    ++next;
    while (next < css.size() && IsSpace(css[next])) ++next;
    return css.data() + next;
  }
  return nullptr;
}

bool IsNone(const char* value) {
  constexpr std::string_view kNone = "none";
  return std::string_view(value).substr(0, kNone.size()) == kNone &&
         !IsNameCharacter(value[kNone.size()]);
}

/// Behind `svg:` or without a prefix; empty for elements of other namespaces.
std::string_view LocalName(const pugi::xml_node& node) {
  const std::string_view name = node.name();
  const std::size_t colon = name.find(':');
  if (colon == std::string_view::npos) return name;
  return name.substr(0, colon) == "svg" ? name.substr(colon + 1) : std::string_view();
}

bool IsHidden(const pugi::xml_node& node) {
  if (IsNone(node.attribute("display").value())) return true;
  const char* const display = FindProperty(node.attribute("style").value(), "display");
  return display != nullptr && IsNone(display);
}

/// Where a transform of `node` stands; null where there is none.
const char* TransformOf(const pugi::xml_node& node) {
  const char* const value = node.attribute("transform").value();
  if (!IsBlank(value) && !IsNone(value)) return value;
  const char* const property = FindProperty(node.attribute("style").value(), "transform");
  return property != nullptr && !IsNone(property) ? property : nullptr;
}

/// The next node of the document in its order, into `node` or past it.
pugi::xml_node Next(pugi::xml_node node, bool enters) {
  if (enters && node.first_child()) return node.first_child();
  while (node && !node.next_sibling()) node = node.parent();
  return node.next_sibling();
}

class SvgReader {
 public:
  SvgReader(const std::string& file, std::string text, std::vector<BezierPath>* paths,
            std::string* error)
      : file_(file), text_(std::move(text)), buffer_(text_), paths_(*paths), error_(*error) {}

  /// A file that holds nothing but path data.
  bool ReadPathData() { return Parse(text_, 0); }

  bool ReadElements() {
    pugi::xml_document document;
    // In place and with line ends as they stand, so that values keep their places in the file.
    const pugi::xml_parse_result parsed =
        document.load_buffer_inplace(buffer_.data(), buffer_.size(),
                                     pugi::parse_cdata | pugi::parse_escapes, pugi::encoding_utf8);
    if (!parsed) {
      return Fail(static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, parsed.offset)),
                  std::string("found XML that is not well-formed (") + parsed.description() +
                      "); allowed: an SVG file or path data alone");
    }
    const pugi::xml_node root = document.document_element();
    if (LocalName(root) != "svg") {
      return Fail(PlaceOf(root.name()),
                  "found the element " + Quoted(root.name(), kLongestQuote) + "; allowed: svg");
    }
    bool enters = true;
    for (pugi::xml_node node = root; node; node = Next(node, enters)) {
      enters = false;
      if (node.type() == pugi::node_element && !Visit(node, &enters)) return false;
    }
    return true;
  }

  std::string LeftOut() const {
    std::string text;
    for (const auto& [name, count] : left_out_) {
      text += (text.empty() ? "" : ", ") + name + " (" + std::to_string(count) + ")";
    }
    return text;
  }

 private:
  static constexpr std::size_t kLongestQuote = 20;

  bool Visit(const pugi::xml_node& node, bool* enters) {
    const std::string_view name = LocalName(node);
    if (name == "style") return CheckStyleSheet(node);
    if (name.empty() || IsOneOf(kNotDrawn, name) || IsHidden(node)) return true;
    *enters = IsOneOf(kGroups, name);
    if (*enters) return true;
    if (name == "path") return VisitPath(node);
    ++left_out_[std::string(name)];
    return true;
  }

  bool VisitPath(const pugi::xml_node& node) {
    const pugi::xml_attribute data = node.attribute("d");
    const std::string_view text = data.value();
    if (IsBlank(text) || IsNone(data.value())) return true;
    for (pugi::xml_node above = node; above.type() == pugi::node_element; above = above.parent()) {
      if (const char* const transform = TransformOf(above)) {
        return Fail(PlaceOf(transform), "found a transform; allowed: paths without one");
      }
      if (LocalName(above) == "svg" && above.parent().type() == pugi::node_element) {
        return Fail(PlaceOf(above.name()),
                    "found a path in an svg element inside another, which moves it; allowed: paths "
                    "of the outermost one");
      }
    }
    return Parse(text, PlaceOf(data.value()));
  }

  // Which elements its rules concern is not looked up.
  bool CheckStyleSheet(const pugi::xml_node& node) {
    for (const pugi::xml_node& text : node.children()) {
      const char* const value = FindProperty(text.value(), "transform");
      if (value == nullptr || IsNone(value)) continue;
      return Fail(PlaceOf(value),
                  "found a transform in a style sheet; allowed: style sheets without one");
    }
    return true;
  }

  bool Parse(std::string_view data, std::size_t begin) {
    std::size_t offset = 0;
    std::string reason;
    return ParseSvgPath(data, &paths_, &offset, &reason) || Fail(begin + offset, reason);
  }

  std::size_t PlaceOf(const char* in_buffer) const {
    return static_cast<std::size_t>(in_buffer - buffer_.data());
  }

  bool Fail(std::size_t offset, const std::string& sentence) {
    const std::string_view before = std::string_view(text_).substr(0, offset);
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const std::size_t newline = before.rfind('\n');
    const std::size_t column =
        before.size() - (newline == std::string_view::npos ? 0 : newline + 1) + 1;
    error_ = file_ + ":" + std::to_string(line) + ":" + std::to_string(column) + ": " + sentence;
    return false;
  }

  const std::string& file_;
  const std::string text_;
  std::string buffer_;  // the parser ends names and values in it
  std::vector<BezierPath>& paths_;
  std::string& error_;
  std::map<std::string, int> left_out_;
};

}  // namespace

bool ReadSvgPaths(const std::string& path, std::vector<BezierPath>* paths, std::string* left_out,
                  std::string* error) {
  std::string text;
  if (!ReadWholeFile(path, &text, error)) return false;
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.compare(0, kByteOrderMark.size(), kByteOrderMark) == 0) {
    text.erase(0, kByteOrderMark.size());
  }
  const auto first = std::find_if_not(text.begin(), text.end(), &IsSpace);
  const bool has_elements = first != text.end() && *first == '<';
  paths->clear();
  SvgReader reader(path, std::move(text), paths, error);
  if (!(has_elements ? reader.ReadElements() : reader.ReadPathData())) return false;
  *left_out = reader.LeftOut();
  if (!paths->empty()) return true;
  *error = path + ": found no path with a curve" + (left_out->empty() ? "" : " but " + *left_out) +
           "; allowed: <path d=\"M ... C ...\"/> or path data";
  return false;
}

}  // namespace batten
