#ifndef BATTEN_EXPERIMENTS_ANDERSON_PAPER_GROWTH_H_
#define BATTEN_EXPERIMENTS_ANDERSON_PAPER_GROWTH_H_

#include <memory>
#include <string>
#include <vector>

#include "experiments/reproduction.h"
#include "problems/problem.h"

namespace batten {

/// Times per iteration against a size: "points" or "control_points".
std::vector<std::string> GrowthColumns();
/// Adds the times of all solvers of the experiment on one problem; `done` of the run is done.
void AddGrowthRows(const Problem& problem, const ExperimentRun& run, double done, CsvTable* table);
/// Power of `size` with which a solver's time per iteration grows: slope of the fit of logarithms;
/// NaN for fewer than two sizes.
double GrowthPower(const CsvTable& table, const std::string& solver, const std::string& size);

/// The paper's two methods: holds where neither grows faster than size^1.15.
Judgement JudgeLinear(const ExperimentTables& tables, const std::string& size);
/// PDM, TDM and SDM: holds where all grow faster than size^1.5.
Judgement JudgeSlowsDown(const ExperimentTables& tables, const std::string& size);

std::vector<PlotPanel> AgainstGrowth(const ExperimentTables& tables, const std::string& size);
/// One row per size, one column per solver, in microseconds.
CsvTable GrowthShown(const ExperimentTables& tables, const std::string& size);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_ANDERSON_PAPER_GROWTH_H_
