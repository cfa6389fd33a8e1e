#include "cost_functions/options.h"
#include "experiments/build_info.h"
#include "tools/command.h"

namespace batten {
namespace {

int RunHelp(const std::vector<std::string>& positional, CommandOutput* output) {
  if (positional.empty()) {
    output->results = GeneralHelp();
    return kDone;
  }
  if (positional.size() > 1) {
    return Refuse(
        "help: found " + std::to_string(positional.size()) + " names; allowed: one command",
        output);
  }
  const Command* command = FindCommand(positional.front());
  if (command == nullptr) {
    std::vector<std::string> names;
    for (const Command& known : Commands()) names.push_back(known.name);
    return Refuse(UnknownNameMessage("command", positional.front(), names), output);
  }
  output->results = CommandHelp(*command);
  return kDone;
}

std::string Usage(const Command& command) {
  return "batten " + command.name + (command.arguments.empty() ? "" : " " + command.arguments) +
         (command.flags.empty() ? "" : " [FLAGS]");
}

}  // namespace

Command HelpCommand() {
  Command command;
  command.name = "help";
  command.arguments = "[COMMAND]";
  command.summary = "explains the program or one command";
  command.examples = {"batten help fit"};
  command.run = &RunHelp;
  return command;
}

std::string GeneralHelp() {
  constexpr size_t kIndent = 12;
  std::string text = "batten: fits B-splines to points and compares the optimisers that do it\n\n";
  for (const Command& command : Commands()) {
    std::string name = "  " + command.name;
    name.resize(kIndent, ' ');
    text += name + Wrapped(command.summary, kIndent, kIndent);
  }
  text += "\nExamples:\n";
  for (const Command& command : Commands()) {
    if (!command.examples.empty()) text += "  " + command.examples.front() + "\n";
  }
  return text +
         "\nFlags: --flag=VALUE or --flag VALUE, --switch or --noswitch; of a flag given twice the "
         "last counts.\n"
         "batten help COMMAND (or --help anywhere) shows a command's flags; --version the build.\n"
         "Exit status: 0 done, 1 not reached, 2 bad input or usage, 3 a claim failed its audit or\n"
         "solvers disagree, 4 regress found the second result worse, 70 a fault of the program,\n"
         "130 interrupted.\n";
}

std::string CommandHelp(const Command& command) {
  std::string text = Wrapped(Usage(command), 4, 0) + "\n";
  text += Wrapped(command.name + ": " + command.summary + ".", 0, 0);
  for (const std::string& paragraph : command.details) text += "\n" + Wrapped(paragraph, 0, 0);
  if (!command.flags.empty()) text += "\nFlags:\n" + FlagsText(command.flags);
  text += "\nExamples:\n";
  for (const std::string& example : command.examples) text += "  " + example + "\n";
  return text;
}

std::string VersionText() {
  return std::string("batten ") + kVersion + "\ncommit " + kGitCommit + "\ncompiler " + kCompiler +
         "\nflags " + kFlags + "\n";
}

}  // namespace batten
