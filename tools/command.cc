#include "tools/command.h"

#include <algorithm>

#include "cost_functions/options.h"
#include "tools/plugin_flags.h"

namespace batten {
namespace {

std::vector<std::string> CommandNames() {
  std::vector<std::string> names;
  for (const Command& command : Commands()) names.push_back(command.name);
  return names;
}

bool IsAny(const std::string& text, const std::vector<std::string>& words) {
  return std::find(words.begin(), words.end(), text) != words.end();
}

}  // namespace

const std::vector<Command>& Commands() {
  static const auto& commands = *[] {
    auto* made = new std::vector<Command>{
        FitCommand(),     CompareCommand(), BenchCommand(),     MergeCommand(),
        RegressCommand(), ReportCommand(),  ReproduceCommand(), SubdivideCommand(),
        ListCommand(),    CheckCommand(),   NewCommand(),       ReplayCommand(),
    };
    for (Command& command : *made) command.flags.push_back(PluginsFlag());
    made->push_back(HelpCommand());
    return made;
  }();
  return commands;
}

const Command* FindCommand(const std::string& name) {
  for (const Command& command : Commands()) {
    if (command.name == name) return &command;
  }
  return nullptr;
}

int RunCommandLine(const std::vector<std::string>& arguments, CommandOutput* output) {
  if (arguments.empty()) {
    return Refuse("found no command; allowed: fit, compare, report, list, help; try: batten help",
                  output);
  }
  const std::string& name = arguments.front();
  if (IsAny(name, {"--help", "-help", "-h"})) {
    output->results = GeneralHelp();
    return kDone;
  }
  if (IsAny(name, {"--version", "-version"})) {
    output->results = VersionText();
    return kDone;
  }
  if (!name.empty() && name.front() == '-') {
    return Refuse("found " + name + " before the command; allowed: batten COMMAND [FLAGS]", output);
  }
  const Command* command = FindCommand(name);
  if (command == nullptr) {
    return Refuse(UnknownNameMessage("command", name, CommandNames()), output);
  }
  ParsedArguments parsed;
  const std::vector<std::string> rest(arguments.begin() + 1, arguments.end());
  if (!ParseFlags(command->name, command->flags, rest, &parsed, &output->error)) return kBadInput;
  if (parsed.help || parsed.version) {
    output->results = parsed.help ? CommandHelp(*command) : VersionText();
    return kDone;
  }
  const bool knows_plugins =
      std::any_of(command->flags.begin(), command->flags.end(),
                  [](const FlagInfo& flag) { return flag.name == "plugins"; });
  if (knows_plugins && !LoadPluginsFromFlags(&output->error)) return kBadInput;
  return command->run(parsed.positional, output);
}

int Refuse(const std::string& error, CommandOutput* output) {
  output->error = error;
  return kBadInput;
}

std::string OneLine(const std::string& text) {
  const char* const digits = "0123456789abcdef";
  std::string line;
  for (const unsigned char c : text) {
    if (c >= 32 && c != 127) {
      line += static_cast<char>(c);
    } else {
      line += {'\\', 'x', digits[c / 16], digits[c % 16]};
    }
  }
  return line;
}

}  // namespace batten
