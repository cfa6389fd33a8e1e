#include "experiments/bezier_paper.h"

namespace batten {

Reproduction BezierPaper() {
  Reproduction reproduction;
  reproduction.name = "bezier-subdivision";
  reproduction.title = "Optimal subdivision parameters for planar Bezier curves, run again";
  reproduction.source =
      "\"Optimal subdivision parameters for planar Bezier curves\" (Ma, Lin, Shen, 2016)";
  reproduction.introduction =
      "The paper cuts a Bezier curve where the two parts' control polygons are flattest "
      "(`flatness`) "
      "or their hulls smallest (`hull`), the best of u = 0.2, 0.25, ..., 0.8 in the first three "
      "rounds, then at 1/2, and compares with halving (`half`). It counts uniform rounds: every "
      "piece is cut until all pass. Its stop rule: the largest distance of an inner control point "
      "from the chord, over the larger side of the original control points' box, is at most 1e-5. "
      "Its curves are not public: ours are drawn from three families, none chosen for what a rule "
      "does on it.\n\n"
      "Beside the paper's rules stand `share` (both parts get equal shares of the pieces that "
      "curvature foretells) and, adaptive, `longest` (the longest first part that passes). Ratios "
      "are to halving on the same curve in the same mode; below 1 is better. Medians stand with "
      "the "
      "interval that holds the median of the family with 95 % confidence. The true error is the "
      "certified Hausdorff distance of curve and polyline over the tolerance. In the paper's "
      "settings "
      "halving is asked about each piece as the other rules are, so that times compare rules; in "
      "`certified` it runs as `subdivide` runs it, which asks nobody and is faster.";
  reproduction.experiments = {BezierPaperTable(),      BezierPaperFamilies(), BezierPaperGlyphs(),
                              BezierPaperEqualError(), BezierPaperOneCut(),   BezierPaperRounds(),
                              BezierPaperBestCuts(),   BezierPaperAffine(),   BezierPaperMinima()};
  return reproduction;
}

}  // namespace batten
