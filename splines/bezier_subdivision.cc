#include "splines/bezier_subdivision.h"

#include <algorithm>
#include <cmath>
#include <list>
#include <utility>

#include "splines/bezier_cutter.h"
#include "splines/bezier_measures.h"

namespace batten {
namespace {

// A piece that stems from so many cuts one after the other is computed from the curve again: a
// chain of 700 would carry the roundings of all of them.
constexpr int kLongestChain = 32;

/// Pieces in their order, as they are finished.
class PieceList {
 public:
  PieceList(double unit, int degree, int dimension, bool keep_pieces)
      : unit_(unit), size_((degree + 1) * dimension), dimension_(dimension), keep_(keep_pieces) {}

  int size() const { return static_cast<int>(parameters_.size()) - 1; }
  void AddPoint(const double* point, double parameter) {
    parameters_.push_back(parameter);
    for (int c = 0; c < dimension_; ++c) vertices_.push_back(unit_ * point[c]);
  }
  void AddPiece(const double* points, double end) {
    AddPoint(points + size_ - dimension_, end);
    if (!keep_) return;
    for (int k = 0; k < size_; ++k) pieces_.push_back(unit_ * points[k]);
  }
  void MoveTo(Subdivision* result) {
    result->vertices = Rows(vertices_);
    result->pieces = Rows(pieces_);
    result->parameters = std::move(parameters_);
  }

 private:
  Points Rows(const std::vector<double>& numbers) const {
    return Eigen::Map<const Points>(
        numbers.data(), static_cast<Eigen::Index>(numbers.size()) / dimension_, dimension_);
  }

  const double unit_;
  const int size_;
  const int dimension_;
  const bool keep_;
  std::vector<double> parameters_;
  std::vector<double> vertices_;
  std::vector<double> pieces_;
};

/// Pieces that wait, the next one on top; first parts go above second parts.
class AdaptiveLoop {
 public:
  AdaptiveLoop(const SubdivisionOptions& options, PieceCutter* cutter, PieceList* list,
               Subdivision* result)
      : options_(options),
        narrowest_(std::ldexp(1.0, -options.max_depth)),
        cutter_(*cutter),
        list_(*list),
        result_(*result) {}

  void Run(const double* points) {
    result_.end = SubdivisionEnd::kAllPass;
    stack_.emplace_back();
    ReserveOneMore();
    std::copy(points, points + cutter_.size(), places_[0]);
    while (!stack_.empty()) {
      const PieceInterval piece = stack_.back();
      const double* top = places_[stack_.size() - 1];
      const bool passes = cutter_.Passes(top);
      if (passes || IsAtLimit(piece)) {
        if (!passes) ++result_.num_failing;
        Finish(top, piece);
        stack_.pop_back();
      } else {
        CutTop(piece);
      }
    }
  }

 private:
  void ReserveOneMore() {
    if (places_.size() > stack_.size()) return;
    const std::size_t count = 2 * (stack_.size() + 1);
    storage_.emplace_back(count * cutter_.size());
    for (std::size_t k = 0; k < count; ++k) {
      places_.push_back(storage_.back().data() + k * cutter_.size());
    }
  }

  void Finish(const double* points, const PieceInterval& piece) {
    result_.rounds = std::max(result_.rounds, piece.depth);
    list_.AddPiece(points, piece.end);
  }

  bool IsAtLimit(const PieceInterval& piece) {
    const bool is_narrow = piece.end - piece.begin <= narrowest_;
    const bool is_full = list_.size() + static_cast<int>(stack_.size()) >= options_.max_pieces;
    if (is_full) {
      result_.end = SubdivisionEnd::kPieceLimit;
    } else if (is_narrow && result_.end == SubdivisionEnd::kAllPass) {
      result_.end = SubdivisionEnd::kDepthLimit;
    }
    return is_narrow || is_full;
  }

  void CutTop(const PieceInterval& piece) {
    ReserveOneMore();
    double*& place = places_[stack_.size() - 1];
    double*& above = places_[stack_.size()];
    cutter_.Choose(place, piece, false);
    cutter_.CutOrExchange(&above, &place);
    stack_.back() = cutter_.second_interval();
    if (stack_.back().chain >= kLongestChain) {
      stack_.back().chain = 0;
      cutter_.ComputeAfresh(stack_.back(), above + cutter_.size() - cutter_.dimension(), place);
    }
    if (cutter_.first_passes()) {
      Finish(above, cutter_.first_interval());
    } else {
      stack_.push_back(cutter_.first_interval());
    }
  }

  const SubdivisionOptions& options_;
  const double narrowest_;
  PieceCutter& cutter_;
  PieceList& list_;
  Subdivision& result_;
  std::vector<PieceInterval> stack_;
  std::vector<double*> places_;  // of the stack's pieces, and free ones above
  std::list<std::vector<double>> storage_;
};

/// All pieces of a round, and whether each passes.
struct Round {
  std::vector<double> numbers;
  std::vector<PieceInterval> pieces;
  std::vector<char> passes;
};

class UniformRounds {
 public:
  UniformRounds(const SubdivisionOptions& options, PieceCutter* cutter, Subdivision* result)
      : options_(options),
        narrowest_(std::ldexp(1.0, -options.max_depth)),
        cutter_(*cutter),
        result_(*result) {}

