#include "tools/run_flags.h"

#include <gflags/gflags.h>

#include <limits>
#include <utility>

#include "solvers/solver_registry.h"

namespace {
const batten::RunSpec kDefaults;
}  // namespace

DEFINE_bool(quiet, false, "No progress on standard error.");
DEFINE_string(out, "", "Where results are written.");
DEFINE_string(mode, batten::ToString(kDefaults.mode),
              "race: one stop rule for all solvers; native: each stops as its authors do.");
DEFINE_double(gradient_tolerance, kDefaults.gradient_tolerance,
              "Race: stop where |g| <= this * |g(start)|; relative, no unit. 0: at the rounding "
              "floor only.");
DEFINE_int32(max_iterations, kDefaults.max_iterations, "Stop after this many iterations.");
DEFINE_double(max_seconds, kDefaults.max_seconds,
              "Stop after this much of the solver's own wall time, in seconds.");
DEFINE_double(
    native_step, kDefaults.native_step,
    "Native: gim and lspia stop where no control point moves as far as this, in the data's "
    "unit of length.");
DEFINE_double(
    native_gradient, kDefaults.native_gradient,
    "Native: gradient methods stop where |g| is below this, in the data's unit of length.");
DEFINE_uint64(seed, kDefaults.seed, "Of everything random.");
DEFINE_int32(threads, kDefaults.threads, "Most threads of one run.");
DEFINE_bool(compile, kDefaults.compile,
            "Linear terms are compiled to banded rows; off: every evaluation goes through the "
            "automatic derivatives, block by block.");

namespace batten {

std::vector<FlagInfo> RunFlags() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kLargestInteger = std::numeric_limits<int>::max();
  // Every number is checked as a double: the next one, 2^53, is also what 2^53 + 1 is read as.
  constexpr double kLargestSeed = 9007199254740991.0;
  constexpr double kLongest = 1e9;  // seconds
  return {WordFlag("mode", {"race", "native"}),
          NumberFlag("gradient_tolerance", "RATIO", 0.0, 1.0),
          NumberFlag("max_iterations", "N", 0.0, kLargestInteger),
          NumberAboveFlag("max_seconds", "SECONDS", 0.0, kLongest),
          NumberFlag("native_step", "LENGTH", 0.0, kInfinity),
          NumberFlag("native_gradient", "LENGTH", 0.0, kInfinity),
          NumberFlag("seed", "N", 0.0, kLargestSeed),
          NumberFlag("threads", "N", 1.0, 1024.0),
          SwitchFlag("compile")};
}

bool CheckRunFlags(std::string* error) {
  for (const auto& [flag, value] :
       {std::pair("native_step", FLAGS_native_step), {"native_gradient", FLAGS_native_gradient}}) {
    if (FLAGS_mode == "native" || !WasGiven(flag)) continue;
    *error = RefusedFlag(flag, NumberText(value), "nothing, without --mode=native");
    return false;
  }
  return true;
}

RunSpec RunSpecFromFlags() {
  RunSpec spec;
  FromString(FLAGS_mode, &spec.mode);
  spec.gradient_tolerance = FLAGS_gradient_tolerance;
  spec.max_iterations = FLAGS_max_iterations;
  spec.max_seconds = FLAGS_max_seconds;
  spec.native_step = FLAGS_native_step;
  spec.native_gradient = FLAGS_native_gradient;
  spec.seed = FLAGS_seed;
  spec.threads = FLAGS_threads;
  spec.compile = FLAGS_compile;
  return spec;
}

bool SolversFromFlag(const std::string& flag, const std::string& text,
                     std::vector<NameSpec>* solvers, std::string* error) {
  const SolverRegistry& registry = SolverRegistry::Global();
  std::vector<NameSpec> items;
  bool is_good = ParseNameSpecList(text, &items, error);
  solvers->clear();
  for (const NameSpec& item : items) {
    if (item.ToString() != "all") {
      is_good = is_good && registry.Make(item, nullptr, error) != nullptr;
      solvers->push_back(item);
      continue;
    }
    for (const std::string& name : registry.Names()) {
      NameSpec usual;
      is_good = ParseNameSpec(registry.UsualName(name), &usual, error) && is_good;
      solvers->push_back(usual);
    }
  }
  if (!is_good) *error = "--" + flag + ": " + *error;
  return is_good;
}

std::vector<std::string> SplitAtCommas(const std::string& text) {
  std::vector<std::string> parts;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(',', begin), text.size());
    std::string part = text.substr(begin, end - begin);
    part.erase(0, std::min(part.find_first_not_of(" \t"), part.size()));
    part.erase(part.find_last_not_of(" \t") + 1);
    parts.push_back(part);
    begin = end + 1;
  }
  return parts;
}

bool ParseNumbers(const std::string& text, std::vector<double>* numbers) {
  numbers->clear();
  for (const std::string& part : SplitAtCommas(text)) {
    double number = 0.0;
    if (!ParseNumber(part, &number)) return false;
    numbers->push_back(number);
  }
  return true;
}

}  // namespace batten
