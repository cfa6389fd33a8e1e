#ifndef BATTEN_SOLVERS_WORKER_POOL_H_
#define BATTEN_SOLVERS_WORKER_POOL_H_

#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

namespace batten {

/// Threads that wait for work: passes over the data, each too short for threads of its own, are
/// shared without making one and without an allocation.
class WorkerPool {
 public:
  /// `threads` >= 1 in all: with 1 there are none but the caller's.
  explicit WorkerPool(int threads);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  int num_threads() const { return static_cast<int>(workers_.size()) + 1; }
  /// Calls body(k), which must not throw, for k = 0..num_threads() - 1, each on its own thread,
  /// number 0 on the caller's, and waits for all. From one thread at a time.
  template <typename Body>
  void Run(const Body& body) {
    Share([](const void* shared, int k) { (*static_cast<const Body*>(shared))(k); }, &body);
  }

 private:
  using Call = void (*)(const void* body, int k);
  void Share(Call call, const void* body);
  void Work(int k);

  std::mutex mutex_;
  std::condition_variable begins_;
  std::condition_variable ends_;
  Call call_ = nullptr;  // null: no more work will come
  const void* body_ = nullptr;
  long round_ = 0;
  int num_busy_ = 0;
  std::vector<std::thread> workers_;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_WORKER_POOL_H_
