#ifndef BATTEN_TOOLS_FAIRING_FLAGS_H_
#define BATTEN_TOOLS_FAIRING_FLAGS_H_

#include <gflags/gflags_declare.h>

#include <optional>
#include <string>
#include <vector>

#include "experiments/fairing_choice.h"
#include "tools/flags.h"

DECLARE_string(fairing_figure);

namespace batten {

/// --fairing, --noise, --fairing_units, --span_weights, --fairing_figure.
std::vector<FlagInfo> FairingFlags();
/// Flags that go together, and with the terms and the guard of `spec`, so that none is without
/// effect; false with one sentence in `error`.
bool CheckFairingFlags(const FitSpec& spec, std::string* error);
/// Units and weights of the spans into the fairing terms, and the weight that --fairing chooses
/// from `data`, with how in *choice. `source`: what messages about the fit begin with.
bool ApplyFairingFlags(const std::string& source, const DataSet& data, FitSpec* spec,
                       std::optional<FairingChoice>* choice, std::string* error);

}  // namespace batten

#endif  // BATTEN_TOOLS_FAIRING_FLAGS_H_
