#ifndef BATTEN_PROBLEMS_CONSTRAINT_ROWS_H_
#define BATTEN_PROBLEMS_CONSTRAINT_ROWS_H_

#include <string>
#include <utility>
#include <vector>

#include "problems/linear_elimination.h"

namespace batten {

class Combination;

/// The elimination of LinearElimination::Make, one constraint at a time: rows
/// x_pivot + sum of tail = value, one for each constraint that does not follow from earlier ones.
class ConstraintRows {
 public:
  struct Row {
    int constraint = 0;
    int pivot = 0;
    std::vector<std::pair<int, double>> tail;
    double value = 0.0;
    double noise = 0.0;                        // size of the roundings in tail
    double value_noise = 0.0;                  // and in value
    double divisor = 1.0;                      // the pivot's coefficient before
    std::vector<std::pair<int, double>> used;  // earlier rows put in, and their factors
  };

  ConstraintRows(int num_variables, const std::vector<LinearConstraint>& constraints)
      : constraints_(constraints), row_of_(static_cast<std::size_t>(num_variables), -1) {}

  /// Puts the rows so far into constraint `index` and makes a row of what is left, if anything is.
  /// False, naming the constraints, if it has no variable or contradicts earlier ones.
  bool Add(int index, std::string* error);
  /// Puts the later rows into the earlier ones, so that tails have variables that stay only.
  void Finish();

  const std::vector<Row>& rows() const { return rows_; }
  /// Row that gives up `variable`, -1 if it stays.
  int row_of(int variable) const { return row_of_[static_cast<std::size_t>(variable)]; }

 private:
  bool Start(int index, Combination* left, std::string* error) const;
  void AppendRow(int index, const Combination& left, std::vector<std::pair<int, double>> used);
  std::string Name(int index) const;
  std::string ContradictionMessage(int index,
                                   const std::vector<std::pair<int, double>>& used) const;

  const std::vector<LinearConstraint>& constraints_;
  std::vector<int> row_of_;
  std::vector<Row> rows_;
};

}  // namespace batten

#endif  // BATTEN_PROBLEMS_CONSTRAINT_ROWS_H_
