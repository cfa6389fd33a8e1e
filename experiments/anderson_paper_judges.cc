#include "experiments/anderson_paper_judges.h"

#include <algorithm>
#include <cmath>

#include "experiments/anderson_paper_runs.h"
#include "experiments/experiment_runs.h"
#include "experiments/short_number.h"

namespace batten {
namespace {

constexpr int kDigits = 3;

/// The rows of both methods on one example.
struct Pair {
  std::string example;
  CsvTable lbfgs;
  CsvTable anderson;
};

/// Of `table`, one per example, the paper's before ours; in the main table a method has one row, in
/// traces many.
std::vector<Pair> Pairs(const ExperimentTables& tables, const char* table) {
  std::vector<Pair> pairs;
  for (const std::string& example : ShownExampleNames()) {
    const CsvTable on = tables.at(table).Where("example", example);
    pairs.push_back({example, on.Where("solver", kJointLbfgs), on.Where("solver", kAndersonPdm)});
  }
  return pairs;
}

bool Has(const Pair& pair, const std::string& column) {
  return !std::isnan(OnlyNumber(pair.lbfgs, column)) &&
         !std::isnan(OnlyNumber(pair.anderson, column));
}

/// Whether the paper's claims are judged on it: ours is told beside them.
bool IsCounted(const Pair& pair) { return IsPaperExample(pair.example); }

/// False where a pair that counts has no figure to be judged by.
bool AllHave(const std::vector<Pair>& pairs, const std::string& column) {
  return std::all_of(pairs.begin(), pairs.end(),
                     [&](const Pair& pair) { return !IsCounted(pair) || Has(pair, column); });
}

bool EndInOneBasin(const Pair& pair) {
  return InOneBasin(OnlyNumber(pair.lbfgs, "polished_energy"),
                    OnlyNumber(pair.anderson, "polished_energy"));
}

void Append(const std::string& text, std::string* because) {
  *because += (because->empty() ? "" : "; ") + text;
}

std::string Label(const std::string& example) {
  return ExampleLabel(example) + (IsPaperExample(example) ? "" : ", not counted");
}
std::string Label(const Pair& pair) { return Label(pair.example); }

std::string OtherBasin(const Pair& pair) {
  return Label(pair) + ": other minima, E " +
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
  double error = NAN;
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
  if (lbfgs.num_rows() < 2 || anderson.num_rows() < 2) return NAN;
  const double begin = std::min(lbfgs.Number(1, "seconds"), anderson.Number(1, "seconds"));
  const double end = std::max(lbfgs.Number(lbfgs.num_rows() - 1, "seconds"),
                              anderson.Number(anderson.num_rows() - 1, "seconds"));
  if (!(begin > 0.0) || !(end > begin)) return NAN;
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

int NumPaperExamples() { return static_cast<int>(PaperExampleNames().size()); }

/// Largest ratio of both errors, either way, over iterations 1 to 5; NaN without them.
double LargestRatio(const Pair& traces) {
  constexpr int kFirst = 5;
  double largest = 1.0;
  for (int k = 1; k <= kFirst; ++k) {
    const std::string iteration = std::to_string(k);
    const double ratio = OnlyNumber(traces.anderson.Where("iteration", iteration), "foot_energy") /
                         OnlyNumber(traces.lbfgs.Where("iteration", iteration), "foot_energy");
    if (!(ratio > 0.0)) return NAN;
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
    if (!Has(pair, "polished_energy")) continue;
    if (!EndInOneBasin(pair)) {
      Append(OtherBasin(pair), &judgement.because);
      continue;
    }
    const auto of = [&pair](const char* column) {
      return std::pair(OnlyNumber(pair.anderson, column), OnlyNumber(pair.lbfgs, column));
    };
    Append(Label(pair) + ": " + Against(pair, "iterations_to_1e-6", 1.0, " iterations, ") +
               Against(pair, "seconds_to_1e-6", 1e3, " ms"),
           &judgement.because);
    if (!IsCounted(pair)) continue;
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
    if (!Has(pairs[k], "polished_energy")) continue;
    if (!EndInOneBasin(pairs[k])) {
      Append(OtherBasin(pairs[k]), &judgement.because);
      continue;
    }
    const double share = ShareOfTimes(traces[k].lbfgs, traces[k].anderson);
    if (std::isnan(share) && IsCounted(pairs[k])) return Judgement();
    if (std::isnan(share)) continue;
    Append(Label(pairs[k]) + ": at " + Rounded(100.0 * share, 0) + " % of the times",
           &judgement.because);
    if (!IsCounted(pairs[k])) continue;
    ++compared;
    least = std::min(least, share);
    most = std::max(most, share);
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
  for (const Pair& pair : Pairs(tables, "traces")) {
    const double ratio = LargestRatio(pair);
    if (std::isnan(ratio) && IsCounted(pair)) return Judgement();
    if (std::isnan(ratio)) continue;
    alike += IsCounted(pair) && ratio <= kFactor ? 1 : 0;
    Append(Label(pair) + ": by a factor of " + ShortNumber(ratio, 2), &judgement.because);
  }
  judgement.because = "largest difference of both in iterations 1 to 5, " + judgement.because;
  judgement.verdict = VerdictOf(alike, NumPaperExamples());
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
    if (std::isnan(per_iteration) && IsCounted(pair)) return Judgement();
    if (std::isnan(per_iteration)) continue;
    fewer += IsCounted(pair) && per_iteration < 1.0 ? 1 : 0;
    Append(Label(pair) + ": " + ShortNumber(per_iteration, kDigits) + " per iteration, L-BFGS " +
               ShortNumber(OnlyNumber(pair.lbfgs, "projections"), kDigits) + " in all",
           &judgement.because);
  }
  judgement.verdict = VerdictOf(fewer, NumPaperExamples());
  return judgement;
}

Judgement JudgeRejections(const ExperimentTables& tables) {
  constexpr double kHalf = 0.5;
  Judgement judgement;
  int taken = 0;
  for (const Pair& pair : Pairs(tables, "")) {
    const double share = OnlyNumber(pair.anderson, "rejected");
    if (std::isnan(share) && IsCounted(pair)) return Judgement();
    if (std::isnan(share)) continue;
    taken += IsCounted(pair) && share < kHalf ? 1 : 0;
    Append(Label(pair) + ": " + Rounded(100.0 * share, 0) + " % rejected", &judgement.because);
  }
  judgement.verdict = VerdictOf(taken, NumPaperExamples());
  return judgement;
}

Judgement JudgeUndamped(const ExperimentTables& tables) {
  Judgement judgement;
  int diverged = 0;
  for (const std::string& example : ShownExampleNames()) {
    const bool counts = IsPaperExample(example);
    const CsvTable row = tables.at("").Where("example", example).Where("solver", kUndampedTdm);
    // The start's E, not the end's, says whether the row is there: E may end as no number.
    const double start = OnlyNumber(row, "start_energy");
    if (std::isnan(start) && counts) return Judgement();
    if (std::isnan(start)) continue;
    const double end = OnlyNumber(row, "foot_energy");
    diverged += counts && !(end <= start) ? 1 : 0;
    Append(Label(example) + ": " + ShortNumber(start, kDigits) + " to " + ShortNumber(end, kDigits),
           &judgement.because);
  }
  judgement.because = "E at the feet from the start to the end, " + judgement.because;
  judgement.verdict = VerdictOf(diverged, NumPaperExamples());
  return judgement;
}

}  // namespace batten
