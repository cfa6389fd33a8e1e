#ifndef BATTEN_EXPERIMENTS_BEZIER_PAPER_H_
#define BATTEN_EXPERIMENTS_BEZIER_PAPER_H_

#include "experiments/reproduction.h"

namespace batten {

/// "Optimal subdivision parameters for planar Bezier curves" (Ma, Lin, Shen, 2016).
Reproduction BezierPaper();

// Its experiments, one file each.
Experiment BezierPaperTable();
Experiment BezierPaperFamilies();
Experiment BezierPaperGlyphs();
Experiment BezierPaperEqualError();
Experiment BezierPaperOneCut();
Experiment BezierPaperRounds();
Experiment BezierPaperBestCuts();
Experiment BezierPaperAffine();
Experiment BezierPaperMinima();

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_BEZIER_PAPER_H_
