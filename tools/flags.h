#ifndef BATTEN_TOOLS_FLAGS_H_
#define BATTEN_TOOLS_FLAGS_H_

#include <gflags/gflags_declare.h>

#include <string>
#include <vector>

namespace batten {

/// One flag as one command offers it. Type, default and (unless `help` says it better for this
/// command) meaning are those of its DEFINE_.
struct FlagInfo {
  std::string name;
  std::string placeholder;         // what stands for the value in the help; empty for switches
  std::vector<std::string> words;  // not empty: the only values
  double lowest = 0.0;             // of numbers; both ends allowed
  double highest = 0.0;
  bool above_lowest = false;  // `lowest` itself is not allowed
  std::string help;
  std::string allowed;  // instead of an empty text
};

FlagInfo SwitchFlag(const std::string& name);
/// Any text but an empty one, which is answered with `allowed`.
FlagInfo TextFlag(const std::string& name, const std::string& placeholder,
                  const std::string& allowed, const std::string& help = "");
FlagInfo WordFlag(const std::string& name, const std::vector<std::string>& words);
FlagInfo NumberFlag(const std::string& name, const std::string& placeholder, double lowest,
                    double highest);
FlagInfo NumberAboveFlag(const std::string& name, const std::string& placeholder, double lowest,
                         double highest);

/// What a command line holds beside flags of its command, which are gflags' FLAGS_ from then on.
struct ParsedArguments {
  std::vector<std::string> positional;  // "-" is one
  bool help = false;                    // --help stands somewhere; the rest is not looked at
  bool version = false;
};

/// Reads --flag=value, --flag value, --switch, --noswitch, the same with one dash; `--` ends the
/// flags. Of a flag given twice the last value counts. Only the flags of `flags` are known: those
/// that gflags and glog bring along are not. False with one sentence in `error`; nothing here ends
/// the program.
bool ParseFlags(const std::string& command, const std::vector<FlagInfo>& flags,
                const std::vector<std::string>& arguments, ParsedArguments* parsed,
                std::string* error);

/// The flag stands on the command line, be it with its default value.
bool WasGiven(const std::string& name);

/// Flags with meanings, ranges and defaults, for the help; wrapped at 100 columns.
std::string FlagsText(const std::vector<FlagInfo>& flags);

/// `--NAME: found FOUND; allowed: ALLOWED`; FOUND is quoted unless it is a number.
std::string RefusedFlag(const std::string& name, const std::string& found,
                        const std::string& allowed);

/// `text` behind an indent, broken at spaces before column 100; the first line begins at
/// `first_column`.
std::string Wrapped(const std::string& text, size_t indent, size_t first_column);

}  // namespace batten

#endif  // BATTEN_TOOLS_FLAGS_H_
