#include "experiments/anderson_paper_judges.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/anderson_paper_runs.h"
#include "experiments/experiment_runs.h"
#include "experiments/short_number.h"

namespace batten {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr int kDigits = 3;

/// The rows of both methods on one example.
struct Pair {
  std::string example;
  CsvTable lbfgs;
  CsvTable anderson;
};

/// Of `table`, one per example; in the main table a method has one row, in traces many.
std::vector<Pair> Pairs(const ExperimentTables& tables, const char* table) {
  std::vector<Pair> pairs;
  for (const std::string& example : PaperExampleNames()) {
    const CsvTable on = tables.at(table).Where("example", example);
    pairs.push_back({example, on.Where("solver", kJointLbfgs), on.Where("solver", kAndersonPdm)});
  }
  return pairs;
}

/// False where a pair has no figure to be judged by.
bool AllHave(const std::vector<Pair>& pairs, const std::string& column) {
  return std::all_of(pairs.begin(), pairs.end(), [&](const Pair& pair) {
    return !std::isnan(OnlyNumber(pair.lbfgs, column)) &&
           !std::isnan(OnlyNumber(pair.anderson, column));
  });
}

bool EndInOneBasin(const Pair& pair) {
  return InOneBasin(OnlyNumber(pair.lbfgs, "polished_energy"),
                    OnlyNumber(pair.anderson, "polished_energy"));
}

void Append(const std::string& text, std::string* because) {
  *because += (because->empty() ? "" : "; ") + text;
}

std::string OtherBasin(const Pair& pair) {
  return pair.example + ": other minima, E " +
         ShortNumber(OnlyNumber(pair.anderson, "polished_energy"), kDigits) + " against " +
         ShortNumber(OnlyNumber(pair.lbfgs, "polished_energy"), kDigits);
}

/// A count with all its digits.
std::string Shown(double value) {
  return value == std::floor(value) ? NumberText(value) : ShortNumber(value, kDigits);
}

/// "5.2 against 3.1 ms"; one that is not reached is a dash.
std::string Against(const Pair& pair, const char* column, double factor, const char* unit) {
  return Shown(factor * OnlyNumber(pair.anderson, column)) + " against " +
         Shown(factor * OnlyNumber(pair.lbfgs, column)) + unit;
}

/// The last error that `trace` has had by `time`; NaN before its first row.
double ErrorAt(const CsvTable& trace, double time) {
  double error = kNaN;
  for (std::size_t row = 0; row < trace.num_rows(); ++row) {
    if (!(trace.Number(row, "seconds") <= time)) break;
    error = trace.Number(row, "foot_energy");
  }
  return error;
}

/// Share of equal times at which Anderson's error is the smaller one; NaN without traces.
double ShareOfTimes(const CsvTable& lbfgs, const CsvTable& anderson) {
  constexpr int kTimes = 200;
  constexpr double kRounding = 1e-6;
  // Row 0 is the start.
  if (lbfgs.num_rows() < 2 || anderson.num_rows() < 2) return kNaN;
  const double begin = std::min(lbfgs.Number(1, "seconds"), anderson.Number(1, "seconds"));
  const double end = std::max(lbfgs.Number(lbfgs.num_rows() - 1, "seconds"),
                              anderson.Number(anderson.num_rows() - 1, "seconds"));
  if (!(begin > 0.0) || !(end > begin)) return kNaN;
  int smaller = 0;
  for (int k = 0; k < kTimes; ++k) {
    const double time = begin * std::pow(end / begin, (k + 0.5) / kTimes);
    const double of_lbfgs = ErrorAt(lbfgs, time);
    const double of_anderson = ErrorAt(anderson, time);
    // One that is still in its set-up has no error yet.
    smaller += std::isnan(of_lbfgs) || of_anderson <= (1.0 + kRounding) * of_lbfgs ? 1 : 0;
  }
  return static_cast<double>(smaller) / kTimes;
}

/// Largest ratio of both errors, either way, over iterations 1 to 5; NaN without them.
double LargestRatio(const Pair& traces) {
  constexpr int kFirst = 5;
  double largest = 1.0;
  for (int k = 1; k <= kFirst; ++k) {
    const std::string iteration = std::to_string(k);
    const double ratio = OnlyNumber(traces.anderson.Where("iteration", iteration), "foot_energy") /
                         OnlyNumber(traces.lbfgs.Where("iteration", iteration), "foot_energy");
    if (!(ratio > 0.0)) return kNaN;
    largest = std::max({largest, ratio, 1.0 / ratio});
  }
  return largest;
}

}  // namespace

ClaimVerdict VerdictOf(int count, int of) {
  return count == of ? ClaimVerdict::kHolds
         : count > 0 ? ClaimVerdict::kInPart
                     : ClaimVerdict::kDoesNotHold;
}

