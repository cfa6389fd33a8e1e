#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/accelerated_gim.h"
#include "experiments/experiment_runs.h"
#include "solvers/lanczos.h"
#include "solvers/normal_spectrum.h"
#include "splines/dense_eigenvalues.h"

namespace batten {
namespace {

constexpr std::uint64_t kSeed = 20161202;
constexpr double kTolerance = 0.05;
constexpr double kMostIterations = 3000.0;
// The methods of which the matrix foretells the rate.
constexpr const char* kForetold[] = {"gim", "weighted_pia", kOptimalLspia, "jacobi_pia/w=1"};

struct Parameters {
  std::string name;
  Eigen::VectorXd values;  // in [0, 1), rising
};

Eigen::VectorXd Rule(const Problem& outline, Parameterization rule) {
  FitSpec spec = outline.curve_fit()->spec();
  spec.parameters = rule;
  return CheckedFit(outline.curve_fit()->data(), spec)->curve_fit()->parameters();
}

/// From uniform to such as no author would choose: offsets, random shifts, and points crowded by
/// pairs until spans have none.
std::vector<Parameters> AllParameters(const Problem& outline) {
  const Eigen::Index m = outline.curve_fit()->parameters().size();
  const auto count = static_cast<double>(m);
  std::vector<Parameters> all;
  const auto from = [&](double (*place)(double, double), double amount) {
    Eigen::VectorXd t(m);
    for (Eigen::Index i = 0; i < m; ++i) t[i] = place(static_cast<double>(i), amount) / count;
    return t;
  };
  for (const double offset : {0.0, 0.2, 0.4}) {
    all.push_back({"uniform + " + NumberText(offset),
                   from([](double i, double by) { return i + by; }, offset)});
  }
  all.push_back({"centripetal", Rule(outline, Parameterization::kCentripetal)});
  all.push_back({"chord length", Rule(outline, Parameterization::kChordLength)});
  const Eigen::VectorXd noise = RandomStart(m, kSeed);
  for (const double jitter : {0.1, 0.3, 0.45}) {
    Eigen::VectorXd t = all.front().values;
    for (Eigen::Index i = 1; i < m; ++i) t[i] += jitter * noise[i] / count;
    all.push_back({"jitter " + NumberText(jitter), t});
  }
  for (const double crowding : {0.3, 0.45, 0.7, 0.95}) {
    all.push_back({"pairs " + NumberText(crowding),
                   from([](double i, double by) { return std::fmod(i, 2.0) == 1.0 ? i - by : i; },
                        crowding)});
  }
  return all;
}

/// Factor of the error's norm between the gaps 1e-16 and 1e-24, which tells the rate in the long
/// run. NaN for runs that do not come so far, or pass through in few iterations.
double RateFromGaps(const CsvTable& trace) {
  const std::vector<double> gaps = trace.Numbers("gap");
  const auto first_below = [&gaps](double level) {
    const auto found =
        std::find_if(gaps.begin(), gaps.end(), [level](double gap) { return gap < level; });
    return static_cast<std::size_t>(found - gaps.begin());
  };
  const std::size_t begin = first_below(1e-16);
  const std::size_t end = first_below(1e-24);
  constexpr std::size_t kFewest = 5;
  if (begin + kFewest > end || end >= gaps.size()) return std::nan("");
  return std::pow(gaps[end] / gaps[begin], 0.5 / static_cast<double>(end - begin));
}

double Note(const RunResult& run, const std::string& name) {
  for (const auto& [noted, value] : run.notes) {
    double number = 0.0;
    if (noted.rfind(name, 0) == 0 && ParseNumber(value, &number)) return number;
  }
  return std::nan("");
}

/// Eigenvalues of A'A, or of diag(A'A)^-1 A'A, by dense algebra, without those of the null space:
/// the estimates that the methods themselves work with can miss the smallest ones.
Eigen::VectorXd EigenvaluesOfNormalMatrix(const Problem& problem, bool unit_diagonal) {
  Objective objective(&problem, nullptr);
  const NormalBand& band = objective.curve_view()->normal_band();
  const NormalBand scaled = unit_diagonal ? ScaledToUnitDiagonal(band) : band;
  const int n = band.size();
  const int d = band.dimension();
  Eigen::MatrixXd matrix(n, n);
  for (int j = 0; j < n; ++j) {
    Eigen::VectorXd unit = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n) * d);
    Eigen::VectorXd column(unit.size());
    unit[static_cast<Eigen::Index>(j) * d] = 1.0;
    scaled.Multiply(unit.data(), column.data());
    for (int k = 0; k < n; ++k) matrix(k, j) = column[static_cast<Eigen::Index>(k) * d];
  }
  const Eigen::VectorXd all = SymmetricEigenvalues(matrix);
  const double null = n * std::numeric_limits<double>::epsilon() * all.maxCoeff();
  return all.tail((all.array() > null).count());
}

