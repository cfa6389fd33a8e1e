#include "splines/smoothing_family.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "splines/banded_qr.h"
#include "splines/inverse_band.h"
#include "splines/scaled_rows.h"

namespace batten {
namespace {

/// Rows of a source at each first column that they have among wider ones, and how many are not
/// zero.
class Counter : public RowConsumer {
 public:
  Counter(int source_width, const RowShape& wide)
      : counts(static_cast<std::size_t>(wide.num_columns), 0),
        source_width_(source_width),
        last_column_(wide.num_columns - (wide.cyclic ? 1 : wide.width)) {}
  void Consume(const RowBlock& block) override {
    // Of open matrices wider rows begin farther left at the end (BandedRows).
    counts[static_cast<std::size_t>(std::min(block.first_column, last_column_))] += block.num_rows;
    for (int i = 0; i < block.num_rows; ++i) {
      bool is_zero = true;
      for (int j = 0; j < source_width_; ++j) {
        is_zero = is_zero && block.coefficients[j * block.stride + i] == 0.0;
      }
      if (!is_zero) ++num_nonzero;
    }
  }
  std::vector<int> counts;
  int num_nonzero = 0;

 private:
  int source_width_;
  int last_column_;
};

double Trace(const NormalBand& band) {
  const std::vector<double> diagonal = band.Diagonal();
  return std::accumulate(diagonal.begin(), diagonal.end(), 0.0);
}

}  // namespace

SmoothingFamily::SmoothingFamily(const RowSource& data, const RowSource& fairing,
                                 const RowSource* others)
    : data_({&data}),
      fairing_({&fairing}),
      others_(others == nullptr ? std::vector<const RowSource*>() : std::vector{others}),
      all_(others == nullptr ? std::vector<const RowSource*>{&data_, &fairing_}
                             : std::vector<const RowSource*>{&data_, &others_, &fairing_}),
      normal_(NormalBand::FromRows(data_)),
      trace_of_fairing_(Trace(NormalBand::FromRows(fairing_))) {
  std::vector<Counter> counters;
  for (const BandedRows* source : {&data_, &others_, &fairing_}) {
    counters.emplace_back(source->shape().width, all_.shape());
    source->Stream(&counters.back());
  }
  num_data_ = counters[0].num_nonzero;
  // Rows of one first column stand in the order of the sources.
  for (std::size_t column = 0; column < counters[0].counts.size(); ++column) {
    for (const Counter& counter : counters) {
      is_fairing_.insert(is_fairing_.end(), static_cast<std::size_t>(counter.counts[column]),
                         &counter == &counters.back() ? 1 : 0);
    }
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
