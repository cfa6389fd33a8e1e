#include "experiments/atomic_file.h"

#include <fcntl.h>
#include <glog/logging.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <locale>
#include <map>
#include <mutex>
#include <streambuf>
#include <system_error>
#include <vector>

namespace batten {
namespace {

std::mutex& PendingMutex() {
  static auto& mutex = *new std::mutex;  // never destroyed: exit handlers may still come here
  return mutex;
}

// With the process that made each: a forked child must not remove its parent's files.
std::map<std::string, pid_t>& Pending() {
  static auto& pending = *new std::map<std::string, pid_t>;
  return pending;
}

// The caller holds the lock. A file that has taken its place is there no longer under this name.
void RemoveTemporary(const std::string& temporary) {
  const auto entry = Pending().find(temporary);
  if (entry == Pending().end()) return;
  if (entry->second == getpid()) unlink(temporary.c_str());
  Pending().erase(entry);
}

// Creates a new file beside `target`, which the lock keeps from going unlisted; -1 with errno.
int OpenTemporary(const std::string& target, std::string* temporary) {
  static std::atomic<unsigned> counter{0};
  const std::filesystem::path whole(target);
  // A name may have 255 bytes; the ending needs up to 24.
  const std::string name = whole.filename().string().substr(0, 220);
  const std::lock_guard<std::mutex> lock(PendingMutex());
  for (int attempt = 0; attempt < 1000; ++attempt) {
    const std::string unique =
        name + "." + std::to_string(getpid()) + "-" + std::to_string(counter++) + ".tmp";
    *temporary = (whole.parent_path() / unique).string();
    // 0666, not mkstemp's 0600: the user's umask decides, as for every other file.
    const int file = open(temporary->c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file >= 0) Pending()[*temporary] = getpid();
    if (file >= 0 || errno != EEXIST) return file;
  }
  return -1;
}

std::string WithoutLinks(const std::string& path) {
  char* const resolved = realpath(path.c_str(), nullptr);
  if (resolved == nullptr) return path;
  std::string result = resolved;
  free(resolved);
  return result;
}

// The descriptor that `path` names; -1: none. Opened anew, a regular file behind it would be
// written from its beginning by whoever still uses the descriptor.
int StandardStream(const std::string& path) {
  if (path == "/dev/stdout") return STDOUT_FILENO;
  if (path == "/dev/stderr") return STDERR_FILENO;
  for (const std::string folder : {"/dev/fd/", "/proc/self/fd/"}) {
    int number = -1;
    const char* const end = path.data() + path.size();
    if (path.rfind(folder, 0) != 0) continue;
    const auto read = std::from_chars(path.data() + folder.size(), end, number);
    if (read.ec == std::errc() && read.ptr == end && number >= 0) return number;
  }
  return -1;
}

int OpenDirectly(const std::string& path) {
  const int stream = StandardStream(path);
  if (stream >= 0) return fcntl(stream, F_DUPFD_CLOEXEC, 0);
  return open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
}

}  // namespace

class AtomicFile::Buffer : public std::streambuf {
 public:
  explicit Buffer(int file) : file_(file), bytes_(size_t{1} << 16) { Restart(); }
  ~Buffer() override { Close(); }

  int file() const { return file_; }
  int error_number() const { return error_number_; }

  void Synchronize() {
    sync();
    // Pipes and terminals have nothing to synchronize and say EINVAL.
    if (error_number_ == 0 && fsync(file_) != 0 && errno != EINVAL && errno != ENOTSUP) {
      error_number_ = errno;
    }
  }

  void Close() {
    if (file_ >= 0 && close(file_) != 0 && error_number_ == 0 && errno != EINTR) {
      error_number_ = errno;
    }
    file_ = -1;
  }

 protected:
  int_type overflow(int_type character) override {
    if (sync() != 0) return traits_type::eof();
    if (!traits_type::eq_int_type(character, traits_type::eof())) {
      *pptr() = traits_type::to_char_type(character);
      pbump(1);
    }
    return traits_type::not_eof(character);
  }

  int sync() override {
    const char* from = pbase();
    while (error_number_ == 0 && from != pptr()) {
      const ssize_t written = write(file_, from, static_cast<size_t>(pptr() - from));
      if (written >= 0) {
        from += written;
      } else if (errno != EINTR) {
        error_number_ = errno;
      }
    }
    Restart();
    return error_number_ == 0 ? 0 : -1;
  }

 private:
  void Restart() { setp(bytes_.data(), bytes_.data() + bytes_.size()); }

