#include "solvers/extended_pia.h"

#include "solvers/paired_iteration.h"

namespace batten {

SolverInfo ExtendedPiaSolver::ClassInfo() {
  SolverInfo info;
  info.name = "extended_pia";
  info.summary = "geometric iteration with each point's residual given to one control point";
  info.source = "Lin & Zhang, Computers & Graphics 35, 2011";
  info.needs = {"compiled rows", FurtherTerms::kNeeds};
  info.native_rule = NativeRule::kStep;
  info.limit =
      "sum over the group of j of B_j(t_i) (Q_i - C(t_i)) = (F P - f)_j for every control point j, "
      "F "
      "and f of the terms beside interpolation";
  return info;
}

std::string ExtendedPiaSolver::WhyUnsupported(const Objective& objective) const {
  return FurtherTerms::WhyNot(objective, "extended_pia");
}

void ExtendedPiaSolver::Group() {
  const int n = rows().shape().num_columns;
  const int width = rows().shape().width;
  member_of_row_.assign(static_cast<std::size_t>(rows().shape().num_rows), Member());
  std::vector<double> sums(static_cast<std::size_t>(n), 0.0);
  if (!terms_.empty()) sums = terms_.RowSums();
  // Where the basis wraps onto itself, one control point has several entries: they add.
  std::vector<double> values(static_cast<std::size_t>(n), 0.0);
  std::size_t row = 0;
  for (std::size_t b = 0; b < rows().num_blocks(); ++b) {
    const RowBlock block = rows().block(b);
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
  scale_ = Eigen::Map<const Eigen::ArrayXd>(sums.data(), n);
  scale_ = (scale_ > 0.0).select(scale_.inverse(), 0.0);
}

std::optional<Outcome> ExtendedPiaSolver::DoStart(Eigen::VectorXd* /*x*/) {
  guard_.Reset();
  own_limit_.Reset();
  rows_ = &FurtherTerms::InterpolationRows(objective(), &own_rows_);
  terms_ = FurtherTerms(objective());
  Group();
  context()->OffTheClock([this] {
    const double radius = SpectralRadius();
    context()->Note("spectral radius of the iteration", NumberText(radius));
    // 1 where a control point has no group and no term: it stays.
    if (radius > 1.0 + 1e-9) {
      WarnOfDivergence("the spectral radius of the iteration is " + NumberText(radius));
    }
  });
  return std::nullopt;
}

Status ExtendedPiaSolver::Map(const Eigen::VectorXd& x, Eigen::VectorXd* g_of_x) {
  if (!objective()->curve_view()->AllowProduct(x)) return Status::kStop;
  const RowShape shape = rows().shape();
  residuals_.resize(shape.num_rows, shape.dimension);
  rows().Residuals(x.data(), residuals_.data());
  if (!residuals_.allFinite()) return Status::kNonFinite;
  *g_of_x = x;
  Eigen::Map<Points> points(g_of_x->data(), shape.num_columns, shape.dimension);
  for (std::size_t row = 0; row < member_of_row_.size(); ++row) {
    const Member& member = member_of_row_[row];
    points.row(member.control_point) +=
        member.share * residuals_.row(static_cast<Eigen::Index>(row));
  }
  if (terms_.empty()) return Status::kOk;
  terms_.Pull(x.data(), &pull_);
  points.array() += pull_.array().colwise() * scale_;
  return points.allFinite() ? Status::kOk : Status::kNonFinite;
}

std::optional<Outcome> ExtendedPiaSolver::Inspect(const Eigen::VectorXd& x,
                                                  const Eigen::VectorXd& g_of_x) {
  const double move = (g_of_x - x).norm();
  if (own_limit_.Reached(move, x)) {
    return Outcome{StopReason::kNativeStop,
                   terms_.empty()
                       ? "its steps are 1e-10 of the first one: it goes to its own limit, which "
                         "is not the least-squares curve unless that meets all points"
                       : "its steps are 1e-10 of the first one: it goes to its own limit, which "
                         "is not the minimum of E: at each control point the residuals of its "
                         "group balance the pull of the further terms"};
  }
  return guard_.Check(move);
}

double ExtendedPiaSolver::SpectralRadius() const {
  const int n = rows().shape().num_columns;
  const int width = rows().shape().width;
  Eigen::SparseMatrix<double, Eigen::RowMajor> pull(n, n);
  if (!terms_.empty()) pull = scale_.matrix().asDiagonal() * terms_.ToSparse();
  const auto apply = [&](const Points& v) {
    Points result = v - pull * v;
    std::size_t row = 0;
    for (std::size_t b = 0; b < rows().num_blocks(); ++b) {
      const RowBlock block = rows().block(b);
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
  std::vector<double> state;
  own_limit_.AppendTo(&state);
  guard_.AppendTo(&state);
  return state;
}

void ExtendedPiaSolver::Restore(const std::vector<double>& state) {
  own_limit_.Restore(state.data());
  guard_.Restore(state.data() + 1);
}

}  // namespace batten
