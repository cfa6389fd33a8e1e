# Writes report_assets.h, which holds the files of the page as they stand:
#   cmake -DOUTPUT=... -DFILES="a;b" -P embed.cmake
# Raw strings, which the compiler reads much faster than lists of bytes.
set(texts "")
set(table "")
set(index 0)
foreach(file IN LISTS FILES)
  file(READ "${file}" text)
  if(text MATCHES "\\)batten_asset\"")
    message(FATAL_ERROR "${file} holds the end of a raw string")
  endif()
  get_filename_component(name "${file}" NAME)
  string(APPEND texts "inline constexpr char kAsset${index}[] = R\"batten_asset(${text})batten_asset\";\n")
  string(APPEND table "    {\"${name}\", kAsset${index}, sizeof(kAsset${index}) - 1},\n")
  math(EXPR index "${index} + 1")
endforeach()
file(WRITE "${OUTPUT}" "#include <cstddef>

// Longer than the standard makes compilers take; GCC and Clang take them.
#pragma GCC diagnostic ignored \"-Woverlength-strings\"

namespace batten {

struct ReportAssetText {
  const char* name;
  const char* text;
  std::size_t size;
};

${texts}
inline constexpr ReportAssetText kReportAssets[] = {
${table}};

}  // namespace batten
")
