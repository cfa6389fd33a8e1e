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

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_KEPT_ROWS_H_
