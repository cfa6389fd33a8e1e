#include "tools/flags.h"

#include <gflags/gflags.h>
#include <glog/logging.h>

#include <algorithm>
#include <cmath>

#include "cost_functions/options.h"

namespace batten {
namespace {

gflags::CommandLineFlagInfo DefinedFlag(const std::string& name) {
  gflags::CommandLineFlagInfo info;
  CHECK(gflags::GetCommandLineFlagInfo(name.c_str(), &info)) << "no DEFINE_ for --" << name;
  return info;
}

bool IsSwitch(const FlagInfo& flag) { return DefinedFlag(flag.name).type == "bool"; }
bool IsNumber(const FlagInfo& flag) {
  const std::string type = DefinedFlag(flag.name).type;
  return type != "bool" && type != "string";
}
bool IsWhole(const FlagInfo& flag) {
  return IsNumber(flag) && DefinedFlag(flag.name).type != "double";
}

// 10000000 and not 1e+07 where numbers are counts.
std::string LimitText(const FlagInfo& flag, double limit) {
  return IsWhole(flag) ? std::to_string(std::llround(limit)) : NumberText(limit);
}

std::string RangeText(const FlagInfo& flag) {
  const std::string from = (flag.above_lowest ? "above " : "") + LimitText(flag, flag.lowest);
  if (std::isinf(flag.highest)) return flag.above_lowest ? from : "at least " + from;
  return from + " to " + LimitText(flag, flag.highest);
}

std::string WordsText(const FlagInfo& flag) {
  std::string text;
  for (const std::string& word : flag.words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

// One argument that is a flag, taken apart.
struct FlagArgument {
  std::string name;
  std::string value;
  bool has_value = false;
};

FlagArgument TakeApart(const std::string& argument) {
  const size_t begin = argument.compare(0, 2, "--") == 0 ? 2 : 1;
  const size_t equals = argument.find('=', begin);
  if (equals == std::string::npos) return {argument.substr(begin), "", false};
  return {argument.substr(begin, equals - begin), argument.substr(equals + 1), true};
}

const FlagInfo* FindFlag(const std::vector<FlagInfo>& flags, const std::string& name) {
  const auto found = std::find_if(flags.begin(), flags.end(),
                                  [&name](const FlagInfo& flag) { return flag.name == name; });
  return found == flags.end() ? nullptr : &*found;
}

std::string UnknownFlagMessage(const std::string& command, const std::vector<FlagInfo>& flags,
                               const std::string& name) {
  std::vector<std::string> known = {"help", "version"};
  for (const FlagInfo& flag : flags) known.push_back(flag.name);
  return "--" + name.substr(0, 60) + ": unknown flag; did you mean --" + NearestName(name, known) +
         "? allowed: those of batten help " + command;
}

bool SetSwitch(const FlagInfo& flag, const FlagArgument& argument, std::string* error) {
  std::string value = argument.has_value ? argument.value : "true";
  std::transform(value.begin(), value.end(), value.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  // SetCommandLineOption answers with an empty text what it cannot read, and does nothing else.
  if (!gflags::SetCommandLineOption(flag.name.c_str(), value.c_str()).empty()) return true;
  *error = RefusedFlag(flag.name, argument.value, "true, false");
  return false;
}

bool SetNumber(const FlagInfo& flag, const std::string& value, std::string* error) {
  double number = 0.0;
  const bool parsed = ParseNumber(value, &number);
  const bool in_range = parsed && number <= flag.highest &&
                        (flag.above_lowest ? number > flag.lowest : number >= flag.lowest);
  const bool kind_fits = !IsWhole(flag) || number == std::trunc(number);
  if (!in_range || !kind_fits) {
    const bool only_kind = in_range && !kind_fits;
    *error =
        RefusedFlag(flag.name, value, (only_kind ? "whole numbers from " : "") + RangeText(flag));
    return false;
  }
  // gflags reads no 1e3 as a whole number.
  const std::string text =
      IsWhole(flag) ? std::to_string(std::llround(number)) : NumberText(number);
  CHECK(!gflags::SetCommandLineOption(flag.name.c_str(), text.c_str()).empty())
      << "--" << flag.name << " cannot hold " << text << ", which is in its range";
  return true;
}

bool SetText(const FlagInfo& flag, const std::string& value, std::string* error) {
  const bool is_allowed = flag.words.empty()
                              ? !value.empty()
                              : std::count(flag.words.begin(), flag.words.end(), value) > 0;
  if (!is_allowed) {
    *error = RefusedFlag(flag.name, value, flag.words.empty() ? flag.allowed : WordsText(flag));
    return false;
  }
  gflags::SetCommandLineOption(flag.name.c_str(), value.c_str());
  return true;
}

// "--name" of a switch in the help, "--name=VALUE" of the others.
std::string Signature(const FlagInfo& flag) {
  const std::string dashes = "  --";
  if (IsSwitch(flag)) {
    const bool is_on = DefinedFlag(flag.name).default_value == "true";
    return dashes + (is_on ? "[no]" : "") + flag.name;
  }
  return dashes + flag.name + "=" + (flag.placeholder.empty() ? "WORD" : flag.placeholder);
}

std::string DefaultText(const FlagInfo& flag) {
  const gflags::CommandLineFlagInfo defined = DefinedFlag(flag.name);
  if (IsSwitch(flag)) return defined.default_value == "true" ? "default: on" : "default: off";
  if (defined.default_value.empty()) return "";
  // A number outside its own range stands for "not given".
  double number = 0.0;
  if (IsNumber(flag) && ParseNumber(defined.default_value, &number) &&
      (number < flag.lowest || number > flag.highest ||
       (flag.above_lowest && number == flag.lowest))) {
    return "";
  }
  return "default: " + (IsNumber(flag) ? LimitText(flag, number) : defined.default_value);
}

std::string HelpText(const FlagInfo& flag) {
  std::string text = flag.help.empty() ? DefinedFlag(flag.name).description : flag.help;
  std::string facts = IsNumber(flag) ? RangeText(flag) : WordsText(flag);
  const std::string default_text = DefaultText(flag);
  if (!default_text.empty()) facts += (facts.empty() ? "" : "; ") + default_text;
  return facts.empty() ? text : text + " [" + facts + "]";
}

}  // namespace

FlagInfo SwitchFlag(const std::string& name) { return {name, "", {}, 0.0, 0.0, false, "", ""}; }

FlagInfo TextFlag(const std::string& name, const std::string& placeholder,
                  const std::string& allowed, const std::string& help) {
  return {name, placeholder, {}, 0.0, 0.0, false, help, allowed};
}

FlagInfo WordFlag(const std::string& name, const std::vector<std::string>& words) {
  return {name, "", words, 0.0, 0.0, false, "", ""};
}

FlagInfo NumberFlag(const std::string& name, const std::string& placeholder, double lowest,
                    double highest) {
  return {name, placeholder, {}, lowest, highest, false, "", ""};
}

FlagInfo NumberAboveFlag(const std::string& name, const std::string& placeholder, double lowest,
                         double highest) {
  return {name, placeholder, {}, lowest, highest, true, "", ""};
}

bool ParseFlags(const std::string& command, const std::vector<FlagInfo>& flags,
                const std::vector<std::string>& arguments, ParsedArguments* parsed,
                std::string* error) {
  const auto flags_end = std::find(arguments.begin(), arguments.end(), "--");
  for (auto argument = arguments.begin(); argument != flags_end; ++argument) {
    if (*argument == "--help" || *argument == "-help" || *argument == "-h") parsed->help = true;
    if (*argument == "--version" || *argument == "-version") parsed->version = true;
  }
  if (parsed->help || parsed->version) return true;
  for (auto argument = arguments.begin(); argument != flags_end; ++argument) {
    if (argument->size() < 2 || argument->front() != '-') {
      parsed->positional.push_back(*argument);
      continue;
    }
    FlagArgument given = TakeApart(*argument);
    const FlagInfo* flag = FindFlag(flags, given.name);
    if (flag == nullptr && !given.has_value && given.name.compare(0, 2, "no") == 0) {
      flag = FindFlag(flags, given.name.substr(2));
      if (flag != nullptr && !IsSwitch(*flag)) flag = nullptr;
      if (flag != nullptr) given = {flag->name, "false", true};
    }
    if (flag == nullptr) {
      *error = UnknownFlagMessage(command, flags, given.name);
      return false;
    }
    // A value of its own argument may begin with a minus sign, but not look like the next flag.
    if (!IsSwitch(*flag) && !given.has_value && argument + 1 != flags_end &&
        (argument + 1)->compare(0, 2, "--") != 0) {
      given.value = *++argument;
    }
    const bool is_set = IsSwitch(*flag)   ? SetSwitch(*flag, given, error)
                        : IsNumber(*flag) ? SetNumber(*flag, given.value, error)
                                          : SetText(*flag, given.value, error);
    if (!is_set) return false;
  }
  if (flags_end != arguments.end()) {
    parsed->positional.insert(parsed->positional.end(), flags_end + 1, arguments.end());
  }
  return true;
}

bool WasGiven(const std::string& name) { return !DefinedFlag(name).is_default; }

std::string FlagsText(const std::vector<FlagInfo>& flags) {
  constexpr size_t kIndent = 30;
  std::string text;
  for (const FlagInfo& flag : flags) {
    std::string signature = Signature(flag);
    if (signature.size() + 2 > kIndent) {
      text += signature + "\n";
      signature.clear();
    }
    signature.resize(kIndent, ' ');
    text += signature + Wrapped(HelpText(flag), kIndent, kIndent);
  }
  return text;
}

std::string RefusedFlag(const std::string& name, const std::string& found,
                        const std::string& allowed) {
  constexpr size_t kLongest = 100;
  double number = 0.0;
  std::string shown = found.substr(0, kLongest) + (found.size() > kLongest ? "..." : "");
  if (!ParseNumber(found, &number)) shown = "\"" + shown + "\"";
  return "--" + name + ": found " + shown + "; allowed: " + allowed;
}

std::string Wrapped(const std::string& text, size_t indent, size_t first_column) {
  constexpr size_t kColumns = 100;
  std::string wrapped;
  size_t column = first_column;
  bool line_is_empty = true;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find(' ', begin), text.size());
    const size_t length = end - begin;
    if (!line_is_empty && column + 1 + length > kColumns) {
      wrapped += "\n" + std::string(indent, ' ');
      column = indent;
      line_is_empty = true;
    }
    wrapped += (line_is_empty ? "" : " ") + text.substr(begin, length);
    column += length + (line_is_empty ? 0 : 1);
    line_is_empty = false;
    begin = end + 1;
  }
  return wrapped + "\n";
}

}  // namespace batten
