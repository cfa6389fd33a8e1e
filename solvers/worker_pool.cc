#include "solvers/worker_pool.h"

namespace batten {

WorkerPool::WorkerPool(int threads) {
  for (int k = 1; k < threads; ++k) workers_.emplace_back([this, k] { Work(k); });
}

WorkerPool::~WorkerPool() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    call_ = nullptr;
    ++round_;
  }
  begins_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void WorkerPool::Share(Call call, const void* body) {
  if (workers_.empty()) return call(body, 0);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    call_ = call;
    body_ = body;
    num_busy_ = static_cast<int>(workers_.size());
    ++round_;
  }
  begins_.notify_all();
  call(body, 0);
  std::unique_lock<std::mutex> lock(mutex_);
  ends_.wait(lock, [this] { return num_busy_ == 0; });
}

void WorkerPool::Work(int k) {
  for (long seen = 0;;) {
    std::unique_lock<std::mutex> lock(mutex_);
    begins_.wait(lock, [&] { return round_ != seen; });
    seen = round_;
    const Call call = call_;
    const void* const body = body_;
    lock.unlock();
    if (call == nullptr) return;
    call(body, k);
    lock.lock();
    const bool is_last = --num_busy_ == 0;
    lock.unlock();
    if (is_last) ends_.notify_one();
  }
}

}  // namespace batten
