#include "experiments/max_distance_growth.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "splines/banded_qr.h"
#include "splines/basis_functions.h"
#include "splines/knot_rules.h"
#include "splines/schoenberg_whitney.h"

namespace batten {
namespace {

/// Rows of the least-squares problem at sorted parameters in the domain, span by span.
class CollocationRows {
 public:
  CollocationRows(const BsplineBasis& basis, const Points& points,
                  const Eigen::VectorXd& parameters)
      : basis_(basis), points_(points), parameters_(parameters) {}

  RowShape shape() const {
    RowShape shape;
    shape.num_rows = static_cast<int>(points_.rows());
    shape.num_columns = basis_.num_control_points();
    shape.width = basis_.order();
    shape.dimension = static_cast<int>(points_.cols());
    shape.cyclic = basis_.periodic();
    return shape;
  }

  void Stream(RowConsumer* consumer) const {
    const int m = static_cast<int>(points_.rows());
    for (int begin = 0; begin < m;) {
      const int span = basis_.FindSpan(parameters_[begin]);
      int end = begin + 1;
      while (end < m && end - begin < kMaxRowsPerBlock && basis_.FindSpan(parameters_[end]) == span)
        ++end;
      Consume(span, begin, end, consumer);
      begin = end;
    }
  }

 private:
  void Consume(int span, int begin, int end, RowConsumer* consumer) const {
    const int d = static_cast<int>(points_.cols());
    const int width = basis_.order();
    alignas(32) double coefficients[kMaxOrder * kMaxRowsPerBlock];
    alignas(32) double right[kMaxDimension * kMaxRowsPerBlock];
    RowBlock block;
    block.first_column = span - basis_.degree();
    block.num_rows = end - begin;
    block.stride = (block.num_rows + kRowPack - 1) / kRowPack * kRowPack;
    std::fill_n(coefficients, width * block.stride, 0.0);
    std::fill_n(right, d * block.stride, 0.0);
    for (int i = begin; i < end; ++i) {
      double values[kMaxOrder];
      EvaluateBasis(basis_.degree(), basis_.knots().data(), span, parameters_[i], values);
      for (int j = 0; j < width; ++j) coefficients[j * block.stride + i - begin] = values[j];
      for (int c = 0; c < d; ++c) right[c * block.stride + i - begin] = points_(i, c);
    }
    block.coefficients = coefficients;
    block.right_hand_sides = right;
    consumer->Consume(block);
  }

  const BsplineBasis& basis_;
  const Points& points_;
  const Eigen::VectorXd& parameters_;
};

class Grower {
 public:
  Grower(int degree, bool closed, const Points& points, const Eigen::VectorXd& parameters,
         double bound)
      : degree_(degree),
        closed_(closed),
        points_(points),
        parameters_(parameters),
        squared_bound_(bound * bound) {}

  std::optional<TrackedCurve> Grow(const std::function<bool(int)>& stop) {
    const int m = static_cast<int>(points_.rows());
    const EndKnots ends = closed_ ? EndKnots::kPeriodic : EndKnots::kEndInterpolating;
    const int first = closed_ ? std::min(2 * degree_ + 2, m) : degree_ + 1;
    if (m < first) return std::nullopt;
    std::vector<double> knots = UniformKnots(degree_, first, ends, 0.0, 1.0);
    while (!stop(static_cast<int>(knots.size()) - degree_ - 1)) {
      const auto curve = Fit(knots);
      if (!curve.has_value()) break;
      TrackedCurve tracked(*curve, points_, parameters_);
      tracked.FollowAll(4);
      if (tracked.squared_distances().maxCoeff() <= squared_bound_) return tracked;
      if (!Refine(curve->basis(), tracked.squared_distances(), &knots)) break;
    }
    if (stop(m)) return std::nullopt;
    const auto curve = Fit(AveragedKnots(degree_, m, ends, 0.0, 1.0, parameters_, nullptr));
    if (!curve.has_value()) return std::nullopt;
    TrackedCurve tracked(*curve, points_, parameters_);
    tracked.FollowAll(0);
    if (tracked.squared_distances().maxCoeff() <= squared_bound_) return tracked;
    return std::nullopt;
  }

