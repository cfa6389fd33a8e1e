#ifndef BATTEN_TESTS_TOOLS_PAGE_TEXT_H_
#define BATTEN_TESTS_TOOLS_PAGE_TEXT_H_

#include <string>

namespace batten {

/// What stands in the <script> element `id` of a report page.
inline std::string ScriptText(const std::string& page, const std::string& id) {
  const std::string open = "<script type=\"application/json\" id=\"" + id + "\">";
  const std::size_t begin = page.find(open) + open.size();
  return page.substr(begin, page.find("</script>", begin) - begin);
}

}  // namespace batten

#endif  // BATTEN_TESTS_TOOLS_PAGE_TEXT_H_
