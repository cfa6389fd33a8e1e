#include "splines/inverse_band.h"

#include <Eigen/Dense>
#include <algorithm>
#include <vector>

namespace batten {
namespace {

/// S = (R'R)^-1, R = [R11 R12; 0 R22] with R11 banded and the tail's columns full. From
/// R S = R^-T, lower triangular with 1 / r_jj on its diagonal:
///   S_jk = -(sum over l > j of r_jl S_lk) / r_jj                 k > j
///   S_jj = (1 / r_jj - sum over l > j of r_jl S_lj) / r_jj.
/// Rows are asked for from the last one up; a row of the band needs the width - 1 rows before.
class InverseRows {
 public:
  explicit InverseRows(const BandedQr& qr)
      : qr_(qr), num_band_(qr.num_band_columns()), num_tail_(qr.num_tail_columns()) {
    MakeTail();
    const int kept = qr.width();
    window_ = Eigen::MatrixXd::Zero(kept, kept);
    beside_ = Eigen::MatrixXd::Zero(kept, num_tail_);
    r_.resize(static_cast<std::size_t>(qr.width()));
    r_tail_.resize(static_cast<std::size_t>(num_tail_));
    right_.resize(kMaxDimension);
  }

  /// S among the tail's columns.
  const Eigen::MatrixXd& tail() const { return tail_; }

  /// Row j = num_band - 1, ..., 0, in this order: entries (j, j), (j, j + 1), ... of the window in
  /// near(0), near(1), ..., those in the tail's columns in beside().
  void Next(int j) {
    const int width = static_cast<int>(window_.rows());
    qr_.CopyRow(j, r_.data(), r_tail_.data(), right_.data());
    const Eigen::Map<const Eigen::VectorXd> r_tail(r_tail_.data(), num_tail_);
    const int count = std::min(width, num_band_ - j) - 1;  // rows of the window below j
    const Eigen::Map<const Eigen::VectorXd> r(r_.data() + 1, count);
    // window_ holds S of columns j + 1, ...; its first row and column are to become those of j.
    Eigen::VectorXd near = -window_.topLeftCorner(count, count) * r;
    near -= beside_.topRows(count) * r_tail;
    near /= r_[0];
    Eigen::RowVectorXd beside = -r.transpose() * beside_.topRows(count);
    beside -= r_tail.transpose() * tail_;
    beside /= r_[0];
    const double diagonal =
        (1.0 / r_[0] - r.dot(near) - (num_tail_ > 0 ? beside.dot(r_tail) : 0.0)) / r_[0];
    for (int k = std::min(count, width - 1); k > 0; --k) {
      beside_.row(k) = beside_.row(k - 1);
      for (int l = std::min(count, width - 1); l > 0; --l) window_(k, l) = window_(k - 1, l - 1);
    }
    window_(0, 0) = diagonal;
    for (int k = 0; k < count; ++k) window_(0, k + 1) = window_(k + 1, 0) = near[k];
    if (num_tail_ > 0) beside_.row(0) = beside;
  }
  double near(int k) const { return window_(0, k); }
  double beside(int k) const { return beside_(0, k); }

 private:
  void MakeTail() {
    Eigen::MatrixXd r = Eigen::MatrixXd::Zero(num_tail_, num_tail_);
    std::vector<double> window(static_cast<std::size_t>(qr_.width()));
    std::vector<double> tail(static_cast<std::size_t>(num_tail_));
    std::vector<double> right(kMaxDimension);
    for (int i = 0; i < num_tail_; ++i) {
      qr_.CopyRow(num_band_ + i, window.data(), tail.data(), right.data());
      for (int k = i; k < num_tail_; ++k) r(i, k) = tail[static_cast<std::size_t>(k)];
    }
    const Eigen::MatrixXd inverse =
        r.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(num_tail_, num_tail_));
    tail_ = inverse * inverse.transpose();
  }

  const BandedQr& qr_;
  int num_band_;
  int num_tail_;
  Eigen::MatrixXd tail_;
  Eigen::MatrixXd window_;  // S of the last rows, in the window's columns
  Eigen::MatrixXd beside_;  // S of the last rows, in the tail's columns
  std::vector<double> r_;
  std::vector<double> r_tail_;
  std::vector<double> right_;
};

}  // namespace

double TraceOfInverseTimes(const BandedQr& qr, const NormalBand& normal) {
  const int num_band = qr.num_band_columns();
  const int n = normal.size();
  const int width = normal.width();
  InverseRows rows(qr);
  if (num_band == 0) return (rows.tail() * normal.ToDense()).trace();
  double trace = 0.0;
  // Places (j, j + k) in the band and, where it is cyclic, those of the last rows that wrap around
  // to column j; each entry stands for both of its places.
  const auto add_places = [&](int j, const auto& entry_of_inverse) {
    for (int k = 0; k < width && j + k < n; ++k) {
      const double entry = normal.band()[static_cast<std::size_t>(j) * width + k];
      trace += (k == 0 ? 1.0 : 2.0) * entry * entry_of_inverse(j + k);
    }
    for (int i = n - width + 1 + j; normal.cyclic() && i < n; ++i) {
      trace += 2.0 * normal.band()[static_cast<std::size_t>(i) * width + n + j - i] *
               entry_of_inverse(i);
    }
  };
  for (int j = n - 1; j >= num_band; --j) {
    add_places(j, [&](int k) { return rows.tail()(j - num_band, k - num_band); });
  }
  for (int j = num_band - 1; j >= 0; --j) {
    rows.Next(j);
    add_places(j,
               [&](int k) { return k < num_band ? rows.near(k - j) : rows.beside(k - num_band); });
  }
  return trace;
}

}  // namespace batten
