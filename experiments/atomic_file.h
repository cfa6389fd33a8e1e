#ifndef BATTEN_EXPERIMENTS_ATOMIC_FILE_H_
#define BATTEN_EXPERIMENTS_ATOMIC_FILE_H_

#include <list>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

namespace batten {

/// A file that appears whole or not at all: written to a temporary in the same folder, which takes
/// the place of `path` in Commit(). A symbolic link stays, its target is replaced; the permissions
/// of a replaced file are kept. What is no regular file (/dev/null, /dev/stdout, a pipe) is written
/// directly, after what it holds. Failures are one sentence: `cannot write PATH: REASON`.
class AtomicFile {
 public:
  AtomicFile();
  ~AtomicFile();  ///< Without a successful Commit() nothing is left behind.
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Does not create folders. A file that was open and not committed is given up.
  bool Open(const std::string& path, std::string* error);
  /// Fails (badbit) where no file is open and after a write error, which Commit() then reports.
  std::ostream& stream() { return stream_; }
  /// Needs an open file. On failure `path` is as it was before, and the file is no longer open.
  bool Commit(std::string* error);
  /// Where its contents are before Commit(), for a program that is to read them: flush first.
  const std::string& place() const { return temporary_.empty() ? path_ : temporary_; }

 private:
  friend class FileBatch;
  class Buffer;

  bool Finish(std::string* error);                  // on the disk, under the temporary name
  bool TakePlace(std::string* error);               // the caller holds the lock on the temporaries
  bool Fail(int error_number, std::string* error);  // gives up; always false
  void GiveUp();

  std::string path_;       // as the user wrote it
  std::string target_;     // behind symbolic links
  std::string temporary_;  // empty while writing directly
  std::unique_ptr<Buffer> buffer_;
  std::ostream stream_{nullptr};
};

/// Files that appear together: what can fail is done for all before the first takes its place, and
/// an interrupted program (RemovePendingTemporaryFiles) leaves either none of them or all.
class FileBatch {
 public:
  /// The new file, which the batch owns; null with one sentence in `error`.
  AtomicFile* Open(const std::string& path, std::string* error);
  /// The same, filled with `contents`.
  AtomicFile* Write(const std::string& path, const std::string& contents, std::string* error);
  /// What stands at `path` is out of date: Commit() takes it away.
  void Remove(const std::string& path) { removals_.push_back(path); }
  bool Commit(std::string* error);

 private:
  std::list<AtomicFile> files_;
  std::vector<std::string> removals_;
};

/// The file is no regular one, or one that a shell has opened for us: written directly.
bool IsWrittenDirectly(const std::string& path);

bool WriteFileAtomically(const std::string& path, const std::string& contents, std::string* error);

/// The folder `path` and those it stands in; true if it is there already, and for an empty path.
bool CreateDirectories(const std::string& path, std::string* error);

/// Removes the temporaries of all AtomicFiles of this process that are open, whose Commit() then
/// fails; for an interrupted program on its way out. Takes a lock: not for signal handlers.
void RemovePendingTemporaryFiles();

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_ATOMIC_FILE_H_
