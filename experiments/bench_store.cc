#include "experiments/bench_store.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

namespace batten {
namespace {

std::string Failure(const std::string& path, int error_number) {
  return "cannot write " + path + ": " + std::strerror(error_number);
}

}  // namespace

AppendOnlyFile::~AppendOnlyFile() {
  std::string ignored;
  if (file_ >= 0 && is_dirty_) Sync(&ignored);
  if (file_ >= 0) close(file_);
}

/// A killed program's last child may hold the lock for as long as it takes to die.
bool AppendOnlyFile::Lock(std::string* error) {
  constexpr int kAttempts = 100;
  constexpr int kPause = 20'000;  // microseconds
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    if (flock(file_, LOCK_EX | LOCK_NB) == 0) return true;
    if (errno != EWOULDBLOCK && errno != EINTR) return true;  // a file system without locks
    usleep(kPause);
  }
  *error = path_ + ": another program writes it; allowed: one at a time";
  return false;
}

bool AppendOnlyFile::Open(const std::string& path,
                          const std::function<void(const std::string&)>& read, std::string* error) {
  path_ = path;
  file_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  struct stat status {};
  if (file_ < 0 || fstat(file_, &status) != 0) {
    *error = Failure(path, errno);
    return false;
  }
  if (!S_ISREG(status.st_mode)) {
    *error = "cannot write " + path + ": it is no regular file";
    return false;
  }
  if (!Lock(error)) return false;
  std::ifstream lines(path, std::ios::binary);
  for (std::string line; std::getline(lines, line);) {
    if (lines.eof()) break;  // no end of line: torn
    size_ += static_cast<long>(line.size()) + 1;
    read(line);
  }
  if (ftruncate(file_, size_) != 0 || lseek(file_, 0, SEEK_END) < 0) {
    *error = Failure(path, errno);
    return false;
  }
  synced_ = Clock::now();
  return true;
}

bool AppendOnlyFile::Append(const std::string& line, std::string* error) {
  const std::string text = line + "\n";
  for (std::size_t begin = 0; begin < text.size();) {
    const ssize_t written = write(file_, text.data() + begin, text.size() - begin);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      *error = Failure(path_, errno);
      const bool is_cut = ftruncate(file_, size_) == 0 && lseek(file_, size_, SEEK_SET) >= 0;
      if (!is_cut) *error += "; its last line is torn";
      return false;
    }
    begin += static_cast<std::size_t>(written);
  }
  size_ += static_cast<long>(text.size());
  is_dirty_ = true;
  return SyncWhenDue(error);
}

bool AppendOnlyFile::SyncWhenDue(std::string* error) {
  // A sync can take longer than a small cell.
  constexpr auto kInterval = std::chrono::milliseconds(500);
  return !is_dirty_ || Clock::now() - synced_ < kInterval || Sync(error);
}

bool AppendOnlyFile::Sync(std::string* error) {
  synced_ = Clock::now();
  is_dirty_ = false;
  if (fdatasync(file_) == 0 || errno == EINVAL || errno == ENOTSUP) return true;
  *error = Failure(path_, errno);
  return false;
}

}  // namespace batten
