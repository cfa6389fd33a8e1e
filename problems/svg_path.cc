#include "problems/svg_path.h"

#include <cctype>
#include <cmath>
#include <optional>
#include <utility>

#include "cost_functions/options.h"
#include "problems/data_set.h"

namespace batten {
namespace {

using Point = Eigen::RowVector2d;
constexpr std::size_t kLongestQuote = 20;
constexpr char kAllowedCommands[] = "one of M, L, H, V, C, S, Q, T, Z in either case";

/// Numbers and letters of path data, with a place for messages.
class PathScanner {
 public:
  explicit PathScanner(std::string_view text) : text_(text) {}

  std::size_t place() const { return place_; }
  bool AtEnd() {
    SkipSpace();
    return place_ == text_.size();
  }
  /// What may stand between two numbers: space with one comma or without. Whether there was a
  /// comma.
  bool SkipComma() {
    SkipSpace();
    if (place_ == text_.size() || text_[place_] != ',') return false;
    ++place_;
    SkipSpace();
    return true;
  }
  bool AtNumber() {
    return !AtEnd() && (std::isdigit(Byte(place_)) != 0 ||
                        std::string_view("+-.").find(text_[place_]) != std::string_view::npos);
  }
  char Letter() { return text_[place_++]; }

  /// Nothing where no finite number of the allowed size stands.
  std::optional<double> Number() {
    if (!AtNumber()) return std::nullopt;
    const std::size_t begin = place_;
    std::size_t end = begin;
    if (text_[end] == '+' || text_[end] == '-') ++end;
    end = PastDigits(end);
    if (end < text_.size() && text_[end] == '.') end = PastDigits(end + 1);
    end = PastExponent(end);
    const std::size_t from = text_[begin] == '+' ? begin + 1 : begin;
    double value = 0.0;
    if (!ParseNumber(std::string(text_.substr(from, end - from)), &value) ||
        std::abs(value) > kLargestNumber) {
      return std::nullopt;
    }
    place_ = end;
    return value;
  }

  std::string Found() const {
    if (place_ >= text_.size()) return "the end of the path";
    return Quoted(text_.substr(place_, kLongestQuote), kLongestQuote);
  }

 private:
  unsigned char Byte(std::size_t place) const { return static_cast<unsigned char>(text_[place]); }
  std::size_t PastDigits(std::size_t place) const {
    while (place < text_.size() && std::isdigit(Byte(place)) != 0) ++place;
    return place;
  }
  std::size_t PastExponent(std::size_t place) const {
    if (place >= text_.size() || (text_[place] != 'e' && text_[place] != 'E')) return place;
    std::size_t digits = place + 1;
    if (digits < text_.size() && (text_[digits] == '+' || text_[digits] == '-')) ++digits;
    const std::size_t end = PastDigits(digits);
    return end > digits ? end : place;
  }
  void SkipSpace() {
    while (place_ < text_.size() && std::isspace(Byte(place_)) != 0) ++place_;
  }

  std::string_view text_;
  std::size_t place_ = 0;
};

class PathBuilder {
 public:
  explicit PathBuilder(std::vector<BezierPath>* paths) : paths_(*paths) {}

  const Point& here() const { return here_; }
  /// The last control point mirrored at the current point, where the last command was of a curve
  /// with `degree`; else the current point.
  Point Mirrored(int degree) const { return last_degree_ == degree ? 2 * here_ - control_ : here_; }

  void MoveTo(const Point& point) {
    here_ = start_ = point;
    is_open_ = false;
    last_degree_ = 0;
  }
  void LineTo(const Point& point) {
    Add({here_, point});
    last_degree_ = 0;
  }
  void CurveTo(const std::vector<Point>& points) {
    std::vector<Point> all = {here_};
    all.insert(all.end(), points.begin(), points.end());
    control_ = points[points.size() - 2];
    last_degree_ = static_cast<int>(points.size());
    Add(all);
  }
  void Close() {
    if (is_open_ && here_ != start_) Add({here_, start_});
    here_ = start_;
    is_open_ = false;
    last_degree_ = 0;
  }

 private:
  void Add(const std::vector<Point>& points) {
    if (!is_open_) paths_.emplace_back();
    is_open_ = true;
    Points rows(points.size(), 2);
    for (std::size_t i = 0; i < points.size(); ++i) {
      rows.row(static_cast<Eigen::Index>(i)) = points[i];
    }
    std::vector<BezierSpan>& spans = paths_.back().spans;
    const auto begin = static_cast<double>(spans.size());
    // The numbers are finite, and sums of few of them are too.
    spans.push_back({*BezierCurve::Make(std::move(rows), nullptr), begin, begin + 1.0});
    here_ = points.back();
  }

