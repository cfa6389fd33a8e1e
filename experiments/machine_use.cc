#include "experiments/machine_use.h"

#include <fcntl.h>
#include <unistd.h>

#include <filesystem>
#include <system_error>

namespace batten {
namespace {

struct flock WholeFile(short type) {
  struct flock lock = {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  return lock;
}

/// To be read, which is enough for a shared lock: what another user has made in a folder for all
/// may not be opened otherwise.
int OpenOrMake(const std::string& path) {
  constexpr int kFlags = O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;
  const int file = open(path.c_str(), kFlags);
  if (file >= 0) return file;
  const int made = open(path.c_str(), kFlags | O_CREAT | O_EXCL, 0644);
  return made >= 0 ? made : open(path.c_str(), kFlags);
}

}  // namespace

std::string MachineUse::DefaultPath() {
  std::error_code none;
  return (std::filesystem::temp_directory_path(none) / "batten_measures.lock").string();
}

MachineUse::MachineUse(const std::string& path) : file_(OpenOrMake(path)) {
  struct flock lock = WholeFile(F_RDLCK);
  // Of the open file, not of the process: what it forks holds it too, and is not another.
  if (file_ >= 0) fcntl(file_, F_OFD_SETLK, &lock);
}

MachineUse::~MachineUse() {
  if (file_ >= 0) close(file_);
}

bool MachineUse::OthersMeasure() const {
  struct flock lock = WholeFile(F_WRLCK);
  return file_ >= 0 && fcntl(file_, F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
}

}  // namespace batten
