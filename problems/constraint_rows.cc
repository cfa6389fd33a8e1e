#include "problems/constraint_rows.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace batten {
namespace {

// Of the largest number that went into a row: each substitution rounds an entry twice, and 16
// leaves a factor of eight for what the rows that are put in carry themselves.
constexpr double kRoundings = 16.0 * std::numeric_limits<double>::epsilon();

}  // namespace

/// sum of entries = value, while rows are put into it.
class Combination {
 public:
  struct Sum {
    double value = 0.0;
    int num_parts = 0;
    void Add(double part) {
      value += part;
      ++num_parts;
    }
  };

  void Add(int variable, double coefficient) {
    entries_[variable].Add(coefficient);
    largest_ = std::max(largest_, std::abs(coefficient));
  }
  void AddValue(double value) {
    value_ += value;
    largest_value_ = std::max(largest_value_, std::abs(value));
  }
  /// Removes a variable; its coefficient, 0 if that is no more than roundings.
  double Take(int variable) {
    const auto entry = entries_.find(variable);
    const double coefficient = IsNoise(entry->second) ? 0.0 : entry->second.value;
    entries_.erase(entry);
    return coefficient;
  }
  void Subtract(double factor, const ConstraintRows::Row& row) {
    ++num_substitutions_;
    for (const auto& [variable, coefficient] : row.tail) Add(variable, -factor * coefficient);
    AddValue(-factor * row.value);
    inherited_ = std::max(inherited_, std::abs(factor) * row.noise);
    inherited_value_ = std::max(inherited_value_, std::abs(factor) * row.value_noise);
  }
  void DropNoise() {
    for (auto entry = entries_.begin(); entry != entries_.end();) {
      entry = IsNoise(entry->second) ? entries_.erase(entry) : std::next(entry);
    }
  }

  const std::map<int, Sum>& entries() const { return entries_; }
  double value() const { return value_; }
  double noise() const {
    return std::max(inherited_, kRoundings * (1 + num_substitutions_) * largest_);
  }
  double value_noise() const {
    return std::max(inherited_value_, kRoundings * (1 + num_substitutions_) * largest_value_);
  }

 private:
  // What never met anything to cancel with counts, however small.
  bool IsNoise(const Sum& sum) const {
    return sum.value == 0.0 || (sum.num_parts > 1 && std::abs(sum.value) <= noise());
  }

  std::map<int, Sum> entries_;
  double value_ = 0.0;
  double largest_ = 0.0;
  double largest_value_ = 0.0;
  double inherited_ = 0.0;
  double inherited_value_ = 0.0;
  int num_substitutions_ = 0;
};

std::string ConstraintRows::Name(int index) const {
  const std::string& name = constraints_[static_cast<std::size_t>(index)].name;
  return name.empty() ? "number " + std::to_string(index + 1) : "\"" + name + "\"";
}

bool ConstraintRows::Start(int index, Combination* left, std::string* error) const {
  const LinearConstraint& constraint = constraints_[static_cast<std::size_t>(index)];
  bool finite = std::isfinite(constraint.value);
  for (const auto& [variable, coefficient] : constraint.coefficients) {
    CHECK(variable >= 0 && variable < static_cast<int>(row_of_.size()))
        << "constraint " << Name(index) << " is about variable " << variable << " of "
        << row_of_.size();
    finite = finite && std::isfinite(coefficient);
    left->Add(variable, coefficient);
  }
  if (!finite) {
    *error = "linear constraint " + Name(index) + " has a number that is not finite";
    return false;
  }
  left->AddValue(constraint.value);
  left->DropNoise();
  if (!left->entries().empty()) return true;
  *error = "linear constraint " + Name(index) +
           " has no variable: all its coefficients are zero or cancel";
  return false;
}

