#include "experiments/content_hash.h"

#include <cstdio>
#include <fstream>
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

void ContentHash::AddProgram() {
  static const std::string program = [] {
    ContentHash hash;
    hash.AddFile("/proc/self/exe");
    return hash.Digits();
  }();
  Add(program);
}

std::string ContentHash::Digits() const {
  char digits[17];
  std::snprintf(digits, sizeof(digits), "%016llx", static_cast<unsigned long long>(hash_));
  return digits;
}

}  // namespace batten