Judgement JudgeFaster(const ExperimentTables& tables) {
  Judgement judgement;
  const std::vector<Pair> pairs = Pairs(tables, "");
  if (!AllHave(pairs, "polished_energy")) return judgement;
  int compared = 0, sooner = 0;
  for (const Pair& pair : pairs) {
    if (!EndInOneBasin(pair)) {
      Append(OtherBasin(pair), &judgement.because);
      continue;
    }
    const auto of = [&pair](const char* column) {
      return std::pair(OnlyNumber(pair.anderson, column), OnlyNumber(pair.lbfgs, column));
    };
    Append(pair.example + ": " + Against(pair, "iterations_to_1e-6", 1.0, " iterations, ") +
               Against(pair, "seconds_to_1e-6", 1e3, " ms"),
           &judgement.because);
    for (const char* column : {"iterations_to_1e-6", "seconds_to_1e-6"}) {
      const auto [anderson, lbfgs] = of(column);
      if (std::isnan(anderson) && std::isnan(lbfgs)) continue;
      ++compared;
      sooner += IsSooner(anderson, lbfgs) ? 1 : 0;
    }
  }
  judgement.because = "Anderson against L-BFGS to a gap of 1e-6, " + judgement.because;
  if (compared > 0) judgement.verdict = VerdictOf(sooner, compared);
  return judgement;
}

Judgement JudgeEqualTimes(const ExperimentTables& tables) {
  Judgement judgement;
  const std::vector<Pair> pairs = Pairs(tables, "");
  const std::vector<Pair> traces = Pairs(tables, "traces");
  if (!AllHave(pairs, "polished_energy")) return judgement;
  double least = 1.0, most = 0.0;
  int compared = 0;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (!EndInOneBasin(pairs[k])) {
      Append(OtherBasin(pairs[k]), &judgement.because);
      continue;
    }
    const double share = ShareOfTimes(traces[k].lbfgs, traces[k].anderson);
    if (std::isnan(share)) return Judgement();
    ++compared;
    least = std::min(least, share);
    most = std::max(most, share);
    Append(pairs[k].example + ": at " + Rounded(100.0 * share, 0) + " % of the times",
           &judgement.because);
  }
  constexpr double kHalf = 0.5;
  if (compared == 0) return judgement;
  judgement.verdict = least >= 1.0    ? ClaimVerdict::kHolds
                      : most >= kHalf ? ClaimVerdict::kInPart
                                      : ClaimVerdict::kDoesNotHold;
  return judgement;
}

Judgement JudgeAlike(const ExperimentTables& tables) {
  constexpr double kFactor = 2.0;
  Judgement judgement;
  int alike = 0;
  const std::vector<Pair> traces = Pairs(tables, "traces");
  for (const Pair& pair : traces) {
    const double ratio = LargestRatio(pair);
    if (std::isnan(ratio)) return Judgement();
    alike += ratio <= kFactor ? 1 : 0;
    Append(pair.example + ": by a factor of " + ShortNumber(ratio, 2), &judgement.because);
  }
  judgement.because = "largest difference of both in iterations 1 to 5, " + judgement.because;
  judgement.verdict = VerdictOf(alike, static_cast<int>(traces.size()));
  return judgement;
}

Judgement JudgeProjections(const ExperimentTables& tables) {
  Judgement judgement;
  const std::vector<Pair> pairs = Pairs(tables, "");
  if (!AllHave(pairs, "projections")) return judgement;
  int fewer = 0;
  for (const Pair& pair : pairs) {
    const double per_iteration =
        OnlyNumber(pair.anderson, "projections") / OnlyNumber(pair.anderson, "iterations");
    if (std::isnan(per_iteration)) return Judgement();
    fewer += per_iteration < 1.0 ? 1 : 0;
    Append(pair.example + ": " + ShortNumber(per_iteration, kDigits) + " per iteration, L-BFGS " +
               ShortNumber(OnlyNumber(pair.lbfgs, "projections"), kDigits) + " in all",
           &judgement.because);
  }
  judgement.verdict = VerdictOf(fewer, static_cast<int>(pairs.size()));
  return judgement;
}

Judgement JudgeRejections(const ExperimentTables& tables) {
  constexpr double kHalf = 0.5;
  Judgement judgement;
  const std::vector<Pair> pairs = Pairs(tables, "");
  int taken = 0;
  for (const Pair& pair : pairs) {
    const double share = OnlyNumber(pair.anderson, "rejected");
    if (std::isnan(share)) return Judgement();
    taken += share < kHalf ? 1 : 0;
    Append(pair.example + ": " + Rounded(100.0 * share, 0) + " % rejected", &judgement.because);
  }
  judgement.verdict = VerdictOf(taken, static_cast<int>(pairs.size()));
  return judgement;
}

}  // namespace batten
