#include "problems/input_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <system_error>

#include "cost_functions/options.h"

namespace batten {

bool OpenInput(const std::string& path, std::ifstream* file, std::string* error) {
  std::error_code ignored;
  errno = 0;
  // A folder can be opened and fails only when read, with a message of the C++ library's own.
  if (std::filesystem::is_directory(path, ignored)) {
    errno = EISDIR;
  } else {
    file->open(path, std::ios::binary);
  }
  if (file->is_open()) return true;
  *error = CannotBeRead(path, errno);
  if (errno == ENOENT) *error += NearestFileText(path);
  return false;
}

std::string NearestFileText(const std::string& path) {
  namespace fs = std::filesystem;
  constexpr std::size_t kMostFiles = 10'000;
  const fs::path asked(path);
  const fs::path folder = asked.parent_path();
  std::vector<std::string> names;
  std::error_code code;
  fs::directory_iterator file(folder.empty() ? "." : folder, code);
  for (; !code && file != fs::directory_iterator() && names.size() < kMostFiles;
       file.increment(code)) {
    std::error_code ignored;
    const fs::path& name = file->path().filename();
    const bool may_be_meant = AreNear(name, asked.filename()) && !file->is_directory(ignored);
    if (may_be_meant) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  const std::string nearest = NearestName(asked.filename(), names);
  return nearest.empty() ? "" : "; did you mean " + (folder / nearest).string() + "?";
}

std::string CannotBeRead(const std::string& file, int error_number) {
  return file + ": cannot be read: " + std::strerror(error_number == 0 ? EIO : error_number);
}

bool LineReader::Next(std::string_view* line) {
  const char* newline = nullptr;
  while ((newline = FindNewline()) == nullptr && !at_end_) Fill();
  const size_t end = newline == nullptr ? end_ : static_cast<size_t>(newline - buffer_.data());
  is_too_long_ = end - begin_ > longest_line_;
  if (has_failed() || begin_ == end_) return false;
  ++number_;
  if (is_too_long_) return false;
  *line = std::string_view(buffer_.data() + begin_, end - begin_);
  begin_ = std::min(end + 1, end_);
  searched_ = begin_;
  if (number_ == 1 && line->substr(0, 3) == "\xEF\xBB\xBF") line->remove_prefix(3);
  if (!line->empty() && line->back() == '\r') line->remove_suffix(1);
  return true;
}

const char* LineReader::FindNewline() {
  const char* const data = buffer_.data();
  const void* const found = std::memchr(data + searched_, '\n', end_ - searched_);
  searched_ = end_;
  return static_cast<const char*>(found);
}

void LineReader::Fill() {
  std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  searched_ = end_;
  // A line without an end in more than is allowed is given up: the file may be endless.
  if (end_ > longest_line_) {
    at_end_ = true;
    return;
  }
  if (buffer_.size() < end_ + kChunk) buffer_.resize(2 * buffer_.size());
  errno = 0;
  stream_->read(buffer_.data() + end_, static_cast<std::streamsize>(kChunk));
  const int error_number = errno;
  end_ += static_cast<size_t>(stream_->gcount());
  // std::cin reads through stdin and takes its errors for the end.
  const bool has_failed = stream_->bad() || (stream_ == &std::cin && std::ferror(stdin) != 0);
  if (has_failed) error_number_ = error_number == 0 ? EIO : error_number;
  at_end_ = !stream_->good();
}

bool ReadWholeFile(const std::string& path, std::string* contents, std::string* error) {
  std::ifstream file;
  if (!OpenInput(path, &file, error)) return false;
  contents->assign(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  if (file.bad()) *error = CannotBeRead(path, errno);
  return !file.bad();
}

}  // namespace batten
