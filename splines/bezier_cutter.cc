#include "splines/bezier_cutter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace batten {

PieceCutter::PieceCutter(const BezierCurve& curve, const StopTest& test, const CutChoice& rule)
    : curve_(curve), rule_(rule) {
  degree_ = curve.degree();
  dimension_ = curve.dimension();
  stop_ = &test;
  size_ = static_cast<std::size_t>(degree_ + 1) * dimension_;
  trial_numbers_.resize(2 * size_);
  trial_first_ = trial_numbers_.data();
  trial_second_ = trial_first_ + size_;
}

StopValue PieceCutter::Try(double u) {
  SetPlace(u);
  CutBezier(degree_, dimension_, fraction_, points_, trial_first_, trial_second_);
  ++cuts_;
  ++tests_;
  tried_ = u;
  first_ = trial_first_;
  second_ = trial_second_;
  const StopValue value = stop_->Value(trial_first_);
  tried_passes_ = value.passes();
  return value;
}

void PieceCutter::Choose(const double* points, const PieceInterval& piece) {
  points_ = points;
  begin_ = piece.begin;
  end_ = piece.end;
  depth_ = piece.depth;
  chain_ = piece.chain;
  tried_ = std::nan("");
  const double u = rule_(this);
  is_tried_ = u == tried_;
  if (!is_tried_) SetPlace(u);
}

void PieceCutter::Cut(double* first, double* second) {
  if (is_tried_) {
    std::copy(trial_first_, trial_first_ + size_, first);
    std::copy(trial_second_, trial_second_ + size_, second);
    return;
  }
  CutBezier(degree_, dimension_, fraction_, points_, first, second);
  ++cuts_;
}

void PieceCutter::CutOrExchange(double** first, double** second) {
  if (!is_tried_) return Cut(*first, *second);
  std::swap(*first, trial_first_);
  std::swap(*second, trial_second_);
}

PieceInterval PieceCutter::first_interval() const {
  return {begin_, place_, depth_ + 1, chain_ + 1};
}

PieceInterval PieceCutter::second_interval() const {
  return {place_, end_, depth_ + 1, chain_ + 1};
}

// The cut's parameter is rounded first, and the fraction taken from it: neighbours then meet in one
// number, and the point there is off by the rounding of a fraction of the piece alone.
void PieceCutter::SetPlace(double u) {
  if (!(u > 0.0 && u < 1.0)) {
    throw std::logic_error("a cut rule returned " + std::to_string(u) + ", must be in (0, 1)");
  }
  // Pieces are 2^-50 long at least, so that a quarter of one is no less than a rounding of 1.
  constexpr double kApart = 0x1p-52;
  const double length = end_ - begin_;
  constexpr double kHalf = 0.5;
  place_ = begin_ + kHalf * length;
  if (u == kHalf && place_ - begin_ == end_ - place_) {  // no rounding: no need to divide
    fraction_ = kHalf;
    return;
  }
  place_ = std::clamp(begin_ + u * length, begin_ + kApart, end_ - kApart);
  fraction_ = (place_ - begin_) / length;
}

void PieceCutter::ComputeAfresh(const PieceInterval& piece, const double* begin_point,
                                double* points) {
  std::array<double, (kMaxBezierDegree + 1) * kMaxDimension> up_to_end, unused;
  CutBezier(degree_, dimension_, piece.end, curve_.control_points().data(), up_to_end.data(),
            unused.data());
  CutBezier(degree_, dimension_, piece.begin / piece.end, up_to_end.data(), unused.data(), points);
  cuts_ += 2;
  if (begin_point != nullptr) std::copy(begin_point, begin_point + dimension_, points);
}

}  // namespace batten
