#ifndef BATTEN_TOOLS_INTERRUPTS_H_
#define BATTEN_TOOLS_INTERRUPTS_H_

namespace batten {

/// From now on SIGINT, SIGTERM and SIGHUP end the program with status 130 after its temporary files
/// are removed: at once outside an InterruptibleRun; inside one the first asks the runs to end
/// (run.h) and only the second ends the program at once. A signal that is ignored (nohup) stays so.
/// SIGPIPE and SIGXFSZ are ignored: a reader that has gone and a file that must not grow are errors
/// of the write. Call once, before other threads start.
void HandleInterrupts();

/// The stretch of work that watches InterruptRequested() by itself.
class InterruptibleRun {
 public:
  InterruptibleRun();
  ~InterruptibleRun();
  InterruptibleRun(const InterruptibleRun&) = delete;
  InterruptibleRun& operator=(const InterruptibleRun&) = delete;
};

}  // namespace batten

#endif  // BATTEN_TOOLS_INTERRUPTS_H_
