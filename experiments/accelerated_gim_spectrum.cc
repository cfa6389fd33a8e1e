#include <glog/logging.h>

#include <algorithm>
#include <cmath>

#include "experiments/accelerated_gim.h"
#include "experiments/experiment_runs.h"
#include "solvers/lanczos.h"

namespace batten {
namespace {

constexpr std::uint64_t kSeed = 20161202;
constexpr double kTolerance = 0.05;

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

/// Factor of the error's norm between the gaps 1e-16 and 1e-24; over the last third of runs that do
/// not come so far. NaN for few iterations.
double RateFromGaps(const CsvTable& trace) {
  const std::vector<double> gaps = trace.Numbers("gap");
  const auto first_below = [&gaps](double level) {
    const auto found =
        std::find_if(gaps.begin(), gaps.end(), [level](double gap) { return gap < level; });
    return static_cast<std::size_t>(found - gaps.begin());
  };
  std::size_t begin = first_below(1e-16);
  std::size_t end = first_below(1e-24);
  if (end >= gaps.size()) {
    begin = 2 * gaps.size() / 3;
    end = gaps.size() - 1;
  }
  constexpr std::size_t kFewest = 5;
  if (begin + kFewest > end || end >= gaps.size()) return std::nan("");
  return std::pow(gaps[end] / gaps[begin], 0.5 / static_cast<double>(end - begin));
}

double PredictedRate(const RunResult& run) {
  for (const auto& [name, value] : run.notes) {
    double number = 0.0;
    const bool is_rate = name == "predicted rate" || name.rfind("spectral radius of ", 0) == 0;
    if (is_rate && ParseNumber(value, &number)) return number;
  }
  return std::nan("");
}

bool RunParameters(const ExperimentRun& run, ExperimentTables* tables, std::string* error) {
  CsvTable& runs = (*tables)[""] =
      CsvTable(RunColumnsBehind({"parameters", "predicted_rate", "measured_rate"}));
  const std::shared_ptr<const Problem> outline = CatalogueProblem("rhino_interpolation", error);
  if (outline == nullptr) return false;
  const std::vector<Parameters> all = AllParameters(*outline);
  double done = 0.0;
  for (const Parameters& parameters : all) {
    if (run.progress) run.progress(done / static_cast<double>(all.size()), parameters.name);
    done += 1.0;
    ProblemRuns on("rhino_interpolation", AtParameters(*outline, parameters.values),
                   run.repetitions);
    for (const RunSpec& spec : {NativeSpec(1e-6), RaceSpec(0.0)}) {
      for (const char* solver : {"gim", "weighted_pia", "lspia/step=optimal", "lbfgs", "cg"}) {
        if (InterruptRequested()) return true;
        CsvTable rows(RunColumns());
        CsvTable traces(TraceColumns());
        RunSpec limited = spec;
        limited.max_iterations = 3000;
        const RunResult result = on.Run(solver, limited, &rows, &traces);
        AddRowsBehind(
            {parameters.name, NumberText(PredictedRate(result)), NumberText(RateFromGaps(traces))},
            rows, &runs);
      }
    }
  }
  return true;
}

Judgement JudgeRates(const ExperimentTables& tables) {
  Judgement judgement;
  int judged = 0, agree = 0, diverged = 0, foretold = 0;
  double worst = 0.0;
  std::string worst_run = "none";
  for (const char* solver : {"gim", "weighted_pia", "lspia/step=optimal"}) {
    const CsvTable rows = tables.at("").Where("mode", "race").Where("solver", solver);
    for (std::size_t row = 0; row < rows.num_rows(); ++row) {
      const double predicted = rows.Number(row, "predicted_rate");
      const double measured = rows.Number(row, "measured_rate");
      if (rows.Text(row, "status") == "diverged") {
        ++diverged;
        foretold += predicted >= 1.0 ? 1 : 0;
      }
      if (std::isnan(measured) || std::isnan(predicted)) continue;
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
  judgement.verdict = agree == judged && foretold == diverged ? ClaimVerdict::kHolds
                      : 2 * agree >= judged                   ? ClaimVerdict::kInPart
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
  for (const char* solver : {"gim", "weighted_pia", "lspia/step=optimal"}) {
    const CsvTable rows = race.Where("solver", solver);
    rate.series.push_back({solver, rows.Numbers("predicted_rate"), rows.Numbers("measured_rate"),
                           PlotSeries::Style::kPoints, color++});
  }
  rate.series.push_back({"equal", {0.3, 1.0}, {0.3, 1.0}, PlotSeries::Style::kDashed, 7});
  const std::vector<double> radius = race.Where("solver", "gim").Numbers("predicted_rate");
  color = 0;
  for (const char* solver : {"gim", "lbfgs", "cg"}) {
    count.series.push_back({solver, radius, race.Where("solver", solver).Numbers("iterations"),
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
      "until spans have none (`pairs`). Predicted: the spectral radius of I - A for gim, of I - w "
      "A "
      "for weighted_pia, (l1 - ln) / (l1 + ln) for LSPIA. Measured: the factor of the error "
      "between "
      "the gaps 1e-16 and 1e-24. Runs end after 3,000 iterations.";
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
       "iterations per digit, 1 / log(rate): holds where all those of gim, weighted_pia and "
       "lspia/step=optimal are within 5 % of the predicted ones and every divergence was "
       "predicted, "
       "in part where half of them are",
       &JudgeRates}};
  experiment.figures = {{"spectrum_rates",
                         "Left: measured against predicted rates. Right: what the spectral radius "
                         "does to GIM, less to L-BFGS and hardly to CG.",
                         2, &PredictedAgainstMeasured}};
  return experiment;
}

}  // namespace batten
