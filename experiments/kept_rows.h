#ifndef BATTEN_EXPERIMENTS_KEPT_ROWS_H_
#define BATTEN_EXPERIMENTS_KEPT_ROWS_H_

#include <cstddef>
#include <vector>

namespace batten {

/// Which of `count` rows of a run stand for all of them where only `most` >= 2 fit: increasing
/// indices, all if they fit, else `most`, the first and the last among them. Index j is
/// max(j, (count - 1) (j / (most - 1))^2), rounded: early iterations, where curves move most, are
/// dense, and the widest gap is about 2 count / most, so that linear axes are served too.
std::vector<std::size_t> KeptRows(std::size_t count, std::size_t most);

/// Which one of three or more increasing numbers >= 0, as of iterations, is to go where one has to:
/// the one between neighbours a < b of least (1 + b) / (1 + a), never the first or the last. A run
/// that adds one number at a time and lets this one go holds a list that is spread geometrically,
/// however long the run becomes.
std::size_t LeastMissed(const std::vector<double>& numbers);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_KEPT_ROWS_H_
