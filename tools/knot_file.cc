#include "tools/knot_file.h"

#include <cerrno>
#include <fstream>
#include <istream>

#include "problems/fit_problem.h"
#include "problems/input_file.h"
#include "tools/flags.h"

namespace batten {
namespace {

/// The words of a stream, wherever its lines end: a line may hold all knots, and a file may be
/// endless.
class KnotWords {
 public:
  explicit KnotWords(std::istream* stream) : stream_(stream) {}

  /// False at the end. A word that is too long for a number comes in parts.
  bool Next(std::string* word) {
    constexpr size_t kLongest = 1000;
    word->clear();
    char c = 0;
    while (word->size() < kLongest && stream_->get(c)) {
      const bool is_separator = c == ' ' || c == ',' || c == '\t' || c == '\r' || c == '\n';
      if (is_separator && !word->empty()) {
        stream_->unget();
        return true;
      }
      if (c == '\n') ++line_;
      if (is_separator) continue;
      if (c == '#' && word->empty()) {
        SkipLine();
      } else {
        *word += c;
      }
    }
    return !word->empty();
  }

  int line() const { return line_; }  // of the word handed out last

 private:
  void SkipLine() {
    for (char c = 0; stream_->get(c);) {
      if (c != '\n') continue;
      ++line_;
      return;
    }
  }

  std::istream* const stream_;
  int line_ = 1;
};

/// What a file of numbers is read for.
struct Purpose {
  std::string flag;
  std::string allowed;  // of the flag
  std::string noun;     // "knots"
  bool nondecreasing = false;
};

bool ReadNumbers(const std::string& path, const Purpose& purpose, std::vector<double>* numbers,
                 std::string* error) {
  constexpr char kAllowed[] = "numbers, separated by white space or commas";
  constexpr size_t kMost = kMaxControlPoints + 2 * kMaxDegree + 1;
  std::ifstream file;
  if (!OpenInput(path, &file, error)) {
    *error = RefusedFlag(purpose.flag, path, purpose.allowed) + " (" + *error + ")";
    return false;
  }
  KnotWords words(&file);
  const auto refuse = [&](const std::string& found, const std::string& allowed) {
    *error =
        path + ":" + std::to_string(words.line()) + ": found " + found + "; allowed: " + allowed;
    return false;
  };
  for (std::string word; words.Next(&word);) {
    double number = 0.0;
    if (!ParseNumber(word, &number)) return refuse("\"" + word.substr(0, 40) + "\"", kAllowed);
    if (purpose.nondecreasing && !numbers->empty() && number < numbers->back()) {
      return refuse(word + " after " + NumberText(numbers->back()),
                    purpose.noun + " that do not decrease");
    }
    if (numbers->size() == kMost) {
      return refuse("more than " + std::to_string(kMost) + " " + purpose.noun, "as many as that");
    }
    numbers->push_back(number);
  }
  if (file.bad()) {
    *error = CannotBeRead(path, errno);
    return false;
  }
  return !numbers->empty() || refuse("no " + purpose.noun, kAllowed);
}

}  // namespace

bool ReadKnotFile(const std::string& path, std::vector<double>* knots, std::string* error) {
  return ReadNumbers(path, {"knots", kAllowedKnots, "knots", true}, knots, error);
}

bool ReadSpanWeightFile(const std::string& path, std::vector<double>* weights, std::string* error) {
  return ReadNumbers(path, {"span_weights", kAllowedSpanWeights, "weights", false}, weights, error);
}

}  // namespace batten
