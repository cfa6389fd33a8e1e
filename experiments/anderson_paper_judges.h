#ifndef BATTEN_EXPERIMENTS_ANDERSON_PAPER_JUDGES_H_
#define BATTEN_EXPERIMENTS_ANDERSON_PAPER_JUDGES_H_

#include "experiments/reproduction.h"

namespace batten {

// The rules of the experiment `examples`, each in words where it is used. Verdicts are of
// the paper's examples alone, undecided where a row of one is missing; what ours gives is told.
Judgement JudgeFaster(const ExperimentTables& tables);
Judgement JudgeEqualTimes(const ExperimentTables& tables);
Judgement JudgeAlike(const ExperimentTables& tables);
Judgement JudgeProjections(const ExperimentTables& tables);
Judgement JudgeRejections(const ExperimentTables& tables);
Judgement JudgeUndamped(const ExperimentTables& tables);

/// holds: all of `of`; in part: some; does not hold: none.
ClaimVerdict VerdictOf(int count, int of);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_ANDERSON_PAPER_JUDGES_H_
