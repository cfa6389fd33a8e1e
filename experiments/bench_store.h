#ifndef BATTEN_EXPERIMENTS_BENCH_STORE_H_
#define BATTEN_EXPERIMENTS_BENCH_STORE_H_

#include <chrono>
#include <functional>
#include <string>

namespace batten {

/// A file of lines that only grows: a line is on it whole or not at all, whatever ends the program.
/// One program at a time writes it.
class AppendOnlyFile {
 public:
  AppendOnlyFile() = default;
  ~AppendOnlyFile();
  AppendOnlyFile(const AppendOnlyFile&) = delete;
  AppendOnlyFile& operator=(const AppendOnlyFile&) = delete;

  /// Opens or creates `path`, cuts off a last line without its end, and hands the others to `read`.
  /// False with one sentence in `error`, also where another program has it open.
  bool Open(const std::string& path, const std::function<void(const std::string&)>& read,
            std::string* error);
  /// Adds the line and its end. On failure, as on a full disk, the file is as it was before. On the
  /// disk itself it is with the next SyncWhenDue() after half a second, or Sync().
  bool Append(const std::string& line, std::string* error);
  bool Sync(std::string* error);
  /// Sync(), where a line has waited for half a second.
  bool SyncWhenDue(std::string* error);

 private:
  using Clock = std::chrono::steady_clock;
  bool Lock(std::string* error);

  std::string path_;
  int file_ = -1;
  long size_ = 0;
  Clock::time_point synced_;
  bool is_dirty_ = false;
};

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_BENCH_STORE_H_
