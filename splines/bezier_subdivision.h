#ifndef BATTEN_SPLINES_BEZIER_SUBDIVISION_H_
#define BATTEN_SPLINES_BEZIER_SUBDIVISION_H_

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "splines/bezier_stop.h"

namespace batten {

/// A piece that is about to be cut, as its cut rule sees it. Trial cuts are counted; the last one
/// is the cut itself if the rule then returns its place, so that nothing is computed twice.
class CutTrial {
 public:
  virtual ~CutTrial() = default;

  int degree() const { return degree_; }
  int dimension() const { return dimension_; }
  const double* points() const { return points_; }  ///< n + 1 points, d coordinates each.
  double begin() const { return begin_; }           ///< The piece's interval of the curve's [0, 1].
  double end() const { return end_; }
  int depth() const { return depth_; }  ///< How many cuts it stems from; uniform: finished rounds.
  const StopTest& stop() const { return *stop_; }

  /// Cuts at u in (0, 1) of the piece, and tests the first part.
  virtual StopValue Try(double u) = 0;
  const double* first() const { return first_; }  ///< Parts of the last Try().
  const double* second() const { return second_; }
  /// Books evaluations of the rule's own objective, each of which has cut the piece.
  void Count(int evaluations) { own_evaluations_ += evaluations; }

 protected:
  int degree_ = 0;
  int dimension_ = 0;
  const double* points_ = nullptr;
  double begin_ = 0.0;
  double end_ = 1.0;
  int depth_ = 0;
  const StopTest* stop_ = nullptr;
  const double* first_ = nullptr;
  const double* second_ = nullptr;
  std::int64_t own_evaluations_ = 0;
};

/// Where a piece is to be cut, in (0, 1) of it; anything else is our bug: std::logic_error. An
/// empty one cuts at 1/2, as CutAtHalf() does, without being asked each time.
using CutChoice = std::function<double(CutTrial*)>;

enum class SubdivisionMode {
  kAdaptive,  ///< Only pieces that fail are cut.
  kUniform,   ///< In each round every piece is cut, until all pass.
};
const char* ToString(SubdivisionMode mode);
bool FromString(const std::string& text, SubdivisionMode* mode);

struct SubdivisionOptions {
  /// By default one that bounds the true error.
  StopMeasure stop = StopMeasure::kPolygon;
  /// >= 0 and finite; of kAngle: radians, below pi / 2. See StopMeasure.
  double relative_tolerance = 1e-5;
  /// > 0: L, to which tolerances are relative, of a curve that is part of a longer one; 0: that of
  /// the curve itself.
  double reference_size = 0.0;
  SubdivisionMode mode = SubdivisionMode::kAdaptive;
  /// 1 to 50: no piece narrower than 2^-max_depth of [0, 1] is cut; uniform: so many rounds.
  int max_depth = 40;
  /// 1 to 2^24: no more pieces than that. Where the rule needs more in adaptive mode, they are made
  /// anew: so many, the piece that is farthest from passing being halved each time.
  int max_pieces = 1 << 20;
  /// Whether Subdivision::pieces is filled.
  bool keep_pieces = false;

  bool IsValid(std::string* error) const;  ///< Names the field, its value and its range.
};

enum class SubdivisionEnd { kNotRun, kAllPass, kDepthLimit, kPieceLimit };
const char* ToString(SubdivisionEnd end);

struct Subdivision {
  /// 0 = t_0 < ... < t_k = 1: piece i is the curve's part [t_i, t_(i+1)], without gap.
  std::vector<double> parameters;
  Points vertices;  ///< (k + 1) x d: the pieces' ends, the curve's points there.
  Points pieces;    ///< k (n + 1) x d if asked for: control points, piece by piece.
  int rounds = 0;   ///< Uniform: rounds of cuts. Adaptive: the most cuts that a piece stems from.
  std::int64_t cuts = 0;  ///< De Casteljau triangles, trials included.
  /// Stop tests, and a rule's evaluations of its objective. Uniform rounds test until one fails.
  std::int64_t evaluations = 0;
  int num_failing = 0;  ///< Pieces that do not pass; 0 unless a limit was hit.
  SubdivisionEnd end = SubdivisionEnd::kNotRun;
  /// One sentence where a limit was hit or the tolerance was raised, or both.
  std::string message;

  int num_pieces() const { return static_cast<int>(parameters.size()) - 1; }
};

/// Cuts `curve` by `rule` until every piece passes. Allocates for its stack and its result, which
/// grow by doubling, and not for a cut. Scaling the curve by a power of two changes no parameter;
/// coordinates may be as large as a double. False with one sentence in `error` for options that are
/// not valid and for a stop by hull area where the curve is not planar.
bool Subdivide(const BezierCurve& curve, const CutChoice& rule, const SubdivisionOptions& options,
               Subdivision* result, std::string* error);

/// The rule that everyone knows: at 1/2.
double CutAtHalf(CutTrial* trial);

}  // namespace batten

#endif  // BATTEN_SPLINES_BEZIER_SUBDIVISION_H_