  void Run(const double* points, PieceList* list) {
    round_.numbers.assign(points, points + cutter_.size());
    round_.pieces.resize(1);
    while (!IsLast()) {
      CutAll();
      ++result_.rounds;
    }
    for (std::size_t i = 0; i < round_.pieces.size(); ++i) {
      list->AddPiece(PointsOf(i), round_.pieces[i].end);
    }
  }

 private:
  const double* PointsOf(std::size_t index) const {
    return round_.numbers.data() + index * cutter_.size();
  }

  /// Tests every piece, and says how the subdivision ends if it does.
  bool IsLast() {
    const std::size_t count = round_.pieces.size();
    round_.passes.resize(count);
    result_.num_failing = 0;
    for (std::size_t i = 0; i < count; ++i) {
      round_.passes[i] = static_cast<char>(cutter_.Passes(PointsOf(i)));
      result_.num_failing += round_.passes[i] != 0 ? 0 : 1;
    }
    if (result_.num_failing == 0) {
      result_.end = SubdivisionEnd::kAllPass;
    } else if (result_.rounds == options_.max_depth) {
      result_.end = SubdivisionEnd::kDepthLimit;
    } else if (2 * count > static_cast<std::size_t>(options_.max_pieces)) {
      result_.end = SubdivisionEnd::kPieceLimit;
    }
    return result_.end != SubdivisionEnd::kNotRun;
  }

  void CutAll() {
    const std::size_t size = cutter_.size();
    Round& next = next_;
    next.numbers.resize(2 * round_.numbers.size());
    next.pieces.clear();
    next.pieces.reserve(2 * round_.pieces.size());
    for (std::size_t i = 0; i < round_.pieces.size(); ++i) {
      const PieceInterval& piece = round_.pieces[i];
      double* const first = next.numbers.data() + next.pieces.size() * size;
      if (piece.end - piece.begin <= narrowest_) {
        std::copy(PointsOf(i), PointsOf(i) + size, first);
        next.pieces.push_back(piece);
        continue;
      }
      cutter_.Choose(PointsOf(i), piece, round_.passes[i] != 0);
      cutter_.Cut(first, first + size);
      next.pieces.push_back(cutter_.first_interval());
      next.pieces.push_back(cutter_.second_interval());
    }
    next.numbers.resize(next.pieces.size() * size);
    std::swap(round_, next_);
  }

  const SubdivisionOptions& options_;
  const double narrowest_;
  PieceCutter& cutter_;
  Subdivision& result_;
  Round round_;
  Round next_;  // its room is used again: fresh pages took as long as the cuts
};

std::string Explanation(const Subdivision& result, const SubdivisionOptions& options,
                        const StopTest& test) {
  const std::string failing = std::to_string(result.num_failing) + " of " +
                              std::to_string(result.num_pieces()) + " pieces do not pass: ";
  if (result.end == SubdivisionEnd::kDepthLimit) {
    return failing + "the bound on depth, 2^-" + std::to_string(options.max_depth) +
           " of the curve's interval, was hit";
  }
  if (result.end == SubdivisionEnd::kPieceLimit) {
    return failing + "the bound of " + std::to_string(options.max_pieces) + " pieces was hit";
  }
  return test.is_raised() ? "the tolerance is below rounding and was raised to it" : "";
}

bool Fail(const std::string& sentence, std::string* error) {
  if (error != nullptr) *error = sentence;
  return false;
}

}  // namespace

bool Subdivide(const BezierCurve& curve, const CutChoice& rule, const SubdivisionOptions& options,
               Subdivision* result, std::string* error) {
  *result = Subdivision();
  if (!options.IsValid(error)) return false;
  if (options.stop == StopMeasure::kHullArea && curve.dimension() != 2) {
    return Fail("a stop by hull area needs a planar curve; found " +
                    std::to_string(curve.dimension()) + " coordinates, use control_points",
                error);
  }
  const double unit = UnitOf(curve.control_points());
  const BezierCurve scaled = *BezierCurve::Make(curve.control_points() / unit, nullptr);
  const StopTest test(options.stop, options.relative_tolerance, options.reference_size / unit,
                      scaled);
  PieceCutter cutter(scaled, test, rule);
  PieceList list(unit, curve.degree(), curve.dimension(), options.keep_pieces);
  const double* points = scaled.control_points().data();
  list.AddPoint(points, 0.0);
  if (options.mode == SubdivisionMode::kAdaptive) {
    AdaptiveLoop(options, &cutter, &list, result).Run(points);
  } else {
    UniformRounds(options, &cutter, result).Run(points, &list);
  }
  list.MoveTo(result);
  result->cuts = cutter.cuts();
  result->evaluations = cutter.evaluations();
  result->message = Explanation(*result, options, test);
  return true;
}

double CutAtHalf(CutTrial* /*trial*/) {
  constexpr double kHalf = 0.5;
  return kHalf;
}

}  // namespace batten
