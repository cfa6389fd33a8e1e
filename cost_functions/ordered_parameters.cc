#include "cost_functions/ordered_parameters.h"

#include <algorithm>

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
  while (num_cut < m && t[m - 1 - num_cut] > t[0] + period) ++num_cut;
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
  Eigen::VectorXd ascent = ApplyTransposed(g);
  for (std::size_t b = 0; b + 1 < block_begins.size(); ++b) {
    const int begin = block_begins[b];
    const int size = block_begins[b + 1] - begin;
    // Those cut off a period after the first block stay there.
    if (size == 1 || begin + size > t.size() - num_cut) continue;
    Eigen::VectorXd descent = -g.segment(begin, size);
    if (b == 0) descent.array() -= g.tail(num_cut).sum() / size;
    ascent.segment(begin, size) = -OrderedParameters(descent, 0.0).t;
  }
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
