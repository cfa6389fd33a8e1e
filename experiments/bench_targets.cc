#include "experiments/bench_targets.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>

#include "experiments/comparison.h"

namespace batten {
namespace {

/// iteration, four counts, projections, seconds, cpu_seconds, energy: docs/formats.md.
constexpr int kNumFields = 9;

bool ReadFields(const std::string& line, std::array<double, kNumFields>* fields) {
  const char* at = line.c_str();
  for (double& field : *fields) {
    char* end = nullptr;
    field = std::strtod(at, &end);
    if (end == at) field = NAN;  // empty: no finite number
    if (*end != ',') return false;
    at = end + 1;
  }
  return true;
}

/// The first row at which E is low enough.
std::size_t FirstRow(const ShortTrace& trace, double energy) {
  const auto found = std::find_if(trace.energies.begin(), trace.energies.end(),
                                  [energy](double value) { return value <= energy; });
  return static_cast<std::size_t>(found - trace.energies.begin());
}

}  // namespace

ShortTrace ReadShortTrace(const std::string& path) {
  ShortTrace trace;
  std::ifstream file(path, std::ios::binary);
  std::string line;
  std::getline(file, line);  // header
  std::array<double, kNumFields> fields{};
  while (std::getline(file, line) && ReadFields(line, &fields)) {
    trace.evaluations.push_back(fields[1] + fields[2] + fields[3] + fields[4]);
    trace.seconds.push_back(fields[6]);
    trace.energies.push_back(fields[8]);
  }
  return trace;
}

double TargetEnergy(const BenchInstance& instance, const BenchTarget& target,
                    double minimum_energy) {
  if (target.gap == 0.0) return instance.truth_energy;
  const double fall = instance.start_energy - minimum_energy;
  // Energies carry rounding; 1000 of them are left to see.
  constexpr double kNoise = 1000 * std::numeric_limits<double>::epsilon();
  if (!(target.gap * fall > kNoise * std::abs(minimum_energy))) return NAN;
  return minimum_energy + target.gap * fall;
}

std::array<double, 3> CostsTo(double energy, const std::vector<ShortTrace>& traces,
                              const std::vector<bool>& is_timed, double unit_seconds) {
  if (traces.empty() || std::isnan(energy)) return {HUGE_VAL, HUGE_VAL, HUGE_VAL};
  // The clock's own step: no cost is 0.
  constexpr double kTick = 1e-9;
  std::vector<double> evaluations;
  std::vector<double> seconds;
  for (std::size_t k = 0; k < traces.size(); ++k) {
    const std::size_t row = FirstRow(traces[k], energy);
    const bool reached = row < traces[k].energies.size();
    evaluations.push_back(reached ? std::max(1.0, traces[k].evaluations[row]) : HUGE_VAL);
    if (!is_timed[k]) continue;
    seconds.push_back(reached ? std::max(kTick, traces[k].seconds[row]) : HUGE_VAL);
  }
  const double calls = Median(evaluations);
  const double unknown = std::isinf(calls) ? HUGE_VAL : NAN;  // a failure needs no clock
  const double time = seconds.empty() ? unknown : Median(seconds);
  return {calls, std::isinf(time) ? HUGE_VAL : time / unit_seconds, time};
}

}  // namespace batten
