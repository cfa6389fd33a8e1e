#ifndef BATTEN_TOOLS_COMMAND_H_
#define BATTEN_TOOLS_COMMAND_H_

#include <string>
#include <vector>

#include "tools/flags.h"

namespace batten {

/// Exit statuses (docs/formats.md); of several the largest applies.
inline constexpr int kDone = 0;
inline constexpr int kNotReached = 1;    // the solver failed or did not reach what was asked
inline constexpr int kBadInput = 2;      // bad input or usage, a file that cannot be written
inline constexpr int kDisagreement = 3;  // solvers disagree or a claim failed its audit
inline constexpr int kRegression = 4;    // slower or worse than before
inline constexpr int kFault = 70;        // a fault of ours, or memory ran out
inline constexpr int kInterruptedStatus = 130;

/// What a command has to say: results, then at most one line about what went wrong.
struct CommandOutput {
  std::string results;  // for standard output
  std::string error;    // for standard error; one line without its end
};

/// One subcommand. Flags are parsed before `run` is called, which finds their values in FLAGS_...
struct Command {
  std::string name;
  std::string arguments;             // "FILE | --problem=NAME"
  std::string summary;               // one line
  std::vector<std::string> details;  // paragraphs
  std::vector<std::string> examples;
  std::vector<FlagInfo> flags;
  /// Returns an exit status.
  int (*run)(const std::vector<std::string>& positional, CommandOutput* output);
};

/// The table of commands; null for an unknown name.
const std::vector<Command>& Commands();
const Command* FindCommand(const std::string& name);

Command FitCommand();        // fit_command.cc
Command CompareCommand();    // compare_command.cc
Command BenchCommand();      // bench_command.cc
Command MergeCommand();      // merge_command.cc
Command RegressCommand();    // regress_command.cc
Command ReplayCommand();     // replay_command.cc
Command ReproduceCommand();  // reproduce_command.cc
Command SubdivideCommand();  // subdivide_command.cc
Command ReportCommand();     // report_command.cc
Command ListCommand();       // list_command.cc
Command CheckCommand();      // check_command.cc
Command NewCommand();        // new_command.cc
Command HelpCommand();       // help_command.cc

std::string GeneralHelp();
std::string CommandHelp(const Command& command);
std::string VersionText();

/// Everything but the process around it: argv without the program's name.
int RunCommandLine(const std::vector<std::string>& arguments, CommandOutput* output);

/// Fills output->error; returns kBadInput.
int Refuse(const std::string& error, CommandOutput* output);

/// Control characters as \xNN, so that any message is one line.
std::string OneLine(const std::string& text);

}  // namespace batten

#endif  // BATTEN_TOOLS_COMMAND_H_
