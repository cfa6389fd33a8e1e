#ifndef BATTEN_COST_FUNCTIONS_OPTIONS_H_
#define BATTEN_COST_FUNCTIONS_OPTIONS_H_

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace batten {

/// One option of a term or a solver: its name, meaning, default and range.
struct OptionInfo {
  enum class Kind { kReal, kInteger, kWord };
  static OptionInfo Real(std::string name, double default_value, double lowest, double highest,
                         std::string help);  ///< Range closed at both ends; infinity allowed.
  static OptionInfo Integer(std::string name, int default_value, int lowest, int highest,
                            std::string help);
  static OptionInfo Word(std::string name, std::string default_value,
                         std::vector<std::string> words, std::string help);

  std::string name;
  std::string help;
  Kind kind = Kind::kReal;
  double default_number = 0.0;
  double lowest = 0.0;
  double highest = 0.0;
  std::string default_word;
  std::vector<std::string> words;
  /// "3 to 20", "one of weak, strong".
  std::string RangeText() const;
  std::string DefaultText() const;
};

/// Whether it is a name of the grammar below, or what can stand behind the = of an option.
bool IsSpecName(const std::string& text);
bool IsSpecValue(const std::string& text);
/// Empty, or what is wrong with a list of options, as a sentence's end: "has two options named x".
std::string WhyNoOptionList(const std::vector<OptionInfo>& infos);

/// Checked values for a list of OptionInfo.
class OptionValues {
 public:
  OptionValues() = default;
  explicit OptionValues(const std::vector<OptionInfo>& infos);  ///< All defaults.
  /// A name that is not there, or of another kind, throws std::logic_error: whoever asks has not
  /// declared it.
  double Real(const std::string& name) const;
  int Integer(const std::string& name) const;
  const std::string& Word(const std::string& name) const;
  void SetNumber(const std::string& name, double value) { numbers_[name] = value; }
  void SetWord(const std::string& name, const std::string& value) { words_[name] = value; }
  /// Every option as text, in alphabetical order; numbers read back to the same double.
  std::map<std::string, std::string> ToText() const;

 private:
  std::map<std::string, double> numbers_;
  std::map<std::string, std::string> words_;
};

/// The grammar shared by flags, files, tables and traces: NAME[/OPTION=VALUE]...[:WRAPPED], as in
/// `anderson/window=5:pdm`. Names and options: letters, digits, `_`, `-`; values additionally `.+`.
struct NameSpec {
  std::string name;
  std::vector<std::pair<std::string, std::string>> options;
  std::shared_ptr<const NameSpec> wrapped;  // null if nothing is wrapped
  std::string ToString() const;
};

/// False with one sentence in `error` (what was found and where) for text outside the grammar or an
/// option given twice.
bool ParseNameSpec(const std::string& text, NameSpec* spec, std::string* error);
/// Comma-separated; at least one.
bool ParseNameSpecList(const std::string& text, std::vector<NameSpec>* specs, std::string* error);

/// Defaults overwritten by spec.options. An unknown option is answered with the nearest known one
/// and its range, a value outside its range with the range.
bool ResolveOptions(const std::vector<OptionInfo>& infos, const NameSpec& spec,
                    OptionValues* values, std::string* error);

/// The entry of `known` with the smallest edit distance, whatever the case of letters (the first of
/// equals); empty for none.
std::string NearestName(const std::string& name, const std::vector<std::string>& known);
/// Whether one could be a slip of the other: at most a third of the longer one's letters differ.
bool AreNear(const std::string& a, const std::string& b);
/// `unknown solver "lbgfs"; did you mean lbfgs? known: cg, gim, lbfgs`
std::string UnknownNameMessage(const std::string& kind, const std::string& name,
                               const std::vector<std::string>& known);
/// `text` in double quotes, on one line and in ASCII whatever it is: other bytes as \xNN, at most
/// `longest` of them.
std::string Quoted(std::string_view text, std::size_t longest);
bool EndsWith(std::string_view text, std::string_view ending);
/// Shortest text that reads back to the same double; "inf", "-inf", "nan".
std::string NumberText(double value);
/// Whole-text parse; false for anything else than one finite number.
bool ParseNumber(const std::string& text, double* value);

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_OPTIONS_H_
