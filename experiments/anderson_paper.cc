#include "experiments/anderson_paper.h"

namespace batten {

Reproduction AndersonPaper() {
  Reproduction reproduction;
  reproduction.name = "anderson";
  reproduction.title = "Anderson acceleration for B-spline curve fitting, run again";
  reproduction.source =
      "\"Anderson acceleration for B-spline curve fitting\" (Qin, Zhang, 2020); its other method, "
      "joint L-BFGS, is that of \"Fast B-spline curve fitting by L-BFGS\" (Zheng, Bo, Liu, Wang, "
      "2012)";
  reproduction.introduction =
      "The paper fits closed cubics to points without parameters: foot points, then linear least "
      "squares (`pdm`), as a fixed point that Anderson's method accelerates "
      "(`anderson/window=5:pdm`), against L-BFGS on control points and parameters together "
      "(`lbfgs`). No fairing. Its points are not public: ours are outlines from `data/`, scaled to "
      "the unit box, with its numbers of points and control points.\n\n"
      "Every error here is E at the foot points, the sum of squared distances of the points from "
      "the curve, computed off the clock for the iterates; what a method that does not project "
      "believes E to be is larger. No stop rule of the paper's is known to us: runs are races to "
      "|g| <= 1e-8 |g(start)|, with 1.5 seconds and 20,000 iterations at most.\n\n"
      "The problem has many minima, and two methods from one start often end in different ones. So "
      "each run's end is polished: foot points, then `newton` to rounding. Two runs are in one "
      "basin where their polished E agree to 1e-3, and only then are their speeds compared, by the "
      "iterations and the time until E is within 1e-6 of the run's own polished E. Other pairs are "
      "left out, and where all are a claim is undecided. A time is that of the median of the "
      "repetitions, unless a run took half a second.";
  reproduction.experiments = {AndersonPaperExamples(), AndersonPaperWindow(), AndersonPaperPoints(),
                              AndersonPaperControlPoints(), AndersonPaperStarts()};
  return reproduction;
}

}  // namespace batten
