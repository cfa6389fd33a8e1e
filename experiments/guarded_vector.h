#ifndef BATTEN_EXPERIMENTS_GUARDED_VECTOR_H_
#define BATTEN_EXPERIMENTS_GUARDED_VECTOR_H_

#include <Eigen/Core>

namespace batten {

/// A vector of 512 k - 3 numbers with a page behind it that must not be touched: who reads two or
/// more numbers past its end gets a segmentation fault. The one number between is given by
/// SetNumberBehind(). For processes that are there for nothing else: it changes how the C library
/// hands out memory. Only with glibc's allocator, which works() says.
class GuardedVector {
 public:
  explicit GuardedVector(const Eigen::VectorXd& values);
  ~GuardedVector();
  GuardedVector(const GuardedVector&) = delete;
  GuardedVector& operator=(const GuardedVector&) = delete;

  bool works() const { return guard_ != nullptr; }
  Eigen::VectorXd* vector() { return &vector_; }
  void SetNumberBehind(double value);

 private:
  Eigen::VectorXd vector_;
  void* guard_ = nullptr;
};

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_GUARDED_VECTOR_H_
