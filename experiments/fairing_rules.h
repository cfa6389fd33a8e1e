#ifndef BATTEN_EXPERIMENTS_FAIRING_RULES_H_
#define BATTEN_EXPERIMENTS_FAIRING_RULES_H_

#include <string>

#include "experiments/fairing_choice.h"
#include "splines/smoothing_family.h"

namespace batten {

struct FairingRuleSetting {
  double unit = 1.0;   ///< Of energies, in the user's units.
  int dimension = 1;   ///< Coordinates that a row of the family stands for.
  int systems = 1;     ///< Coordinates that are unknowns of one system; 1: each has the same one.
  double noise = 0.0;  ///< Of each coordinate, in the user's units; for risk and discrepancy.
};

/// Scans the weights of `family` from the data's end to the fair end, then looks closer by the
/// rule. False with one sentence in `error` where there is no weight to choose.
bool ChooseByRule(const SmoothingFamily& family, FairingRule rule,
                  const FairingRuleSetting& setting, FairingChoice* choice, std::string* error);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_FAIRING_RULES_H_