  std::vector<BezierPath>& paths_;
  Point here_ = Point::Zero();
  Point start_ = Point::Zero();
  Point control_ = Point::Zero();
  int last_degree_ = 0;
  bool is_open_ = false;
};

class PathParser {
 public:
  PathParser(std::string_view text, std::vector<BezierPath>* paths)
      : scanner_(text), builder_(paths) {}

  bool Run(std::string* error) {
    bool is_first = true;
    while (!scanner_.AtEnd()) {
      const std::string found = scanner_.Found();
      const std::size_t place = scanner_.place();
      letter_ = scanner_.Letter();
      command_ = static_cast<char>(std::toupper(static_cast<unsigned char>(letter_)));
      const bool is_known = std::string_view("MLHVCSQTZ").find(command_) != std::string_view::npos;
      if (!is_known || (is_first && command_ != 'M')) {
        *error = "found " + found + "; allowed: " + (is_first ? "M or m first" : kAllowedCommands);
        if (command_ == 'A') *error += " (an arc is no Bezier curve: convert it to curves)";
        failed_at_ = place;
        return false;
      }
      is_first = false;
      if (!RunCommand(error)) {
        failed_at_ = scanner_.place();
        return false;
      }
    }
    return true;
  }
  std::size_t failed_at() const { return failed_at_; }

 private:
  /// One letter with all its groups of numbers.
  bool RunCommand(std::string* error) {
    if (command_ == 'Z') {
      builder_.Close();
      return true;
    }
    is_first_number_ = true;
    bool goes_on = true;
    while (goes_on) {
      if (!RunGroup()) {
        *error = "found " + scanner_.Found() + "; allowed: a number up to 1e150 in size";
        return false;
      }
      // Further pairs after a move are lines.
      if (command_ == 'M') command_ = 'L';
      is_first_number_ = scanner_.SkipComma();  // a comma there calls for another group
      goes_on = is_first_number_ || scanner_.AtNumber();
    }
    return true;
  }

  std::optional<double> Number() {
    if (!is_first_number_) scanner_.SkipComma();
    is_first_number_ = false;
    return scanner_.Number();
  }

  bool RunGroup() {
    const Point base = IsRelative() ? builder_.here() : Point::Zero();
    switch (command_) {
      case 'H':
      case 'V': {
        const std::optional<double> number = Number();
        if (!number) return false;
        Point point = builder_.here();
        const int c = command_ == 'H' ? 0 : 1;
        point[c] = base[c] + *number;
        builder_.LineTo(point);
        return true;
      }
      case 'C':
        return RunCurve(base, 3, false);
      case 'S':
        return RunCurve(base, 3, true);
      case 'Q':
        return RunCurve(base, 2, false);
      case 'T':
        return RunCurve(base, 2, true);
      default:
        break;
    }
    Point point;
    if (!ReadPoint(base, &point)) return false;
    command_ == 'M' ? builder_.MoveTo(point) : builder_.LineTo(point);
    return true;
  }

  bool RunCurve(const Point& base, int degree, bool mirrors_first) {
    std::vector<Point> points;
    if (mirrors_first) points.push_back(builder_.Mirrored(degree));
    while (static_cast<int>(points.size()) < degree) {
      points.emplace_back();
      if (!ReadPoint(base, &points.back())) return false;
    }
    builder_.CurveTo(points);
    return true;
  }

  bool ReadPoint(const Point& base, Point* point) {
    for (int c = 0; c < 2; ++c) {
      const std::optional<double> number = Number();
      if (!number) return false;
      (*point)[c] = base[c] + *number;
    }
    return true;
  }

  bool IsRelative() const { return std::islower(static_cast<unsigned char>(letter_)) != 0; }

  PathScanner scanner_;
  PathBuilder builder_;
  char letter_ = 'M';
  char command_ = 'M';
  bool is_first_number_ = true;  // no comma may stand before it
  std::size_t failed_at_ = 0;
};

}  // namespace

bool ParseSvgPath(std::string_view text, std::vector<BezierPath>* paths, std::size_t* offset,
                  std::string* error) {
  PathParser parser(text, paths);
  if (parser.Run(error)) return true;
  *offset = parser.failed_at();
  return false;
}

}  // namespace batten