 private:
  std::optional<BsplineCurve> Fit(std::vector<double> knots) {
    if (knots.empty()) return std::nullopt;
    auto basis = BsplineBasis::Make(degree_, closed_, std::move(knots), nullptr);
    if (!basis.has_value()) return std::nullopt;
    const std::vector<double> places(parameters_.data(), parameters_.data() + parameters_.size());
    wrapped_ = parameters_;
    Points points = points_;
    if (closed_) Turn(*basis, &points);
    if (LargestDataShortage(*basis,
                            std::vector<double>(wrapped_.data(), wrapped_.data() + wrapped_.size()))
            .num_control_points > 0) {
      return std::nullopt;
    }
    const CollocationRows rows(*basis, points, closed_ ? turned_ : parameters_);
    BandedQr qr(rows.shape());
    rows.Stream(&qr);
    qr.Finish();
    if (!qr.full_rank()) return std::nullopt;
    Points control_points(basis->num_control_points(), points_.cols());
    qr.Solve(&control_points);
    return BsplineCurve(*std::move(basis), std::move(control_points));
  }

  /// Averaged periodic knots begin elsewhere than at 0: the points in the order of their place in
  /// the domain.
  void Turn(const BsplineBasis& basis, Points* points) {
    const Eigen::Index m = parameters_.size();
    for (double& t : wrapped_) t = basis.Wrap(t);
    Eigen::Index first = 0;
    wrapped_.minCoeff(&first);
    turned_.resize(m);
    for (Eigen::Index i = 0; i < m; ++i) {
      const Eigen::Index from = (first + i) % m;
      turned_[i] = wrapped_[from];
      points->row(i) = points_.row(from);
    }
  }

  /// False if no knot can be inserted.
  bool Refine(const BsplineBasis& basis, const Eigen::VectorXd& squared_distances,
              std::vector<double>* knots) const {
    const Eigen::Index m = parameters_.size();
    std::vector<double> inner;
    for (Eigen::Index begin = 0; begin < m;) {
      const int span = basis.FindSpan(parameters_[begin]);
      Eigen::Index end = begin;
      double worst = 0.0;
      for (; end < m && basis.FindSpan(parameters_[end]) == span; ++end) {
        worst = std::max(worst, squared_distances[end]);
      }
      const Eigen::Index middle = begin + (end - begin) / 2;
      if (worst > squared_bound_ && end - begin >= 2 &&
          parameters_[middle - 1] < parameters_[middle]) {
        inner.push_back(0.5 * (parameters_[middle - 1] + parameters_[middle]));
      }
      begin = end;
    }
    if (inner.empty()) return false;
    std::vector<double> all;
    const auto p = static_cast<std::size_t>(degree_);
    // One period, or everything between the ends.
    all.assign(knots->begin() + static_cast<std::ptrdiff_t>(p),
               knots->end() - static_cast<std::ptrdiff_t>(p));
    all.insert(all.end(), inner.begin(), inner.end());
    std::sort(all.begin(), all.end());
    const std::size_t spans = all.size() - 1;
    knots->clear();
    for (std::size_t i = 0; i < p; ++i) {
      const std::size_t turns = (p - i + spans - 1) / spans;
      knots->push_back(closed_ ? all[turns * spans - (p - i)] - static_cast<double>(turns)
                               : all.front());
    }
    knots->insert(knots->end(), all.begin(), all.end());
    for (std::size_t i = 1; i <= p; ++i) {
      const std::size_t turns = 1 + i / spans;
      knots->push_back(closed_ ? all[i % spans] + static_cast<double>(turns) : all.back());
    }
    return true;
  }

  int degree_;
  bool closed_;
  const Points& points_;
  const Eigen::VectorXd& parameters_;
  double squared_bound_;
  Eigen::VectorXd wrapped_;  // by point
  Eigen::VectorXd turned_;   // by place in the domain
};

}  // namespace

std::optional<TrackedCurve> GrowCurve(int degree, bool closed, const Points& points,
                                      const Eigen::VectorXd& parameters, double bound,
                                      const std::function<bool(int)>& stop) {
  return Grower(degree, closed, points, parameters, bound).Grow(stop);
}

}  // namespace batten
