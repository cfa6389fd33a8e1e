#ifndef BATTEN_TOOLS_RUN_FLAGS_H_
#define BATTEN_TOOLS_RUN_FLAGS_H_

#include <gflags/gflags_declare.h>

#include <string>
#include <vector>

#include "experiments/run.h"
#include "tools/flags.h"

// Flags that mean the same in several commands.
DECLARE_bool(quiet);
DECLARE_string(out);

namespace batten {

/// How solvers are run: --mode, the stop rule's numbers, --seed, --threads, --compile.
std::vector<FlagInfo> RunFlags();
/// False with one sentence in `error` for the number of a rule that --mode does not use.
bool CheckRunFlags(std::string* error);
RunSpec RunSpecFromFlags();

/// The solvers of a list in the grammar, each with options that it has; `all` in it stands for all
/// registered ones that wrap no other. False with one sentence in `error`.
bool SolversFromFlag(const std::string& flag, const std::string& text,
                     std::vector<NameSpec>* solvers, std::string* error);

/// "a, b" to parts without the blanks around them; empty parts stay.
std::vector<std::string> SplitAtCommas(const std::string& text);
/// All of `text`: numbers separated by commas.
bool ParseNumbers(const std::string& text, std::vector<double>* numbers);

}  // namespace batten

#endif  // BATTEN_TOOLS_RUN_FLAGS_H_