bool ConstraintRows::Add(int index, std::string* error) {
  Combination left;
  if (!Start(index, &left, error)) return false;
  // A row holds no pivot of an earlier one: put in from the first on, each is needed once.
  std::set<int> waiting;
  const auto wait = [&](int variable) {
    if (row_of(variable) >= 0) waiting.insert(row_of(variable));
  };
  for (const auto& entry : left.entries()) wait(entry.first);
  std::vector<std::pair<int, double>> used;
  while (!waiting.empty()) {
    const int r = *waiting.begin();
    waiting.erase(waiting.begin());
    const Row& row = rows_[static_cast<std::size_t>(r)];
    const double factor = left.Take(row.pivot);
    if (factor == 0.0) continue;
    left.Subtract(factor, row);
    used.emplace_back(r, factor);
    for (const auto& entry : row.tail) wait(entry.first);
  }
  left.DropNoise();
  if (!left.entries().empty()) {
    AppendRow(index, left, std::move(used));
  } else if (std::abs(left.value()) > left.value_noise()) {
    *error = ContradictionMessage(index, used);
    return false;
  }
  return true;
}

void ConstraintRows::AppendRow(int index, const Combination& left,
                               std::vector<std::pair<int, double>> used) {
  const auto pivot = std::max_element(left.entries().begin(), left.entries().end(),
                                      [](const auto& a, const auto& b) {
                                        return std::abs(a.second.value) < std::abs(b.second.value);
                                      });
  Row row;
  row.constraint = index;
  row.pivot = pivot->first;
  row.divisor = pivot->second.value;
  for (const auto& [variable, sum] : left.entries()) {
    if (variable != row.pivot) row.tail.emplace_back(variable, sum.value / row.divisor);
  }
  row.value = left.value() / row.divisor;
  row.noise = left.noise() / std::abs(row.divisor);
  row.value_noise = left.value_noise() / std::abs(row.divisor);
  row.used = std::move(used);
  row_of_[static_cast<std::size_t>(row.pivot)] = static_cast<int>(rows_.size());
  rows_.push_back(std::move(row));
}

/// Names the constraints whose multiples add up to 0 = something else.
std::string ConstraintRows::ContradictionMessage(
    int index, const std::vector<std::pair<int, double>>& used) const {
  std::vector<double> factors(rows_.size(), 0.0);
  for (const auto& [r, factor] : used) factors[static_cast<std::size_t>(r)] = factor;
  std::vector<int> involved = {index};
  for (std::size_t r = rows_.size(); r-- > 0;) {
    const double factor = factors[r] / rows_[r].divisor;  // of the constraint itself
    if (std::abs(factors[r]) <= rows_[r].noise) continue;
    involved.push_back(rows_[r].constraint);
    for (const auto& [earlier, part] : rows_[r].used) {
      factors[static_cast<std::size_t>(earlier)] -= factor * part;
    }
  }
  std::sort(involved.begin(), involved.end());
  constexpr std::size_t kMostNames = 8;
  const std::size_t shown = involved.size() <= kMostNames ? involved.size() : kMostNames - 1;
  std::string names;
  for (std::size_t i = 0; i < shown; ++i) {
    const bool last = i + 1 == involved.size();
    names += (i == 0 ? "" : last ? " and " : ", ") + Name(involved[i]);
  }
  if (shown < involved.size()) names += " and " + std::to_string(involved.size() - shown) + " more";
  return "linear constraints " + names + " contradict each other";
}

void ConstraintRows::Finish() {
  for (std::size_t r = rows_.size(); r-- > 0;) {
    Row& row = rows_[r];
    Combination left;
    left.AddValue(row.value);
    for (const auto& [variable, coefficient] : row.tail) left.Add(variable, coefficient);
    for (const auto& [variable, coefficient] : row.tail) {
      if (row_of(variable) < 0) continue;
      const double factor = left.Take(variable);
      if (factor != 0.0) left.Subtract(factor, rows_[static_cast<std::size_t>(row_of(variable))]);
    }
    left.DropNoise();
    row.tail.clear();
    for (const auto& [variable, sum] : left.entries()) row.tail.emplace_back(variable, sum.value);
    row.value = left.value();
  }
}

}  // namespace batten
