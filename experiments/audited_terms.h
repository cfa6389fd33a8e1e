#ifndef BATTEN_EXPERIMENTS_AUDITED_TERMS_H_
#define BATTEN_EXPERIMENTS_AUDITED_TERMS_H_

#include "experiments/audit.h"
#include "problems/fit_problem.h"

namespace batten {

/// Whether this term of the fit is the distance from the data and nothing else.
bool IsDistanceTerm(const Problem::TermInstance& term, const CurveFit& fit);

/// Writes the terms of `problem`, a curve fit, into `plain`, as the terms' pages define them. False
/// where the audit does not know one: another formula, or a loss on a sum that stands for an
/// integral.
bool AddTerms(const Problem& problem, AuditedFit* plain);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_AUDITED_TERMS_H_
