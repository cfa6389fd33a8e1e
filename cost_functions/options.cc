#include "cost_functions/options.h"

#include <glog/logging.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <climits>
#include <cmath>
#include <stdexcept>
#include <system_error>

namespace batten {
namespace {

/// As users typed it.
std::string QuotedText(const std::string& text) {
  constexpr std::size_t kLongest = 100;
  return Quoted(text, kLongest);
}

std::string Joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

// Swapped neighbours, the commonest slip, count once.
int EditDistance(const std::string& a, const std::string& b) {
  std::vector<std::vector<int>> cost(a.size() + 1, std::vector<int>(b.size() + 1));
  for (size_t i = 0; i <= a.size(); ++i) {
    for (size_t j = 0; j <= b.size(); ++j) {
      cost[i][j] = static_cast<int>(i + j);
      if (i == 0 || j == 0) continue;
      cost[i][j] = std::min(
          {cost[i - 1][j] + 1, cost[i][j - 1] + 1, cost[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 1);
    }
  }
  return cost[a.size()][b.size()];
}

std::string LowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool ParseInto(const OptionInfo& info, const std::string& text, OptionValues* values) {
  if (info.kind == OptionInfo::Kind::kWord) {
    values->SetWord(info.name, text);
    return std::find(info.words.begin(), info.words.end(), text) != info.words.end();
  }
  double number = info.default_number;
  // "inf" is a value only where it is the default: "at least 0" is written with an infinite end,
  // and an infinite weight would make NaN out of a zero residual.
  const bool is_infinite_default = std::isinf(number) && text == NumberText(number);
  if (!is_infinite_default && !ParseNumber(text, &number)) return false;
  values->SetNumber(info.name, number);
  const bool kind_fits = info.kind == OptionInfo::Kind::kReal || number == std::trunc(number);
  return kind_fits && info.lowest <= number && number <= info.highest;
}

std::string UnknownOptionMessage(const std::vector<OptionInfo>& infos, const std::string& owner,
                                 const std::string& option) {
  const std::string found = owner + " has no option " + QuotedText(option);
  if (infos.empty()) return found + "; it has none";
  std::vector<std::string> names;
  for (const OptionInfo& info : infos) names.push_back(info.name);
  const auto nearest = std::find(names.begin(), names.end(), NearestName(option, names));
  const std::string range = infos[nearest - names.begin()].RangeText();
  return found + "; did you mean " + *nearest + " (" + range + ")? known: " + Joined(names);
}

constexpr char kOfValues[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.+";
constexpr std::string_view kOfNames(kOfValues, sizeof(kOfValues) - sizeof(".+"));  // not these two

class SpecParser {
 public:
  SpecParser(const std::string& text, std::string* error) : text_(text), error_(error) {}

  bool ParseUpToComma(NameSpec* spec) {
    // Specs are copied and destroyed by recursion: without a bound a long text overflows the stack.
    constexpr int kMostNames = 16;
    for (int count = 1; count <= kMostNames; ++count) {
      if (!ParseWord(kOfNames, "a name of letters, digits, _ and -", &spec->name)) return false;
      while (ParseCharacter('/')) {
        if (!ParseOption(spec)) return false;
      }
      if (!ParseCharacter(':')) return true;
      const auto wrapped = std::make_shared<NameSpec>();
      spec->wrapped = wrapped;
      spec = wrapped.get();
    }
    return Refuse(position_ - 1, "at most " + std::to_string(kMostNames) + " names in a chain");
  }

  bool ParseCharacter(char wanted) {
    if (position_ == text_.size() || text_[position_] != wanted) return false;
    ++position_;
    return true;
  }

  bool ParseEnd(const std::string& allowed) {
    return position_ == text_.size() || Refuse(position_, allowed);
  }

 private:
  bool ParseOption(NameSpec* spec) {
    const size_t begin = position_;
    std::string option, value;
    if (!ParseWord(kOfNames, "an option as NAME=VALUE", &option)) return false;
    if (!ParseCharacter('=')) return Refuse(position_, "= and a value after option " + option);
    if (!ParseWord(kOfValues, "a value of letters, digits, _ - . +", &value)) return false;
    for (const auto& earlier : spec->options) {
      if (earlier.first == option) return Refuse(begin, "option " + option + " once");
    }
    spec->options.emplace_back(std::move(option), std::move(value));
    return true;
  }

  bool ParseWord(std::string_view characters, const std::string& allowed, std::string* word) {
    const size_t end = std::min(text_.find_first_not_of(characters, position_), text_.size());
    *word = text_.substr(position_, end - position_);
    position_ = end;
    return !word->empty() || Refuse(position_, allowed);
  }

  bool Refuse(size_t position, const std::string& allowed) const {
    std::string where = "the end";
    if (position < text_.size()) {
      where =
          QuotedText(text_.substr(position, 1)) + " at character " + std::to_string(position + 1);
    }
    *error_ = "found " + where + " of " + QuotedText(text_) + "; allowed: " + allowed;
    return false;
  }

  const std::string& text_;
  std::string* const error_;
  size_t position_ = 0;
};

[[noreturn]] void ThrowNoOption(const std::string& name, const std::vector<std::string>& known) {
  const std::string nearest = NearestName(name, known);
  throw std::logic_error("asks for an option " + name + " that it has not declared" +
                         (nearest.empty() ? "" : "; did you mean " + nearest + "?"));
}

template <typename Value>
[[noreturn]] void ThrowNoOption(const std::string& name, const std::map<std::string, Value>& has) {
  std::vector<std::string> known;
  for (const auto& [option, value] : has) known.push_back(option);
  ThrowNoOption(name, known);
}

}  // namespace

// A default outside its own range could be written but not read back: hence the checks.
OptionInfo OptionInfo::Real(std::string name, double default_value, double lowest, double highest,
                            std::string help) {
  CHECK(lowest <= default_value && default_value <= highest) << name;
  return {std::move(name), std::move(help), Kind::kReal, default_value, lowest, highest, {}, {}};
}

OptionInfo OptionInfo::Integer(std::string name, int default_value, int lowest, int highest,
                               std::string help) {
  OptionInfo info = Real(std::move(name), default_value, lowest, highest, std::move(help));
  info.kind = Kind::kInteger;
  return info;
}

OptionInfo OptionInfo::Word(std::string name, std::string default_value,
                            std::vector<std::string> words, std::string help) {
  CHECK(std::count(words.begin(), words.end(), default_value) == 1) << name;
  return {std::move(name),          std::move(help), Kind::kWord, 0.0, 0.0, 0.0,
          std::move(default_value), std::move(words)};
}

std::string OptionInfo::RangeText() const {
  if (kind == Kind::kWord) return "one of " + Joined(words);
  std::string both = NumberText(lowest) + " to " + NumberText(highest);
  if (std::isinf(default_number)) return both;  // then infinity is a value that can be asked for
  const double limit = kind == Kind::kInteger ? INT_MAX : HUGE_VAL;
  const bool has_lowest = lowest > (kind == Kind::kInteger ? INT_MIN : -HUGE_VAL);
  if (highest < limit) return has_lowest ? both : "at most " + NumberText(highest);
  if (has_lowest) return "at least " + NumberText(lowest);
  return kind == Kind::kInteger ? "any integer" : "any number";
}

std::string OptionInfo::DefaultText() const {
  return kind == Kind::kWord ? default_word : NumberText(default_number);
}

bool IsSpecName(const std::string& text) {
  return !text.empty() && text.find_first_not_of(kOfNames) == std::string::npos;
}

bool IsSpecValue(const std::string& text) {
  return !text.empty() && text.find_first_not_of(kOfValues) == std::string::npos;
}

std::string WhyNoOptionList(const std::vector<OptionInfo>& infos) {
  constexpr std::size_t kLongest = 60;
  for (std::size_t i = 0; i < infos.size(); ++i) {
    const OptionInfo& info = infos[i];
    if (!IsSpecName(info.name)) {
      return "has an option named " + Quoted(info.name, kLongest) +
             "; allowed: letters, digits, _ and -";
    }
    for (const std::string& word : info.words) {
      if (IsSpecValue(word)) continue;
      return "has an option " + info.name + " with the word " + Quoted(word, kLongest) +
             "; allowed: letters, digits, _, -, . and +";
    }
    for (std::size_t before = 0; before < i; ++before) {
      if (infos[before].name == info.name) return "has two options named " + info.name;
    }
  }
  return "";
}

OptionValues::OptionValues(const std::vector<OptionInfo>& infos) {
  for (const OptionInfo& info : infos) {
    if (info.kind == OptionInfo::Kind::kWord) SetWord(info.name, info.default_word);
    if (info.kind != OptionInfo::Kind::kWord) SetNumber(info.name, info.default_number);
  }
}

double OptionValues::Real(const std::string& name) const {
  const auto found = numbers_.find(name);
  if (found == numbers_.end()) ThrowNoOption(name, numbers_);
  return found->second;
}

int OptionValues::Integer(const std::string& name) const {
  const double value = Real(name);
  CHECK(value == std::trunc(value) && value >= INT_MIN && value <= INT_MAX)
      << "option " << name << " is " << value << ", not an integer";
  return static_cast<int>(value);
}

const std::string& OptionValues::Word(const std::string& name) const {
  const auto found = words_.find(name);
  if (found == words_.end()) ThrowNoOption(name, words_);
  return found->second;
}

std::map<std::string, std::string> OptionValues::ToText() const {
  std::map<std::string, std::string> texts = words_;
  for (const auto& [name, number] : numbers_) texts[name] = NumberText(number);
  return texts;
}

std::string NameSpec::ToString() const {
  std::string text = name;
  for (const auto& [option, value] : options) text += "/" + option + "=" + value;
  return wrapped == nullptr ? text : text + ":" + wrapped->ToString();
}

bool ParseNameSpec(const std::string& text, NameSpec* spec, std::string* error) {
  constexpr char kGrammar[] = "NAME[/OPTION=VALUE]...[:WRAPPED]";
  SpecParser parser(text, error);
  NameSpec parsed;
  if (!parser.ParseUpToComma(&parsed) || !parser.ParseEnd(kGrammar)) return false;
  *spec = std::move(parsed);
  return true;
}

bool ParseNameSpecList(const std::string& text, std::vector<NameSpec>* specs, std::string* error) {
  SpecParser parser(text, error);
  std::vector<NameSpec> parsed;
  do {
    if (!parser.ParseUpToComma(&parsed.emplace_back())) return false;
  } while (parser.ParseCharacter(','));
  if (!parser.ParseEnd("NAME[/OPTION=VALUE]...[:WRAPPED], separated by commas")) return false;
  *specs = std::move(parsed);
  return true;
}

bool ResolveOptions(const std::vector<OptionInfo>& infos, const NameSpec& spec,
                    OptionValues* values, std::string* error) {
  OptionValues resolved(infos);
  for (const auto& [name, text] : spec.options) {
    const auto has_this_name = [&key = name](const OptionInfo& one) { return one.name == key; };
    const auto info = std::find_if(infos.begin(), infos.end(), has_this_name);
    if (info == infos.end()) {
      *error = UnknownOptionMessage(infos, spec.name, name);
      return false;
    }
    if (!ParseInto(*info, text, &resolved)) {
      const bool integer = info->kind == OptionInfo::Kind::kInteger;
      *error = "option " + name + " of " + spec.name + " is " + text + ", must be " +
               (integer ? "an integer, " : "") + info->RangeText();
      if (!info->words.empty()) *error += "; did you mean " + NearestName(text, info->words) + "?";
      return false;
    }
  }
  *values = std::move(resolved);
  return true;
}

bool AreNear(const std::string& a, const std::string& b) {
  return 3 * EditDistance(LowerCase(a), LowerCase(b)) <=
         static_cast<int>(std::max(a.size(), b.size()));
}

std::string NearestName(const std::string& name, const std::vector<std::string>& known) {
  std::pair<int, std::string> nearest(INT_MAX, "");
  for (const std::string& candidate : known) {
    // The beginning of a name stands for it, however much is missing.
    const bool begins = !name.empty() && LowerCase(candidate).rfind(LowerCase(name), 0) == 0;
    const int distance = begins ? 0 : EditDistance(LowerCase(name), LowerCase(candidate));
    if (distance < nearest.first) nearest = {distance, candidate};
  }
  return nearest.second;
}

std::string UnknownNameMessage(const std::string& kind, const std::string& name,
                               const std::vector<std::string>& known) {
  const std::string found = "unknown " + kind + " " + QuotedText(name);
  if (known.empty()) return found + "; none is known";
  return found + "; did you mean " + NearestName(name, known) + "? known: " + Joined(known);
}

std::string NumberText(double value) {
  if (std::isnan(value)) return "nan";
  char buffer[32];  // the longest shortest text has 24 characters: -1.7976931348623157e+308
  const auto result = std::to_chars(buffer, buffer + sizeof(buffer), value);
  return std::string(buffer, result.ptr);
}

bool ParseNumber(const std::string& text, double* value) {
  const char* begin = text.data();
  const char* const end = begin + text.size();
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') ++begin;
  double number = 0.0;
  auto result = std::from_chars(begin, end, number);
  if (result.ec == std::errc::result_out_of_range) {
    // Too small for a double is zero, as it is for every rounding; too large is refused.
    long double wide = 0.0L;
    result = std::from_chars(begin, end, wide);
    number = static_cast<double>(wide);
  }
  if (result.ec != std::errc() || result.ptr != end || !std::isfinite(number)) return false;
  *value = number;
  return true;
}

std::string Quoted(std::string_view text, std::size_t longest) {
  const char* const digits = "0123456789abcdef";
  std::string quoted = "\"";
  for (const unsigned char c : text.substr(0, longest)) {
    if (c >= 32 && c < 127) quoted += static_cast<char>(c);
    if (c < 32 || c >= 127) quoted += {'\\', 'x', digits[c / 16], digits[c % 16]};
  }
  return quoted + (text.size() > longest ? "...\"" : "\"");
}

bool EndsWith(std::string_view text, std::string_view ending) {
  return text.size() >= ending.size() && text.substr(text.size() - ending.size()) == ending;
}

}  // namespace batten
