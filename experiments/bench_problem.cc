#include "experiments/bench_problem.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "experiments/start_comparison.h"

namespace batten {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Standard normal, by Box and Muller: std::normal_distribution differs between libraries.
class Noise {
 public:
  explicit Noise(int seed) : random_(static_cast<std::uint64_t>(seed)) {}
  double Next() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - Uniform()));
    return radius * std::cos(2.0 * kPi * Uniform());
  }

 private:
  double Uniform() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  std::mt19937_64 random_;
};

BsplineBasis TruthBasis(const FitSpec& spec) {
  const EndKnots ends = spec.closed ? EndKnots::kPeriodic : EndKnots::kEndInterpolating;
  std::vector<double> knots = UniformKnots(spec.degree, spec.control_points, ends, 0.0, 1.0);
  return *BsplineBasis::Make(spec.degree, spec.closed, std::move(knots), nullptr);
}

}  // namespace

Points TruthControlPoints(const SyntheticTruth& truth, const FitSpec& spec) {
  const int n = spec.control_points;
  Points points(n, 2);
  for (int j = 0; j < n; ++j) {
    if (truth.shape == "star") {
      const double angle = 2.0 * kPi * j / n;
      // No symmetry, so that no control point is like another.
      const double radius = 1.0 + 0.3 * std::sin(3.0 * angle + 0.4) + 0.1 * std::cos(5.0 * angle);
      points.row(j) << radius * std::cos(angle), radius * std::sin(angle);
    } else {
      const double x = static_cast<double>(j) / std::max(1, n - 1);
      points.row(j) << x, 0.3 * std::sin(7.0 * x + 0.2) + 0.1 * std::cos(17.0 * x * x);
    }
  }
  return points;
}

DataSet SyntheticData(const SyntheticTruth& truth, const FitSpec& spec, int seed) {
  const BsplineCurve curve(TruthBasis(spec), TruthControlPoints(truth, spec));
  const int m = truth.points;
  const double last = spec.closed ? m : m - 1;
  DataSet data;
  data.name = spec.name;
  data.parameters = Eigen::VectorXd::LinSpaced(m, 0.0, (m - 1) / last);
  data.points = curve.Sample(*data.parameters);
  Noise noise(seed);
  for (double& value : data.points.reshaped<Eigen::RowMajor>()) value += truth.noise * noise.Next();
  return data;
}

std::vector<NameSpec> TermsOf(const BenchProblem& problem, const BenchTerms& terms) {
  if (terms.terms.empty()) return problem.own_terms;
  std::vector<NameSpec> used = terms.terms;
  for (NameSpec& term : used) {
    if (term.name == "distance") term.name = DistanceTermOf(problem.entry.spec.parameter_kind);
  }
  return used;
}

std::string TermsIdentity(const BenchProblem& problem, const BenchTerms& terms) {
  std::vector<NameSpec> used = TermsOf(problem, terms);
  if (used.empty()) used = {{DistanceTermOf(problem.entry.spec.parameter_kind), {}, nullptr}};
  std::vector<std::string> texts;
  for (const NameSpec& term : used) {
    const Term* found = nullptr;
    OptionValues options;
    std::string ignored;
    texts.push_back(term.name);
    if (!TermRegistry::Global().Resolve(term, &found, &options, &ignored)) continue;
    for (const auto& [name, value] : options.ToText()) texts.back() += "/" + name + "=" + value;
  }
  std::sort(texts.begin(), texts.end());
  std::string identity;
  for (const std::string& text : texts) identity += text + " ";
  return identity;
}

bool UsesDataSeed(const BenchProblem& problem) {
  return problem.truth.has_value() && problem.truth->noise > 0.0;
}

bool UsesStartSeed(const BenchProblem& problem) {
  return problem.entry.spec.parameter_kind != ParameterKind::kFixed;
}

std::unique_ptr<Problem> MakeBenchProblem(const BenchProblem& problem, const BenchTerms& terms,
                                          const CellSeeds& seeds, std::string* error) {
  constexpr double kDisturbance = 0.3;  // of the radius, as `compare --starts` has it
  CatalogueEntry entry = problem.entry;
  entry.spec.terms = TermsOf(problem, terms);
  std::unique_ptr<Problem> made =
      problem.truth.has_value()
          ? MakeFitProblem(SyntheticData(*problem.truth, entry.spec, seeds.data), entry.spec, error)
          : LoadProblem(entry, error);
  if (made == nullptr || seeds.start == 0) return made;
  return FromDisturbedCircle(*made, kDisturbance, static_cast<std::uint64_t>(seeds.start), 0,
                             error);
}

}  // namespace batten
