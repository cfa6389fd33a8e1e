#ifndef BATTEN_PROBLEMS_ROBUST_START_H_
#define BATTEN_PROBLEMS_ROBUST_START_H_

#include <optional>
#include <string>
#include <vector>

#include "cost_functions/fit_setting.h"
#include "cost_functions/options.h"
#include "problems/problem.h"

namespace batten {

/// Some term has loss_scale=mad, or a loss that is not convex (cauchy, tukey).
bool AsksForRobustStart(const std::vector<NameSpec>& terms);

/// Huber's fit (huber_fit.h) of the terms of a curve fit under its linear constraints on control
/// points. Before the run and once:
/// - loss_scale=mad becomes a number in `terms`: the loss's tuning constant (95% efficiency for
///   normal errors: huber and soft_l1 1.345, cauchy 2.385, tukey 4.685) times sigma, the median of
///   the residuals over that of errors of standard deviation 1 (normalised MAD), in units of the
///   data's size.
/// - *start, the variables that a loss that is not convex starts from, is Huber's answer; nothing
///   where no loss needs it, or some term is no compiled row (but curve_fairing).
/// Where parameters are free or projected the points look for their feet after each fit; residuals
/// there are across the curve, one coordinate less. If `may_guard` and there is no fairing term,
/// such a fit with loss_scale=mad also gets the guard `length`, of weight sigma^2 (in units of the
/// data's squared size) per data point: a stretch of curve that runs out to a wild point costs more
/// than the loss gains by it, which without a guard costs nothing, since no other point is nearest
/// to it. It goes to zero with the noise, as M-type smoothing has it (Cox, Ann. Statist. 11, 1983).
/// `constraints`: the problem's linear ones, those of parameters among them, which hold ends.
/// False with one sentence in `error` where a scale cannot be estimated: terms that are no compiled
/// rows (but curve_fairing), or residuals that are zero.
/// Huber & Ronchetti, Robust Statistics, sec. 5.1 and 7.8; Holland & Welsch 1977 for the constants.
bool StartRobustly(const Problem& problem, const std::vector<LinearConstraint>& constraints,
                   const FitSetting& setting, bool may_guard, std::vector<NameSpec>* terms,
                   std::optional<Eigen::VectorXd>* start, std::string* error);

}  // namespace batten

#endif  // BATTEN_PROBLEMS_ROBUST_START_H_
