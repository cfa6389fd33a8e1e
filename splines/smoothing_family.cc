#include "splines/smoothing_family.h"

#include <cmath>
#include <numeric>

#include "splines/banded_qr.h"
#include "splines/inverse_band.h"
#include "splines/scaled_rows.h"

namespace batten {
namespace {

/// Rows at each first column, and how many are not zero.
class Counter : public RowConsumer {
 public:
  explicit Counter(const RowShape& shape) : shape_(shape), counts(shape.num_columns, 0) {}
  void Consume(const RowBlock& block) override {
    counts[static_cast<std::size_t>(block.first_column)] += block.num_rows;
    for (int i = 0; i < block.num_rows; ++i) {
      bool is_zero = true;
      for (int j = 0; j < shape_.width; ++j) {
        is_zero = is_zero && block.coefficients[j * block.stride + i] == 0.0;
      }
      if (!is_zero) ++num_nonzero;
    }
  }

 private:
  RowShape shape_;

 public:
  std::vector<int> counts;
  int num_nonzero = 0;
};

double Trace(const NormalBand& band) {
  const std::vector<double> diagonal = band.Diagonal();
  return std::accumulate(diagonal.begin(), diagonal.end(), 0.0);
}

}  // namespace

SmoothingFamily::SmoothingFamily(const RowSource& data, const RowSource& fairing)
    : data_({&data}),
      fairing_({&fairing}),
      all_({&data_, &fairing_}),
      normal_(NormalBand::FromRows(data_)),
      trace_of_fairing_(Trace(NormalBand::FromRows(fairing_))) {
  Counter of_data(data_.shape());
  Counter of_fairing(fairing_.shape());
  data_.Stream(&of_data);
  fairing_.Stream(&of_fairing);
  num_data_ = of_data.num_nonzero;
  // Rows of one first column stand in the order of the sources.
  for (std::size_t column = 0; column < of_data.counts.size(); ++column) {
    is_fairing_.insert(is_fairing_.end(), static_cast<std::size_t>(of_data.counts[column]), 0);
    is_fairing_.insert(is_fairing_.end(), static_cast<std::size_t>(of_fairing.counts[column]), 1);
  }
}

double SmoothingFamily::BalancedWeight() const { return Trace(normal_) / trace_of_fairing_; }

bool SmoothingFamily::At(double weight, Member* member) const {
  std::vector<double> factors(is_fairing_.size(), 1.0);
  for (std::size_t i = 0; i < factors.size(); ++i) {
    if (is_fairing_[i] != 0) factors[i] = std::sqrt(weight);
  }
  BandedQr qr(all_.shape());
  ScaledRows(&all_, std::move(factors)).Stream(&qr);
  qr.Finish();
  if (!(qr.DiagonalRatio() > 0.0)) return false;
  member->weight = weight;
  qr.Solve(&member->control_points);
  if (!member->control_points.allFinite()) return false;
  member->residual = data_.Evaluate(member->control_points.data(), nullptr);
  member->bend = fairing_.Evaluate(member->control_points.data(), nullptr);
  member->trace = TraceOfInverseTimes(qr, normal_);
  return std::isfinite(member->trace);
}

}  // namespace batten
