#include "solvers/extended_pia.h"

#include <limits>

#include "solvers/paired_iteration.h"

namespace batten {

SolverInfo ExtendedPiaSolver::ClassInfo() {
  SolverInfo info;
  info.name = "extended_pia";
  info.summary = "geometric iteration with each point's residual given to one control point";
  info.source = "Lin & Zhang, Computers & Graphics 35, 2011";
  info.needs = {"compiled rows", "only the interpolation term without weights"};
  info.native_rule = NativeRule::kStep;
  info.limit = "sum over the group of j of B_j(t_i) (Q_i - C(t_i)) = 0 for every control point j";
  return info;
}

std::string ExtendedPiaSolver::WhyUnsupported(const Objective& objective) const {
  return WhyNotPlainInterpolation(objective, "extended_pia");
}

void ExtendedPiaSolver::Group() {
  const BandedRows& rows = objective()->curve_view()->rows();
  const int n = rows.shape().num_columns;
  const int width = rows.shape().width;
  member_of_row_.assign(static_cast<std::size_t>(rows.shape().num_rows), Member());
  std::vector<double> sums(static_cast<std::size_t>(n), 0.0);
  // Where the basis wraps onto itself, one control point has several entries: they add.
  std::vector<double> values(static_cast<std::size_t>(n), 0.0);
  std::size_t row = 0;
  for (std::size_t b = 0; b < rows.num_blocks(); ++b) {
    const RowBlock block = rows.block(b);
    for (int i = 0; i < block.num_rows; ++i, ++row) {
      Member& member = member_of_row_[row];
      member.share = -1.0;
      const auto column = [&](int k) {
        return static_cast<std::size_t>((block.first_column + k) % n);
      };
      for (int k = 0; k < width; ++k) {
        values[column(k)] += block.coefficients[k * block.stride + i];
      }
      for (int k = 0; k < width; ++k) {
        if (values[column(k)] <= member.share) continue;
        member = {static_cast<int>(column(k)), values[column(k)]};
      }
      for (int k = 0; k < width; ++k) values[column(k)] = 0.0;
      sums[static_cast<std::size_t>(member.control_point)] += member.share;
    }
  }
  for (Member& member : member_of_row_) {
    member.share /= sums[static_cast<std::size_t>(member.control_point)];
  }
}

std::optional<Outcome> ExtendedPiaSolver::DoStart(Eigen::VectorXd* /*x*/) {
  guard_.Reset();
  first_move_ = -1.0;
  Group();
  context()->OffTheClock([this] {
    const double radius = SpectralRadius();
    context()->Note("spectral radius of the iteration", NumberText(radius));
    // 1 where a control point has no group: it stays.
    if (radius > 1.0 + 1e-9) {
      WarnOfDivergence("the spectral radius of the iteration is " + NumberText(radius));
    }
  });
  return std::nullopt;
}

Status ExtendedPiaSolver::Map(const Eigen::VectorXd& x, Eigen::VectorXd* g_of_x) {
  CurveView& view = *objective()->curve_view();
  const Status status = view.Residuals(x, &residuals_);
  if (status != Status::kOk) return status;
  *g_of_x = x;
  Eigen::Map<Points> points(g_of_x->data(), view.num_points(), view.dimension());
  for (std::size_t row = 0; row < member_of_row_.size(); ++row) {
    const Member& member = member_of_row_[row];
    points.row(member.control_point) +=
        member.share * residuals_.row(static_cast<Eigen::Index>(row));
  }
  return Status::kOk;
}

std::optional<Outcome> ExtendedPiaSolver::Inspect(const Eigen::VectorXd& x,
                                                  const Eigen::VectorXd& g_of_x) {
  // |g| does not vanish at its limit: the race's rule, put to its own moves.
  constexpr double kSmall = 1e-10;
  const double move = (g_of_x - x).norm();
  const double rounding = std::numeric_limits<double>::epsilon() * x.norm();
  if (first_move_ < 0.0) first_move_ = move;
  if (move <= kSmall * first_move_ || move <= rounding) {
    return Outcome{StopReason::kNativeStop,
                   "it has reached its own limit, which is not the least-squares curve unless that "
                   "meets all points"};
  }
  return guard_.Check(move);
}

double ExtendedPiaSolver::SpectralRadius() const {
  const BandedRows& rows = objective()->curve_view()->rows();
  const int n = rows.shape().num_columns;
  const int width = rows.shape().width;
  const auto apply = [&](const Points& v) {
    Points result = v;
    std::size_t row = 0;
    for (std::size_t b = 0; b < rows.num_blocks(); ++b) {
      const RowBlock block = rows.block(b);
      for (int i = 0; i < block.num_rows; ++i, ++row) {
        const Member& member = member_of_row_[row];
        for (int k = 0; k < width; ++k) {
          result.row(member.control_point) -= member.share *
                                              block.coefficients[k * block.stride + i] *
                                              v.row((block.first_column + k) % n);
        }
      }
    }
    return result;
  };
  return SpectralRadiusOf(apply, n, context()->seed());
}

std::vector<double> ExtendedPiaSolver::State() const {
  std::vector<double> state = {first_move_};
  guard_.AppendTo(&state);
  return state;
}

void ExtendedPiaSolver::Restore(const std::vector<double>& state) {
  first_move_ = state[0];
  guard_.Restore(state.data() + 1);
}

}  // namespace batten
