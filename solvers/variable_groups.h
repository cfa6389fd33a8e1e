#ifndef BATTEN_SOLVERS_VARIABLE_GROUPS_H_
#define BATTEN_SOLVERS_VARIABLE_GROUPS_H_

#include <algorithm>
#include <vector>

namespace batten {

/// Disjoint groups of neighbouring variables: the parameter blocks of a ceres::Problem.
class VariableGroups {
 public:
  explicit VariableGroups(int num_variables)
      : begin_of_(static_cast<std::size_t>(num_variables), -1),
        size_at_(static_cast<std::size_t>(num_variables), 0) {}

  int num_variables() const { return static_cast<int>(size_at_.size()); }
  /// First variable of the group that `variable` belongs to; -1: of none.
  int begin_of(int variable) const { return begin_of_[static_cast<std::size_t>(variable)]; }
  /// Size of the group that begins at `variable`; 0: none does.
  int size_at(int variable) const { return size_at_[static_cast<std::size_t>(variable)]; }

  /// Adds variables begin..begin+size-1, again or for the first time. False, changing nothing, if
  /// they overlap another group.
  bool Add(int begin, int size) {
    if (size_at(begin) == size) return true;
    const auto first = begin_of_.begin() + begin;
    if (std::any_of(first, first + size, [](int taken) { return taken >= 0; })) return false;
    std::fill(first, first + size, begin);
    size_at_[static_cast<std::size_t>(begin)] = size;
    return true;
  }

 private:
  std::vector<int> begin_of_;
  std::vector<int> size_at_;
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_VARIABLE_GROUPS_H_
