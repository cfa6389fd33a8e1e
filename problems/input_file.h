#ifndef BATTEN_PROBLEMS_INPUT_FILE_H_
#define BATTEN_PROBLEMS_INPUT_FILE_H_

#include <cstdint>
#include <fstream>
#include <istream>
#include <string>
#include <string_view>
#include <vector>

namespace batten {

/// Opens `path` to be read as bytes; false with one sentence in `error`, for a folder too.
bool OpenInput(const std::string& path, std::ifstream* file, std::string* error);

/// All bytes of a file that must be short: a page, a picture, a table. False where OpenInput or
/// reading fails.
bool ReadWholeFile(const std::string& path, std::string* contents, std::string* error);

/// "; did you mean FILE?" where a file of its folder has nearly the name of `path`, which is not
/// there; else empty.
std::string NearestFileText(const std::string& path);

/// `FILE: cannot be read: REASON`.
std::string CannotBeRead(const std::string& file, int error_number);

inline constexpr size_t kLongestLine = size_t{1} << 20;  // bytes

/// Hands out the lines of a stream without their ends, the first without a byte-order mark; holds
/// 2 MiB, and more only while a line is longer. The stream may be endless.
class LineReader {
 public:
  /// `longest_line` is in bytes, at least 1.
  explicit LineReader(std::istream* stream, size_t longest_line = kLongestLine)
      : stream_(stream), longest_line_(longest_line), buffer_(2 * kChunk) {}

  /// False at the end, after a read error and at a line longer than the longest.
  bool Next(std::string_view* line);

  int64_t number() const { return number_; }  ///< Of the line handed out last, from 1.
  bool has_failed() const { return error_number_ != 0; }
  int error_number() const { return error_number_; }  ///< errno of the read error.
  bool is_too_long() const { return is_too_long_; }

 private:
  static constexpr size_t kChunk = size_t{1} << 20;

  const char* FindNewline();
  void Fill();

  std::istream* const stream_;
  const size_t longest_line_;
  std::vector<char> buffer_;
  size_t begin_ = 0;     // of what has not been handed out
  size_t searched_ = 0;  // no newline in [begin_, searched_)
  size_t end_ = 0;
  int64_t number_ = 0;
  bool at_end_ = false;
  int error_number_ = 0;
  bool is_too_long_ = false;
};

}  // namespace batten

#endif  // BATTEN_PROBLEMS_INPUT_FILE_H_
