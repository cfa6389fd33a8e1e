#include "solvers/lbfgs_memory.h"

#include <cmath>
#include <limits>

namespace batten {

void LbfgsMemory::Clear() {
  size_ = 0;
  next_ = 0;
  scale_ = 1.0;
}

bool LbfgsMemory::Add(const Eigen::VectorXd& s, const Eigen::VectorXd& y) {
  const double sy = s.dot(y);
  const double yy = y.squaredNorm();
  // Below this the curvature along s is rounding noise. The cosine, so that no unit matters.
  const double noise = std::numeric_limits<double>::epsilon() * s.norm() * std::sqrt(yy);
  if (!(sy > noise)) return false;
  Pair& pair = pairs_[static_cast<std::size_t>(next_)];
  pair.s = s;
  pair.y = y;
  pair.sy = sy;
  scale_ = sy / yy;
  next_ = (next_ + 1) % capacity_;
  if (size_ < capacity_) ++size_;
  return true;
}

void LbfgsMemory::Direction(const Eigen::VectorXd& gradient, Eigen::VectorXd* direction) {
  *direction = -gradient;
  for (int k = 0; k < size_; ++k) {
    Pair& pair = Newest(k);
    pair.alpha = pair.s.dot(*direction) / pair.sy;
    direction->noalias() -= pair.alpha * pair.y;
  }
  *direction *= scale_;
  for (int k = size_ - 1; k >= 0; --k) {
    const Pair& pair = Newest(k);
    const double beta = pair.y.dot(*direction) / pair.sy;
    direction->noalias() += (pair.alpha - beta) * pair.s;
  }
}

std::vector<double> LbfgsMemory::ToNumbers() const {
  std::vector<double> numbers;
  for (int k = size_ - 1; k >= 0; --k) {
    const Pair& pair = const_cast<LbfgsMemory*>(this)->Newest(k);
    numbers.insert(numbers.end(), pair.s.data(), pair.s.data() + pair.s.size());
    numbers.insert(numbers.end(), pair.y.data(), pair.y.data() + pair.y.size());
  }
  return numbers;
}

void LbfgsMemory::FromNumbers(const std::vector<double>& numbers, Eigen::Index num_variables) {
  Clear();
  const double* end = numbers.data() + numbers.size();
  for (const double* at = numbers.data(); at + 2 * num_variables <= end; at += 2 * num_variables) {
    Add(Eigen::Map<const Eigen::VectorXd>(at, num_variables),
        Eigen::Map<const Eigen::VectorXd>(at + num_variables, num_variables));
  }
}

}  // namespace batten
