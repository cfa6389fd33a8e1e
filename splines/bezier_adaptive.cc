#include <algorithm>
#include <cmath>
#include <list>
#include <queue>

#include "splines/bezier_loops.h"

namespace batten {
namespace {

// A piece that stems from so many cuts one after the other is computed from the curve again: a
// chain of 700 would carry the roundings of all of them.
constexpr int kLongestChain = 32;

/// Pieces that wait, the next one on top; first parts go above second parts.
class AdaptiveLoop {
 public:
  AdaptiveLoop(const SubdivisionOptions& options, PieceCutter* cutter, PieceList* list,
               Subdivision* result)
      : max_pieces_(options.max_pieces),
        narrowest_(std::ldexp(1.0, -options.max_depth)),
        cutter_(*cutter),
        list_(*list),
        result_(*result) {}

  bool Run(const double* points) {
    stack_.emplace_back();
    ReserveOneMore();
    std::copy(points, points + cutter_.size(), places_[0]);
    while (!stack_.empty()) {
      const PieceInterval& piece = stack_.back();
      const double* top = places_[stack_.size() - 1];
      const bool passes = cutter_.Passes(top);
      if (passes || piece.end - piece.begin <= narrowest_) {
        if (!passes) ++result_.num_failing;
        Finish(top, piece);
        stack_.pop_back();
      } else if (list_.size() + static_cast<int>(stack_.size()) >= max_pieces_) {
        return false;
      } else {
        cutter_.always_halves() ? HalveTop() : CutTop();
      }
    }
    result_.end = result_.num_failing == 0 ? SubdivisionEnd::kAllPass : SubdivisionEnd::kDepthLimit;
    return true;
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

  void HalveTop() {
    ReserveOneMore();
    double* const place = places_[stack_.size() - 1];
    double* const above = places_[stack_.size()];
    const PieceInterval first = cutter_.Halve(place, &stack_.back(), above, place);
    RenewTop(above, place);
    stack_.push_back(first);
  }

  void CutTop() {
    ReserveOneMore();
    double*& place = places_[stack_.size() - 1];
    double*& above = places_[stack_.size()];
    cutter_.Choose(place, stack_.back());
    cutter_.CutOrExchange(&above, &place);
    stack_.back() = cutter_.second_interval();
    RenewTop(above, place);
    if (cutter_.first_passes()) {
      Finish(above, cutter_.first_interval());
    } else {
      stack_.push_back(cutter_.first_interval());
    }
  }

  /// The second part, behind a long chain of cuts.
  void RenewTop(const double* first, double* second) {
    PieceInterval& interval = stack_.back();
    if (interval.chain < kLongestChain) return;
    interval.chain = 0;
    cutter_.ComputeAfresh(interval, first + cutter_.size() - cutter_.dimension(), second);
  }

  const int max_pieces_;
  const double narrowest_;
  PieceCutter& cutter_;
  PieceList& list_;
  Subdivision& result_;
  std::vector<PieceInterval> stack_;
  std::vector<double*> places_;  // of the stack's pieces, and free ones above
  std::list<std::vector<double>> storage_;
};

/// A piece without its points, which are computed again: a million of them would not fit.
struct WaitingPiece {
  PieceInterval interval;
  double length = 0.0;  // in units of the longest that would pass
  bool operator<(const WaitingPiece& other) const { return length < other.length; }
};

}  // namespace

bool CutAdaptively(const double* points, const SubdivisionOptions& options, PieceCutter* cutter,
                   PieceList* list, Subdivision* result) {
  list->Begin(points);
  return AdaptiveLoop(options, cutter, list, result).Run(points);
}

void HalveWorstFirst(const double* points, const SubdivisionOptions& options, PieceCutter* cutter,
                     PieceList* list, Subdivision* result) {
  const double narrowest = std::ldexp(1.0, -options.max_depth);
  const std::size_t size = cutter->size();
  std::vector<double> numbers(2 * size);
  double* const first = numbers.data();
  double* const second = first + size;
  std::priority_queue<WaitingPiece> waiting;
  std::vector<PieceInterval> done;
  *result = Subdivision();
  const auto sort_in = [&](const PieceInterval& interval, const double* piece) {
    const StopValue value = cutter->Measure(piece);
    const bool is_narrow = interval.end - interval.begin <= narrowest;
    if (value.passes() || is_narrow) {
      done.push_back(interval);
      result->num_failing += value.passes() ? 0 : 1;
    } else {
      waiting.push({interval, value.RelativeLength()});
    }
  };
  sort_in(PieceInterval(), points);
  const auto most = static_cast<std::size_t>(options.max_pieces);
  while (!waiting.empty() && waiting.size() + done.size() < most) {
    PieceInterval piece = waiting.top().interval;
    waiting.pop();
    cutter->ComputeAfresh(piece, nullptr, second);
    sort_in(cutter->Halve(second, &piece, first, second), first);
    sort_in(piece, second);
  }
  result->end = SubdivisionEnd::kPieceLimit;
  result->num_failing += static_cast<int>(waiting.size());
  for (; !waiting.empty(); waiting.pop()) done.push_back(waiting.top().interval);
  std::sort(done.begin(), done.end(),
            [](const PieceInterval& a, const PieceInterval& b) { return a.begin < b.begin; });
  list->Begin(points);
  std::copy(points, points + cutter->dimension(), second);
  for (const PieceInterval& piece : done) {
    cutter->ComputeAfresh(piece, second, first);
    list->AddPiece(first, piece.end);
    std::copy(first + size - cutter->dimension(), first + size, second);
    result->rounds = std::max(result->rounds, piece.depth);
  }
}

}  // namespace batten
