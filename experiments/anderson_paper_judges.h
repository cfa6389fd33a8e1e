#ifndef BATTEN_EXPERIMENTS_ANDERSON_PAPER_JUDGES_H_
#define BATTEN_EXPERIMENTS_ANDERSON_PAPER_JUDGES_H_

#include "experiments/reproduction.h"

namespace batten {

// The rules of the experiment `examples`, each in words where it is used. Undecided where a row of
// an example is missing.
Judgement JudgeFaster(const ExperimentTables& tables);
Judgement JudgeEqualTimes(const ExperimentTables& tables);
Judgement JudgeAlike(const ExperimentTables& tables);
Judgement JudgeProjections(const ExperimentTables& tables);
Judgement JudgeRejections(const ExperimentTables& tables);

/// holds: all of `of`; in part: some; does not hold: none.
ClaimVerdict VerdictOf(int count, int of);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_ANDERSON_PAPER_JUDGES_H_
