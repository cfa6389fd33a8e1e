#ifndef BATTEN_EXPERIMENTS_ANDERSON_PAPER_RUNS_H_
#define BATTEN_EXPERIMENTS_ANDERSON_PAPER_RUNS_H_

#include <memory>
#include <string>
#include <vector>

#include "experiments/csv_table.h"
#include "experiments/run.h"
#include "experiments/run_recorder.h"
#include "problems/fit_problem.h"

namespace batten {

// The paper's two methods.
inline constexpr const char* kAndersonPdm = "anderson/window=5:pdm";
inline constexpr const char* kJointLbfgs = "lbfgs";
// The undamped method of which they say that it diverges.
inline constexpr const char* kUndampedTdm = "tdm/damping=0/search=none";
/// All methods whose iterations can be compared: the paper's two, then ours.
const std::vector<std::string>& IteratingMethods();
// Of each kind one, as many as there are colours.
inline constexpr const char* kDrawnMethods[] = {kJointLbfgs, kAndersonPdm,  "pdm",    "tdm",
                                                "sdm",       "foot_newton", "newton", "lm_schur"};

/// A point set that the paper's experiments are run on.
struct PaperExample {
  std::string name;
  int control_points = 0;
  Points points;
};
/// The paper's three, on which alone its claims are judged: smooth, sharp and noisy.
const std::vector<std::string>& PaperExampleNames();
/// Those, then ours, which is shown beside them: crawling.
const std::vector<std::string>& ShownExampleNames();
bool IsPaperExample(const std::string& name);
/// The name, and whether the example is ours.
std::string ExampleLabel(const std::string& name);
/// In the order of ShownExampleNames. False with one sentence in `error` where data are missing.
bool ShownExamples(std::vector<PaperExample>* examples, std::string* error);

/// Closed uniform cubic with free parameters. `start` is a word as in FitSpec.
std::shared_ptr<const Problem> FreeFit(const Points& points, int control_points,
                                       const std::string& start);
/// From other control points than the circle's.
std::shared_ptr<const Problem> FreeFitFrom(const Points& points, const Points& start);

/// The columns that RunFree fills, and those of its traces: one row per iterate that is kept, all
/// of the first 50 and then every 30th part more.
std::vector<std::string> FreeRunColumns();
std::vector<std::string> FreeTraceColumns();

/// A problem with the labels that it has in tables.
struct FreeCase {
  std::string example;
  std::string start;
  std::shared_ptr<const Problem> problem;
  RunRecorder* recorder = nullptr;  ///< Keeps the runs; may be null.
};

/// The race of the introduction.
RunSpec FreeRaceSpec();
/// Runs `solver` and adds a row to `runs` and, if not null, its trace to `traces`. One that does
/// not apply gives a row that says so.
RunResult RunFree(const FreeCase& on, const std::string& solver, const RunSpec& spec,
                  int repetitions, CsvTable* runs, CsvTable* traces);

/// Seconds per iteration of the run with the median time, set-up left out, over the first
/// `iterations` iterations; NaN where the solver made none.
double SecondsPerIteration(const Problem& problem, const std::string& solver, int iterations,
                           int repetitions);

/// Sum of squared distances of the data from the curve of `x`, in the user's units.
double FootEnergy(const Problem& problem, const Eigen::VectorXd& x);

/// 401 points of the curve of `x`, evenly spaced in its parameter, and the length of a polygon.
Points SampledCurve(const Problem& problem, const Eigen::VectorXd& x);
double PolygonLength(const Points& polygon);

/// The cell of a table that has one row, else NaN.
double OnlyNumber(const CsvTable& rows, const std::string& column);
/// Polished energies that agree to 1e-3.
bool InOneBasin(double polished, double other);
/// Whether a count or a time that is NaN where the aim was not reached is the lesser one.
bool IsSooner(double value, double other);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_ANDERSON_PAPER_RUNS_H_
