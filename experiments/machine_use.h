#ifndef BATTEN_EXPERIMENTS_MACHINE_USE_H_
#define BATTEN_EXPERIMENTS_MACHINE_USE_H_

#include <string>

namespace batten {

/// Says, while it lives, that this program measures times on this machine, and sees whether others
/// do: a shared advisory lock on one file. Nobody waits for anybody. Processes that this one forks
/// are no others, and hold on until they end. Where the file cannot be made or has no locks, nobody
/// is seen.
class MachineUse {
 public:
  /// batten_measures.lock in the temporary folder, for all users who share that.
  static std::string DefaultPath();

  explicit MachineUse(const std::string& path = DefaultPath());
  ~MachineUse();
  MachineUse(const MachineUse&) = delete;
  MachineUse& operator=(const MachineUse&) = delete;

  /// At this moment.
  bool OthersMeasure() const;

 private:
  int file_ = -1;
};

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_MACHINE_USE_H_