  int file_;
  int error_number_ = 0;  // of the first failure: after a gap the rest of a file is worthless
  std::vector<char> bytes_;
};

AtomicFile::AtomicFile() = default;

AtomicFile::~AtomicFile() { GiveUp(); }

bool AtomicFile::Open(const std::string& path, std::string* error) {
  GiveUp();
  path_ = path;
  target_ = WithoutLinks(path);
  struct stat status;
  const bool exists = stat(path.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) return Fail(EISDIR, error);
  if (!exists && errno != ENOENT) return Fail(errno, error);
  if (!exists && std::filesystem::path(path).filename().empty()) return Fail(ENOENT, error);
  int file = -1;
  if (exists && IsWrittenDirectly(path)) {
    file = OpenDirectly(path);
  } else {
    // Renaming would get past the write protection of the file itself.
    if (exists && access(path.c_str(), W_OK) != 0) return Fail(errno, error);
    file = OpenTemporary(target_, &temporary_);
  }
  if (file < 0) {
    const int error_number = errno;
    temporary_.clear();
    return Fail(error_number, error);
  }
  buffer_ = std::make_unique<Buffer>(file);
  // Some file systems know no permissions; then there are none to keep.
  if (exists && !temporary_.empty() && fchmod(file, status.st_mode & 07777) != 0 &&
      errno != EPERM && errno != ENOTSUP) {
    return Fail(errno, error);
  }
  stream_.rdbuf(buffer_.get());
  stream_.imbue(std::locale::classic());
  return true;
}

bool AtomicFile::Commit(std::string* error) {
  if (!Finish(error)) return false;
  const std::lock_guard<std::mutex> lock(PendingMutex());
  return TakePlace(error);
}

bool AtomicFile::Finish(std::string* error) {
  CHECK(buffer_ != nullptr) << "no open file to commit";
  const bool stream_was_good = !stream_.fail();
  buffer_->Synchronize();
  buffer_->Close();
  if (buffer_->error_number() != 0) return Fail(buffer_->error_number(), error);
  return stream_was_good || Fail(EIO, error);
}

bool AtomicFile::TakePlace(std::string* error) {
  const bool is_there = temporary_.empty() || rename(temporary_.c_str(), target_.c_str()) == 0;
  const int error_number = errno;
  RemoveTemporary(temporary_);
  temporary_.clear();
  if (!is_there) return Fail(error_number, error);
  GiveUp();
  return true;
}

bool AtomicFile::Fail(int error_number, std::string* error) {
  *error = "cannot write " + path_ + ": " + std::strerror(error_number);
  GiveUp();
  return false;
}

void AtomicFile::GiveUp() {
  stream_.rdbuf(nullptr);
  buffer_.reset();
  if (temporary_.empty()) return;
  const std::lock_guard<std::mutex> lock(PendingMutex());
  RemoveTemporary(temporary_);
  temporary_.clear();
}

AtomicFile* FileBatch::Open(const std::string& path, std::string* error) {
  AtomicFile* const file = &files_.emplace_back();
  if (file->Open(path, error)) return file;
  files_.pop_back();
  return nullptr;
}

AtomicFile* FileBatch::Write(const std::string& path, const std::string& contents,
                             std::string* error) {
  AtomicFile* const file = Open(path, error);
  if (file == nullptr) return nullptr;
  file->stream().write(contents.data(), static_cast<std::streamsize>(contents.size()));
  if (file->stream().flush()) return file;
  file->Finish(error);  // says why
  files_.pop_back();
  return nullptr;
}

bool FileBatch::Commit(std::string* error) {
  for (AtomicFile& file : files_) {
    if (!file.Finish(error)) return false;
  }
  const std::lock_guard<std::mutex> lock(PendingMutex());
  for (AtomicFile& file : files_) {
    if (!file.TakePlace(error)) return false;
  }
  for (const std::string& path : removals_) unlink(path.c_str());
  files_.clear();
  removals_.clear();
  return true;
}

bool IsWrittenDirectly(const std::string& path) {
  struct stat status;
  if (stat(path.c_str(), &status) != 0 || S_ISDIR(status.st_mode)) return false;
  return !S_ISREG(status.st_mode) || StandardStream(path) >= 0;
}

bool WriteFileAtomically(const std::string& path, const std::string& contents, std::string* error) {
  AtomicFile file;
  if (!file.Open(path, error)) return false;
  file.stream().write(contents.data(), static_cast<std::streamsize>(contents.size()));
  return file.Commit(error);
}

bool CreateDirectories(const std::string& path, std::string* error) {
  if (path.empty()) return true;
  std::error_code code;
  std::filesystem::create_directories(path, code);
  if (!code && !std::filesystem::is_directory(path, code) && !code) {
    code = std::make_error_code(std::errc::not_a_directory);
  }
  if (!code) return true;
  *error = "cannot create folder " + path + ": " + code.message();
  return false;
}

void RemovePendingTemporaryFiles() {
  const std::lock_guard<std::mutex> lock(PendingMutex());
  for (const auto& [temporary, process] : Pending()) {
    if (process == getpid()) unlink(temporary.c_str());
  }
  Pending().clear();
}

}  // namespace batten
