#ifndef BATTEN_EXPERIMENTS_CONTENT_HASH_H_
#define BATTEN_EXPERIMENTS_CONTENT_HASH_H_

#include <cstdint>
#include <string>

namespace batten {

/// FNV-1a over what is added, one after the other: whether two results were made of the same
/// things. No protection against somebody who wants two things to look alike.
class ContentHash {
 public:
  void AddBytes(const char* bytes, std::size_t count);
  void Add(const std::string& text) { AddBytes(text.data(), text.size()); }
  /// All bytes of the file; one that cannot be read adds nothing.
  void AddFile(const std::string& path);

  std::uint64_t value() const { return hash_; }
  std::string Digits() const;

 private:
  std::uint64_t hash_ = 14695981039346656037ULL;
};

/// 16 hexadecimal ones.
std::string HexDigits(std::uint64_t value);

/// Of all bytes of a file. Read once in the life of the program: many keys share one file, which
/// may be large.
const std::string& FileDigits(const std::string& path);
/// Of the file of the running program.
const std::string& ProgramDigits();

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_CONTENT_HASH_H_
