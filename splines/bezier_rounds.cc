#include <algorithm>
#include <cmath>

#include "splines/bezier_loops.h"

namespace batten {
namespace {

class UniformRounds {
 public:
  UniformRounds(const SubdivisionOptions& options, PieceCutter* cutter, Subdivision* result)
      : options_(options),
        narrowest_(std::ldexp(1.0, -options.max_depth)),
        size_(static_cast<Eigen::Index>(cutter->size())),
        cutter_(*cutter),
        result_(*result) {}

  void Run(const double* points, PieceList* list) {
    numbers_ = Eigen::Map<const Eigen::VectorXd>(points, size_);
    pieces_.resize(1);
    while (!IsLast()) {
      cutter_.always_halves() ? HalveAll() : CutAll();
      ++result_.rounds;
    }
    const std::size_t count = num_pieces();
    list->Reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      // Of halves the end is i + 1 by a power of two, exactly.
      list->AddPiece(PointsOf(i), cutter_.always_halves()
                                      ? static_cast<double>(i + 1) / static_cast<double>(count)
                                      : pieces_[i].end);
    }
  }

 private:
  std::size_t num_pieces() const { return static_cast<std::size_t>(numbers_.size() / size_); }
  const double* PointsOf(std::size_t index) const {
    return numbers_.data() + static_cast<Eigen::Index>(index) * size_;
  }

  /// Says how the subdivision ends if it does. While it goes on, one failing piece is enough to
  /// know; where one failed, one of its parts is the likeliest to fail again.
  bool IsLast() {
    const std::size_t count = num_pieces();
    if (FailsFrom(failing_, count) || FailsFrom(0, failing_)) {
      if (result_.rounds == options_.max_depth) {
        result_.end = SubdivisionEnd::kDepthLimit;
      } else if (2 * count > static_cast<std::size_t>(options_.max_pieces)) {
        result_.end = SubdivisionEnd::kPieceLimit;
      } else {
        return false;
      }
      for (std::size_t i = 0; i < count; ++i) {
        result_.num_failing += cutter_.Passes(PointsOf(i)) ? 0 : 1;
      }
      return true;
    }
    result_.end = SubdivisionEnd::kAllPass;
    return true;
  }

  bool FailsFrom(std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (cutter_.Passes(PointsOf(i))) continue;
      failing_ = i;
      return true;
    }
    return false;
  }

  void CutAll() {
    next_numbers_.resize(2 * numbers_.size());
    next_pieces_.clear();
    next_pieces_.reserve(2 * pieces_.size());
    std::size_t next_failing = 0;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const PieceInterval& piece = pieces_[i];
      double* const first =
          next_numbers_.data() + static_cast<Eigen::Index>(next_pieces_.size()) * size_;
      if (i == failing_) next_failing = next_pieces_.size();
      if (piece.end - piece.begin <= narrowest_) {
        std::copy(PointsOf(i), PointsOf(i) + size_, first);
        next_pieces_.push_back(piece);
        continue;
      }
      cutter_.Choose(PointsOf(i), piece);
      cutter_.Cut(first, first + size_);
      next_pieces_.push_back(cutter_.first_interval());
      next_pieces_.push_back(cutter_.second_interval());
    }
    failing_ = next_failing;
    next_numbers_.conservativeResize(static_cast<Eigen::Index>(next_pieces_.size()) * size_);
    numbers_.swap(next_numbers_);
    pieces_.swap(next_pieces_);
  }

  // From the last piece to the first the parts find room where they are: piece i has gone when its
  // place is taken.
  void HalveAll() {
    const std::size_t count = num_pieces();
    numbers_.conservativeResize(2 * numbers_.size());
    for (std::size_t i = count; i-- > 0;) {
      double* const first = numbers_.data() + 2 * static_cast<Eigen::Index>(i) * size_;
      cutter_.Halve(PointsOf(i), first, first + size_);
    }
    failing_ *= 2;
  }

  const SubdivisionOptions& options_;
  const double narrowest_;
  const Eigen::Index size_;
  PieceCutter& cutter_;
  Subdivision& result_;
  std::size_t failing_ = 0;  // the piece that is tested first
  // Not std::vector, which fills new room with zeros: that took as long as cuts of cubics.
  Eigen::VectorXd numbers_;
  std::vector<PieceInterval> pieces_;  // not kept of halves
  Eigen::VectorXd next_numbers_;       // their room is used again: fresh pages took as long as cuts
  std::vector<PieceInterval> next_pieces_;
};

}  // namespace

void CutInRounds(const double* points, const SubdivisionOptions& options, PieceCutter* cutter,
                 PieceList* list, Subdivision* result) {
  list->Begin(points);
  UniformRounds(options, cutter, result).Run(points, list);
}

}  // namespace batten
