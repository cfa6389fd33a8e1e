#ifndef BATTEN_EXPERIMENTS_ANDERSON_PAPER_H_
#define BATTEN_EXPERIMENTS_ANDERSON_PAPER_H_

#include "experiments/reproduction.h"

namespace batten {

/// "Anderson acceleration for B-spline curve fitting" (Qin, Zhang, 2020), run again.
Reproduction AndersonPaper();

// Its experiments, one file each, anderson_paper_NAME.cc.
Experiment AndersonPaperExamples();
Experiment AndersonPaperWindow();
Experiment AndersonPaperPoints();
Experiment AndersonPaperControlPoints();
Experiment AndersonPaperStarts();

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_ANDERSON_PAPER_H_
