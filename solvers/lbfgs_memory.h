#ifndef BATTEN_SOLVERS_LBFGS_MEMORY_H_
#define BATTEN_SOLVERS_LBFGS_MEMORY_H_

#include <Eigen/Core>
#include <vector>

namespace batten {

/// The last pairs s = x+ - x, y = g+ - g and the product of the inverse Hessian they stand for: the
/// two-loop recursion (Nocedal, Math. Comp. 35, 1980; Nocedal & Wright, algorithm 7.4), H0 the
/// identity until there is a pair, then s'y / y'y times it.
class LbfgsMemory {
 public:
  explicit LbfgsMemory(int capacity) : capacity_(capacity) {}

  void Clear();
  /// False, and nothing kept, where s'y is not safely positive.
  bool Add(const Eigen::VectorXd& s, const Eigen::VectorXd& y);
  /// direction = -H g.
  void Direction(const Eigen::VectorXd& gradient, Eigen::VectorXd* direction);
  int size() const { return size_; }

  std::vector<double> ToNumbers() const;
  void FromNumbers(const std::vector<double>& numbers, Eigen::Index num_variables);

 private:
  struct Pair {
    Eigen::VectorXd s;
    Eigen::VectorXd y;
    double sy = 0.0;
    double alpha = 0.0;
  };
  /// k = 0 is the newest pair.
  Pair& Newest(int k) {
    return pairs_[static_cast<std::size_t>((next_ + capacity_ - 1 - k) % capacity_)];
  }

  int capacity_;
  int size_ = 0;
  int next_ = 0;
  double scale_ = 1.0;  // s'y / y'y of the newest pair
  std::vector<Pair> pairs_ = std::vector<Pair>(static_cast<std::size_t>(capacity_));
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_LBFGS_MEMORY_H_
