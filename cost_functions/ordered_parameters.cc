#include "cost_functions/ordered_parameters.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace batten {

OrderedParameters::OrderedParameters(const Eigen::Ref<const Eigen::VectorXd>& s, double period) {
  const auto m = static_cast<int>(s.size());
  struct Block {
    int begin;
    int size;
    double mean;
  };
  std::vector<Block> blocks;
  for (int i = 0; i < m; ++i) {
    Block block = {i, 1, s[i]};
    while (!blocks.empty() && !(blocks.back().mean < block.mean)) {
      const Block& before = blocks.back();
      // Equal points stay where they are, to the last bit.
      const double mean =
          before.mean == block.mean
              ? block.mean
              : (before.mean * before.size + block.mean * block.size) / (before.size + block.size);
      block = {before.begin, before.size + block.size, mean};
      blocks.pop_back();
    }
    blocks.push_back(block);
  }
  t.resize(m);
  for (const Block& block : blocks) {
    block_begins.push_back(block.begin);
    t.segment(block.begin, block.size).setConstant(block.mean);
  }
  block_begins.push_back(m);
  if (period == 0.0) return;
  // Both sides of the seam move by themselves, and round by themselves.
  const double rounding = 8.0 * std::numeric_limits<double>::epsilon() * (std::abs(t[0]) + period);
  while (num_cut < m && t[m - 1 - num_cut] >= t[0] + period - rounding) ++num_cut;
  t.tail(num_cut).setConstant(t[0] + period);
}

std::vector<int> OrderedParameters::BlockOf() const {
  std::vector<int> block_of(static_cast<std::size_t>(t.size()), 0);
  for (std::size_t b = 0; b + 1 < block_begins.size(); ++b) {
    for (int i = block_begins[b]; i < std::min<int>(block_begins[b + 1], t.size() - num_cut); ++i) {
      block_of[static_cast<std::size_t>(i)] = static_cast<int>(b);
    }
  }
  return block_of;
}

Eigen::VectorXd OrderedParameters::Apply(const Eigen::Ref<const Eigen::VectorXd>& ds) const {
  Eigen::VectorXd dt(ds.size());
  for (std::size_t b = 0; b + 1 < block_begins.size(); ++b) {
    const int size = block_begins[b + 1] - block_begins[b];
    dt.segment(block_begins[b], size).setConstant(ds.segment(block_begins[b], size).mean());
  }
  dt.tail(num_cut).setConstant(dt[0]);
  return dt;
}

Eigen::VectorXd OrderedParameters::SteepestAscent(
    const Eigen::Ref<const Eigen::VectorXd>& g) const {
  const auto regress = [](const Eigen::VectorXd& ascent) {
    return Eigen::VectorXd(-OrderedParameters(-ascent, 0.0).t);
  };
  Eigen::VectorXd ascent(g.size());
  for (std::size_t b = 0; b + 1 < block_begins.size(); ++b) {
    const int begin = block_begins[b];
    const auto end = std::min<Eigen::Index>(block_begins[b + 1], t.size() - num_cut);
    if (begin < end) ascent.segment(begin, end - begin) = regress(g.segment(begin, end - begin));
  }
  if (num_cut == 0) return ascent;
  // A period on, the last points and the first block are neighbours at one place, in this order.
  const auto first = std::min<Eigen::Index>(block_begins[1], t.size() - num_cut);
  Eigen::VectorXd around(num_cut + first);
  around << g.tail(num_cut), g.head(first);
  around = regress(around);
  ascent.tail(num_cut) = around.head(num_cut);
  ascent.head(first) = around.tail(first);
  return ascent;
}

Eigen::VectorXd OrderedParameters::ApplyTransposed(
    const Eigen::Ref<const Eigen::VectorXd>& dt) const {
  Eigen::VectorXd kept = dt;
  kept[0] += dt.tail(num_cut).sum();
  kept.tail(num_cut).setZero();
  Eigen::VectorXd ds(dt.size());
  for (std::size_t b = 0; b + 1 < block_begins.size(); ++b) {
    const int size = block_begins[b + 1] - block_begins[b];
    ds.segment(block_begins[b], size).setConstant(kept.segment(block_begins[b], size).mean());
  }
  return ds;
}

}  // namespace batten
