#include "experiments/content_hash.h"

#include <cstdio>
#include <fstream>
#include <map>
#include <vector>

namespace batten {

void ContentHash::AddBytes(const char* bytes, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    hash_ = (hash_ ^ static_cast<unsigned char>(bytes[i])) * 1099511628211ULL;
  }
}

void ContentHash::AddFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> bytes(1 << 16);
  while (file.good()) {
    file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    AddBytes(bytes.data(), static_cast<std::size_t>(file.gcount()));
  }
}

std::string ContentHash::Digits() const { return HexDigits(hash_); }

std::string HexDigits(std::uint64_t value) {
  char digits[17];
  std::snprintf(digits, sizeof(digits), "%016llx", static_cast<unsigned long long>(value));
  return digits;
}

const std::string& FileDigits(const std::string& path) {
  static auto& known = *new std::map<std::string, std::string>;
  const auto [place, is_new] = known.try_emplace(path);
  if (is_new) {
    ContentHash hash;
    hash.AddFile(path);
    place->second = hash.Digits();
  }
  return place->second;
}

const std::string& ProgramDigits() { return FileDigits("/proc/self/exe"); }

}  // namespace batten