/// Largest |1 - step l| over the eigenvalues l: how P += step D shrinks the error in the long run.
double LargestFactor(const Eigen::VectorXd& eigenvalues, double step) {
  return (1.0 - step * eigenvalues.array()).abs().maxCoeff();
}

/// Of the method's matrix; NaN for methods that have none.
double PredictedRate(const Problem& problem, const std::string& solver, const RunResult& run) {
  if (solver == kOptimalLspia) {
    const Eigen::VectorXd all = EigenvaluesOfNormalMatrix(problem, false);
    return (all.maxCoeff() - all.minCoeff()) / (all.maxCoeff() + all.minCoeff());
  }
  if (solver.rfind("jacobi_pia", 0) == 0) {
    return LargestFactor(EigenvaluesOfNormalMatrix(problem, true), Note(run, "w"));
  }
  return Note(run, "spectral radius of ");
}

void AddRuns(const std::string& parameters, const std::vector<const char*>& solvers,
             ProblemRuns* on, CsvTable* table) {
  for (const RunSpec& spec : {NativeSpec(1e-6), RaceSpec(0.0)}) {
    for (const char* solver : solvers) {
      if (InterruptRequested()) return;
      CsvTable rows(RunColumns());
      CsvTable traces(TraceColumns());
      RunSpec limited = spec;
      limited.max_iterations = static_cast<int>(kMostIterations);
      const RunResult result = on->Run(solver, limited, &rows, &traces);
      AddRowsBehind({parameters, NumberText(PredictedRate(on->problem(), solver, result)),
                     NumberText(RateFromGaps(traces))},
                    rows, table);
    }
  }
}

bool RunParameters(const ExperimentRun& run, ExperimentTables* tables, std::string* error) {
  CsvTable& runs = (*tables)[""] =
      CsvTable(RunColumnsBehind({"parameters", "predicted_rate", "measured_rate"}));
  const std::shared_ptr<const Problem> outline = CatalogueProblem("rhino_interpolation", error);
  if (outline == nullptr) return false;
  const std::shared_ptr<const Problem> dolphin = CatalogueProblem("dolphin", error);
  if (dolphin == nullptr) return false;
  const std::vector<Parameters> all = AllParameters(*outline);
  double done = 0.0;
  for (const Parameters& parameters : all) {
    if (run.progress) run.progress(done / static_cast<double>(all.size()), parameters.name);
    done += 1.0;
    ProblemRuns on("rhino_interpolation", AtParameters(*outline, parameters.values),
                   run.repetitions, run.recorder);
    AddRuns(parameters.name,
            {"gim", "weighted_pia", kOptimalLspia, "jacobi_pia/w=1", "lbfgs", "cg"}, &on, &runs);
  }
  ProblemRuns on("dolphin", dolphin, run.repetitions, run.recorder);
  AddRuns("the dolphin as it is", {kOptimalLspia, "jacobi_pia/w=1", "lbfgs", "cg"}, &on, &runs);
  return true;
}

/// At this rate of the error, whose square is the gap.
double IterationsTo(double gap, double rate) {
  return rate < 1.0 ? 0.5 * std::log(gap) / std::log(rate)
                    : std::numeric_limits<double>::infinity();
}

Judgement JudgeRates(const ExperimentTables& tables) {
  Judgement judgement;
  int judged = 0, agree = 0, diverged = 0, foretold = 0, cut = 0, foretold_cut = 0;
  double worst = 0.0;
  std::string worst_run = "none";
  for (const char* solver : kForetold) {
    const CsvTable rows = tables.at("").Where("mode", "race").Where("solver", solver);
    for (std::size_t row = 0; row < rows.num_rows(); ++row) {
      const double predicted = rows.Number(row, "predicted_rate");
      const double measured = rows.Number(row, "measured_rate");
      if (rows.Text(row, "status") == "diverged") {
        ++diverged;
        foretold += predicted >= 1.0 ? 1 : 0;
      }
      if (std::isnan(predicted)) continue;
      if (std::isnan(measured)) {
        if (rows.Text(row, "status") != "iteration_limit") continue;
        ++cut;
        foretold_cut += IterationsTo(1e-24, predicted) > kMostIterations ? 1 : 0;
        continue;
      }
      ++judged;
      const double error = std::abs(std::log(predicted) / std::log(measured) - 1.0);
      if (error > worst) {
        worst = error;
        worst_run = std::string(solver) + " with parameters " + rows.Text(row, "parameters");
      }
      agree += error <= kTolerance ? 1 : 0;
    }
  }
  if (judged == 0) return judgement;
  judgement.because = std::to_string(agree) + " of " + std::to_string(judged) +
                      " numbers of iterations per digit are within 5 % of the predicted one; the "
                      "farthest off is " +
                      worst_run;
  if (diverged > 0) {
    judgement.because += "; " + std::to_string(foretold) + " of " + std::to_string(diverged) +
                         " divergences had a spectral radius of 1 or more";
  }
  if (cut > 0) {
    judgement.because += "; " + std::to_string(foretold_cut) + " of " + std::to_string(cut) +
                         " runs that end at the limit were predicted not to come farther";
  }
  const bool all = agree == judged && foretold == diverged && foretold_cut == cut;
  judgement.verdict = all                   ? ClaimVerdict::kHolds
                      : 2 * agree >= judged ? ClaimVerdict::kInPart
                                            : ClaimVerdict::kDoesNotHold;
  return judgement;
}

