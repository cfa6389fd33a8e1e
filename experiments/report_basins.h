#ifndef BATTEN_EXPERIMENTS_REPORT_BASINS_H_
#define BATTEN_EXPERIMENTS_REPORT_BASINS_H_

#include <map>
#include <string>

namespace batten {

/// Minima that the runs of a folder of `bench` are held against where there is no direct answer, by
/// the keys of their rows.
struct BasinMinima {
  std::map<std::string, double> best;  ///< E of the instance's best basin.
  std::map<std::string, double> own;   ///< E of the basin that the run ends in, where it is known.
};

/// As the tables of `bench` have them; empty for other folders.
BasinMinima ReadBasinMinima(const std::string& folder);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_REPORT_BASINS_H_
