#ifndef BATTEN_EXPERIMENTS_GUARDED_VECTOR_H_
#define BATTEN_EXPERIMENTS_GUARDED_VECTOR_H_

#include <Eigen/Core>

namespace batten {

/// A vector at the end of pages of its own, with one behind them that must not be touched: who
/// reads far past its end gets a segmentation fault. What stands between is given by
/// SetNumbersBehind(): of 512 k - 3 numbers it is one. For processes that are there for nothing
/// else: it changes how the C library hands out memory. Only with glibc's allocator, which works()
/// says.
class GuardedVector {
 public:
  explicit GuardedVector(const Eigen::VectorXd& values);
  ~GuardedVector();
  GuardedVector(const GuardedVector&) = delete;
  GuardedVector& operator=(const GuardedVector&) = delete;

  bool works() const { return guard_ != nullptr; }
  Eigen::VectorXd* vector() { return &vector_; }
  void SetNumbersBehind(double value);

 private:
  Eigen::VectorXd vector_;
  void* guard_ = nullptr;
};

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_GUARDED_VECTOR_H_