std::vector<PlotPanel> PredictedAgainstMeasured(const ExperimentTables& tables) {
  PlotPanel rate;
  rate.title = "Rhinoceros, 100 points and control points";
  rate.x_label = "predicted rate";
  rate.y_label = "measured rate";
  PlotPanel count;
  count.title = "Iterations to the rounding floor";
  count.x_label = "spectral radius of I - A";
  count.y_label = "iterations";
  count.log_y = true;
  const CsvTable race = tables.at("").Where("mode", "race");
  int color = 0;
  for (const char* solver : kForetold) {
    const CsvTable rows = race.Where("solver", solver);
    rate.series.push_back({solver, rows.Numbers("predicted_rate"), rows.Numbers("measured_rate"),
                           PlotSeries::Style::kPoints, color++});
  }
  rate.series.push_back({"equal", {0.3, 1.0}, {0.3, 1.0}, PlotSeries::Style::kDashed, 7});
  const CsvTable rhino = race.Where("problem", "rhino_interpolation");
  const std::vector<double> radius = rhino.Where("solver", "gim").Numbers("predicted_rate");
  color = 0;
  for (const char* solver : {"gim", "lbfgs", "cg"}) {
    count.series.push_back({solver, radius, rhino.Where("solver", solver).Numbers("iterations"),
                            PlotSeries::Style::kPoints, color++});
  }
  return {rate, count};
}

}  // namespace

Experiment AcceleratedGimSpectrum() {
  Experiment experiment;
  experiment.name = "spectrum";
  experiment.title = "The rate and the collocation matrix";
  experiment.text =
      "The rhinoceros through all its 100 points, closed uniform cubic, with parameters from "
      "uniform "
      "to adversarial: offsets from the knots, centripetal and chord length on uniform knots, "
      "random "
      "shifts by up to 0.45 of a knot distance, and every second point moved towards its neighbour "
      "until spans have none (`pairs`); and the dolphin as it is. Predicted, from the eigenvalues "
      "by dense algebra: the spectral radius of I - A for gim, of I - w A for weighted_pia, (l1 - "
      "ln) / (l1 + ln) for LSPIA, the largest |1 - w l| over the eigenvalues l of diag(N)^-1 N for "
      "jacobi_pia, which with w = 1 must diverge where one is above 2. (What a run itself prints "
      "comes from Lanczos' estimates of the eigenvalues, in which a tiny ln can be missed.) "
      "Measured: the factor of the error between the gaps 1e-16 and 1e-24; `-` for runs that do "
      "not come so far. Runs end after 3,000 iterations, at the rounding floor, or when they "
      "diverge.";
  experiment.run = &RunParameters;
  experiment.shown = [](const ExperimentTables& tables) {
    CsvTable shown(
        {"parameters", "solver", "status", "iterations", "x cholesky", "predicted", "measured"});
    const CsvTable race = tables.at("").Where("mode", "race");
    for (std::size_t row = 0; row < race.num_rows(); ++row) {
      shown.AddRow({race.Text(row, "parameters"), race.Text(row, "solver"),
                    race.Text(row, "status"), race.Text(row, "iterations"),
                    race.Text(row, "times_cholesky"), race.Text(row, "predicted_rate"),
                    race.Text(row, "measured_rate")});
    }
    return shown;
  };
  experiment.claims = {
      {"The rate is tied to the collocation matrix", "introduction",
       "iterations per digit, 1 / log(rate): holds where all those of gim, weighted_pia, "
       "lspia/step=optimal and jacobi_pia are within 5 % of the predicted ones, every divergence "
       "had a radius of 1 or more, and every run cut at the limit was predicted to need more; in "
       "part where half of the first are",
       &JudgeRates}};
  experiment.figures = {{"spectrum_rates",
                         "Left: measured against predicted rates. Right: what the spectral radius "
                         "does to GIM, less to L-BFGS, hardly to CG.",
                         2, &PredictedAgainstMeasured}};
  return experiment;
}

}  // namespace batten
