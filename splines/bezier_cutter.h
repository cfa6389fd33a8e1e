#ifndef BATTEN_SPLINES_BEZIER_CUTTER_H_
#define BATTEN_SPLINES_BEZIER_CUTTER_H_

#include <cstdint>
#include <vector>

#include "splines/bezier_subdivision.h"

namespace batten {

/// A piece without its control points.
struct PieceInterval {
  double begin = 0.0;
  double end = 1.0;
  int depth = 0;
  int chain = 0;  ///< Cuts since the curve's own control points.
};

/// Cuts pieces of one curve where a rule says; counts; allocates nothing. It holds references to
/// what it is made of.
class PieceCutter final : public CutTrial {
 public:
  PieceCutter(const BezierCurve& curve, const StopTest& test, const CutChoice& rule);

  std::size_t size() const { return size_; }  ///< Numbers of a piece: (n + 1) d.
  /// The rule is empty, and nobody need be asked.
  bool always_halves() const { return !rule_; }
  /// Cuts `points` at 1/2; `second`, or both, may begin where `points` do.
  void Halve(const double* points, double* first, double* second) {
    CutBezier(degree_, dimension_, 0.5, points, first, second);
    ++cuts_;
  }
  /// The same, where all cuts so far were at 1/2; `piece` becomes the second part's interval, the
  /// first part's is returned.
  PieceInterval Halve(const double* points, PieceInterval* piece, double* first, double* second) {
    Halve(points, first, second);
    const double middle = piece->begin + 0.5 * (piece->end - piece->begin);  // no rounding
    const PieceInterval first_part = {piece->begin, middle, piece->depth + 1, piece->chain + 1};
    *piece = {middle, piece->end, piece->depth + 1, piece->chain + 1};
    return first_part;
  }
  StopValue Try(double u) override;
  /// Asks the rule where to cut the piece.
  void Choose(const double* points, const PieceInterval& piece);
  /// The chosen cut; `second` may be the piece's own points.
  void Cut(double* first, double* second);
  /// The same, where each points to size() numbers of the caller's: exchanged with those of a
  /// trial, which spares copying them.
  void CutOrExchange(double** first, double** second);
  /// The rule has tried what it chose, and the first part passes.
  bool first_passes() const { return is_tried_ && tried_passes_; }
  PieceInterval first_interval() const;
  PieceInterval second_interval() const;
  /// The piece from the curve's own control points; it shall begin with the d coordinates
  /// `begin_point` (null: with what is computed).
  void ComputeAfresh(const PieceInterval& piece, const double* begin_point, double* points);
  bool Passes(const double* points) {
    ++tests_;
    return stop_->Passes(points);
  }
  StopValue Measure(const double* points) {
    ++tests_;
    return stop_->Value(points);
  }

  std::int64_t cuts() const { return cuts_ + own_evaluations_; }
  std::int64_t evaluations() const { return tests_ + own_evaluations_; }

 private:
  void SetPlace(double u);

  const BezierCurve& curve_;
  const CutChoice& rule_;
  std::size_t size_;
  std::int64_t cuts_ = 0;  // without the rule's own, as are
  std::int64_t tests_ = 0;
  int chain_ = 0;
  double place_ = 0.0;     // the cut's parameter on the curve
  double fraction_ = 0.0;  // and on the piece
  double tried_ = 0.0;
  bool tried_passes_ = false;
  bool is_tried_ = false;
  std::vector<double> trial_numbers_;
  double* trial_first_;
  double* trial_second_;
};

}  // namespace batten

#endif  // BATTEN_SPLINES_BEZIER_CUTTER_H_
