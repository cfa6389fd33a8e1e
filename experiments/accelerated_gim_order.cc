#include <algorithm>
#include <cmath>

#include "experiments/accelerated_gim.h"
#include "experiments/comparison.h"
#include "experiments/experiment_runs.h"

namespace batten {
namespace {

constexpr const char* kProblems[] = {"rhino", "squirrel", "dolphin", "cat"};
constexpr const char* kSolvers[] = {"lspia",
                                    "lspia/step=optimal",
                                    "lspia/step=cauchy",
                                    "lspia/step=barzilai_borwein",
                                    "jacobi_pia",
                                    "gauss_seidel_pia",
                                    "sor_pia",
                                    "polyak_lspia",
                                    "nesterov_lspia",
                                    "mlspia",
                                    "chebyshev_lspia",
                                    "randomised_pia",
                                    "anderson:lspia",
                                    "cg",
                                    "lbfgs",
                                    "lbfgs/memory=20",
                                    "newton",
                                    "banded_cholesky"};
// As many control points as points, for the methods that need it.
constexpr const char* kThrough = "rhino_interpolation";
constexpr const char* kPairedSolvers[] = {"gim", "weighted_pia", "local_pia", "extended_pia",
                                          "preconditioned_pia"};
// The square root of the gap is the error; below this gap it is rounding.
constexpr double kLeastGap = 1e-26;
constexpr int kFewestErrors = 6;

/// Errors per iteration above rounding.
std::vector<double> Errors(const CsvTable& trace) {
  std::vector<double> errors;
  for (const double gap : trace.Numbers("gap")) {
    if (!(gap > kLeastGap)) break;
    errors.push_back(std::sqrt(gap));
  }
  return errors;
}

/// Geometric mean of e_(k+1) / e_k over steps begin .. end - 1.
double MeanFactor(const std::vector<double>& errors, std::size_t begin, std::size_t end) {
  return std::pow(errors[end] / errors[begin], 1.0 / static_cast<double>(end - begin));
}

/// Slope of log e_(k+1) on log e_k over the last half.
double Order(const std::vector<double>& errors) {
  const auto last = static_cast<Eigen::Index>(errors.size()) - 1;
  const Eigen::Index first = last / 2;
  const Eigen::Index count = last - first;
  Eigen::ArrayXd x(count), y(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    x[k] = std::log(errors[static_cast<std::size_t>(first + k)]);
    y[k] = std::log(errors[static_cast<std::size_t>(first + k + 1)]);
  }
  x -= x.mean();
  y -= y.mean();
  return (x * y).sum() / x.square().sum();
}

void AddRates(const CsvTable& traces, CsvTable* rates) {
  for (const std::string& problem : traces.Distinct("problem")) {
    const CsvTable on = traces.Where("problem", problem);
    for (const std::string& solver : on.Distinct("solver")) {
      const std::vector<double> errors = Errors(on.Where("solver", solver));
      std::vector<std::string> row = {problem, solver, std::to_string(errors.size()), "", "", ""};
      if (static_cast<int>(errors.size()) > kFewestErrors) {
        const std::size_t last = errors.size() - 1;
        row[3] = NumberText(MeanFactor(errors, 0, last / 3));
        row[4] = NumberText(MeanFactor(errors, last - last / 3, last));
        row[5] = NumberText(Order(errors));
      }
      rates->AddRow(row);
    }
  }
}

bool RunOrders(const ExperimentRun& run, ExperimentTables* tables, std::string* error) {
  CsvTable& runs = (*tables)[""] = CsvTable(RunColumns());
  CsvTable& traces = (*tables)["traces"] = CsvTable(TraceColumns());
  CsvTable& rates = (*tables)["rates"] =
      CsvTable({"problem", "solver", "iterations", "first_factor", "last_factor", "order"});
  std::vector<std::string> problems(std::begin(kProblems), std::end(kProblems));
  problems.emplace_back(kThrough);
  double done = 0.0;
  for (const std::string& name : problems) {
    if (run.progress) run.progress(done / static_cast<double>(problems.size()), name);
    done += 1.0;
    std::shared_ptr<const Problem> problem = CatalogueProblem(name, error);
    if (problem == nullptr) return false;
    ProblemRuns on(name, problem, run.repetitions, run.recorder);
    std::vector<std::string> solvers(std::begin(kSolvers), std::end(kSolvers));
    if (name == kThrough) {
      solvers.insert(solvers.end(), std::begin(kPairedSolvers), std::end(kPairedSolvers));
    }
    for (const std::string& solver : solvers) {
      if (InterruptRequested()) return true;
      on.Run(solver, NativeSpec(1e-6), &runs);
      on.Run(solver, RaceSpec(1e-13), &runs, &traces);
    }
  }
  AddRates(traces, &rates);
  return true;
}

/// Ratios of times of `solver` and L-BFGS, native, over the problems.
std::vector<double> TimesSlower(const ExperimentTables& tables, const std::string& solver) {
  std::vector<double> ratios;
  const CsvTable native = tables.at("").Where("mode", "native");
  for (const char* problem : kProblems) {
    const CsvTable on = native.Where("problem", problem);
    const CsvTable slow = on.Where("solver", solver);
    const CsvTable fast = on.Where("solver", "lbfgs");
    if (slow.num_rows() == 1 && fast.num_rows() == 1) {
      ratios.push_back(slow.Number(0, "seconds") / fast.Number(0, "seconds"));
    }
  }
  return ratios;
}

Judgement JudgeTens(const ExperimentTables& tables) {
  const std::vector<double> ratios = TimesSlower(tables, "lspia");
  Judgement judgement;
  if (ratios.empty()) return judgement;
  const double least = *std::min_element(ratios.begin(), ratios.end());
  const double most = *std::max_element(ratios.begin(), ratios.end());
  judgement.because = "lspia takes " + Rounded(least, 1) + " to " + Rounded(most, 1) +
                      " times as long as lbfgs by the native rules; cg takes " +
                      Rounded(Median(TimesSlower(tables, "cg")), 1) + ", newton " +
                      Rounded(Median(TimesSlower(tables, "newton")), 1) + " times lbfgs (medians)";
  judgement.verdict = least >= 10.0  ? ClaimVerdict::kHolds
                      : most >= 10.0 ? ClaimVerdict::kInPart
                                     : ClaimVerdict::kDoesNotHold;
  return judgement;
}

Judgement JudgeSuperlinear(const ExperimentTables& tables) {
  const CsvTable rates = tables.at("rates").Where("solver", "lbfgs");
  Judgement judgement;
  int superlinear = 0;
  int judged = 0;
  for (std::size_t row = 0; row < rates.num_rows(); ++row) {
    const double first = rates.Number(row, "first_factor");
    const double last = rates.Number(row, "last_factor");
    if (std::isnan(first) || std::isnan(last)) continue;
    ++judged;
    superlinear += last < 0.1 * first ? 1 : 0;
    judgement.because += (judgement.because.empty() ? "mean factor of the error, first and last "
                                                      "third: "
                                                    : "; ") +
                         rates.Text(row, "problem") + " " + Rounded(first, 2) + " and " +
                         Rounded(last, 2);
  }
  if (judged == 0) return judgement;
  judgement.verdict = superlinear == judged ? ClaimVerdict::kHolds
                      : superlinear > 0     ? ClaimVerdict::kInPart
                                            : ClaimVerdict::kDoesNotHold;
  return judgement;
}

/// The rates, each beside the native run's count and time.
CsvTable RatesAndTimes(const ExperimentTables& tables) {
  CsvTable shown({"problem", "solver", "native iterations", "x cholesky", "factor at first",
                  "factor at last", "order"});
  const CsvTable& rates = tables.at("rates");
  const CsvTable native = tables.at("").Where("mode", "native");
  for (std::size_t row = 0; row < rates.num_rows(); ++row) {
    const CsvTable run = native.Where("problem", rates.Text(row, "problem"))
                             .Where("solver", rates.Text(row, "solver"));
    const auto of_run = [&run](const char* column) {
      return run.num_rows() == 1 ? run.Text(0, column) : std::string();
    };
    shown.AddRow({rates.Text(row, "problem"), rates.Text(row, "solver"), of_run("iterations"),
                  of_run("times_cholesky"), rates.Text(row, "first_factor"),
                  rates.Text(row, "last_factor"), rates.Text(row, "order")});
  }
  return shown;
}

std::vector<PlotPanel> Gaps(const ExperimentTables& tables) {
  std::vector<PlotPanel> panels;
  const CsvTable rhino = tables.at("traces").Where("problem", "rhino");
  const std::vector<std::vector<const char*>> groups = {
      {"lspia", "lspia/step=optimal", "lspia/step=barzilai_borwein", "sor_pia", "gauss_seidel_pia",
       "jacobi_pia"},
      {"polyak_lspia", "nesterov_lspia", "chebyshev_lspia", "anderson:lspia", "cg", "lbfgs"}};
  for (const auto& group : groups) {
    PlotPanel panel;
    panel.title = "rhino";
    panel.x_label = "iteration";
    panel.y_label = "gap of E";
    panel.log_y = true;
    int color = 0;
    for (const char* solver : group) {
      const CsvTable rows = rhino.Where("solver", solver);
      panel.series.push_back({solver, rows.Numbers("iteration"), rows.Numbers("gap"),
                              PlotSeries::Style::kLine, color++});
    }
    panels.push_back(std::move(panel));
  }
  return panels;
}

}  // namespace

Experiment AcceleratedGimOrder() {
  Experiment experiment;
  experiment.name = "order";
  experiment.title = "Speed, rate and order of every method";
  experiment.text =
      "The four outlines by every method of the family, and the rhinoceros through all its points "
      "by "
      "those that need as many control points as points too, to |g| <= 1e-13 |g(start)| (race) and "
      "by "
      "the "
      "native rules. The error is the root of the gap, computed without cancellation. Its mean "
      "factor per iteration over the first and the last third tells a linear method (equal) from a "
      "superlinear one (towards zero); the order is the slope of log e_(k+1) on log e_k over the "
      "last half. On a quadratic L-BFGS with few pairs is a linear method.";
  experiment.run = &RunOrders;
  experiment.shown = &RatesAndTimes;
  experiment.claims = {{"Tens to hundreds of times faster", "abstract",
                        "ratio of native times of lspia and lbfgs: holds where it is at least 10 "
                        "on all four, in part "
                        "where it is on one",
                        &JudgeTens},
                       {"superlinear", "section on the method",
                        "holds where on every outline the mean factor of the last third of lbfgs "
                        "is below a tenth of "
                        "that of the first, in part where on one",
                        &JudgeSuperlinear}};
  experiment.figures = {
      {"order_gaps", "Gap of E against iteration on the rhinoceros, race.", 2, &Gaps}};
  return experiment;
}

}  // namespace batten
