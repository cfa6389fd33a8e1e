#include "cost_functions/ordered_parameters.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace batten {

namespace {

/// Points begin..begin + size - 1 that share one t.
struct Block {
  int begin;
  int size;
  double mean;
};

/// Equal points stay where they are, to the last bit.
double PooledMean(double a, int size_of_a, double b, int size_of_b) {
  return a == b ? b : (a * size_of_a + b * size_of_b) / (size_of_a + size_of_b);
}

std::vector<Block> PoolViolators(const Eigen::Ref<const Eigen::VectorXd>& s) {
  std::vector<Block> blocks;
  for (int i = 0; i < s.size(); ++i) {
    Block block = {i, 1, s[i]};
    while (!blocks.empty() && !(blocks.back().mean < block.mean)) {
      const Block& before = blocks.back();
      const double mean = PooledMean(before.mean, before.size, block.mean, block.size);
      block = {before.begin, before.size + block.size, mean};
      blocks.pop_back();
    }
    blocks.push_back(block);
  }
  return blocks;
}

/// The last blocks that are a period or more after the first one join it, which may pass others
/// then: neighbours of which the mean of the former is not below that of the latter share one t at
/// the nearest point, around the circle as on the line. Returns how many points come a period on.
int PoolAcrossSeam(double period, std::vector<Block>* blocks) {
  Block first = blocks->front();
  int num_cut = 0;
  std::size_t low = 1;
  std::size_t high = blocks->size();
  // Both sides of the seam round by themselves.
  const double rounding =
      8.0 * std::numeric_limits<double>::epsilon() * (std::abs(first.mean) + period);
  while (low < high) {
    const Block& last = (*blocks)[high - 1];
    const Block& next = (*blocks)[low];
    const double back = last.mean - period;
    if (back >= first.mean - rounding) {
      if (back > first.mean + rounding) {
        first.mean = PooledMean(first.mean, first.size + num_cut, back, last.size);
      }
      num_cut += last.size;
      --high;
    } else if (num_cut > 0 && !(first.mean < next.mean)) {
      first.mean = PooledMean(first.mean, first.size + num_cut, next.mean, next.size);
      first.size += next.size;
      ++low;
    } else {
      break;
    }
  }
  if (num_cut == 0) return 0;
  std::vector<Block> pooled = {first};
  pooled.insert(pooled.end(), blocks->begin() + static_cast<std::ptrdiff_t>(low),
                blocks->begin() + static_cast<std::ptrdiff_t>(high));
  const int end = blocks->back().begin + blocks->back().size;
  pooled.push_back({end - num_cut, num_cut, first.mean + period});
  blocks->swap(pooled);
  return num_cut;
}

void SetBlocks(const std::vector<Block>& blocks, Eigen::Index count, OrderedParameters* order) {
  order->t.resize(count);
  for (const Block& block : blocks) {
    order->block_begins.push_back(block.begin);
    order->t.segment(block.begin, block.size).setConstant(block.mean);
  }
  order->block_begins.push_back(static_cast<int>(count));
}

/// Means over runs of equal entries of `ascent`; with `stays` 0 over those of zeros.
Eigen::VectorXd MeansOverRuns(const Eigen::VectorXd& ascent, Eigen::VectorXd d, bool stays) {
  for (Eigen::Index begin = 0, end = 0; begin < d.size(); begin = end) {
    while (end < d.size() && ascent[end] == ascent[begin]) ++end;
    auto run = d.segment(begin, end - begin);
    run.setConstant(stays && ascent[begin] == 0.0 ? 0.0 : run.mean());
  }
  return d;
}

/// What body(gather, inward) makes of the points of each place, put where they stand: gather(v) are
/// their entries of v in their order, a period on the last points before those of the first block;
/// `inward` is the sign of moves that stay on an open curve, 0 inside.
template <typename Body>
Eigen::VectorXd ByPlace(const OrderedParameters& order, const Body& body) {
  Eigen::VectorXd result(order.t.size());
  const std::size_t num_blocks = order.block_begins.size() - 1;
  for (std::size_t b = 0; b < num_blocks; ++b) {
    const int begin = order.block_begins[b];
    const auto end =
        std::min<Eigen::Index>(order.block_begins[b + 1], result.size() - order.num_cut);
    if (begin >= end) continue;  // the last points of all, which go with the first
    const int before = b == 0 ? order.num_cut : 0;
    const auto gather = [&](const Eigen::Ref<const Eigen::VectorXd>& v) {
      Eigen::VectorXd place(before + end - begin);
      place << v.tail(before), v.segment(begin, end - begin);
      return place;
    };
    const bool at_end = order.last_at_end && b + 1 == num_blocks;
    const int inward = order.first_at_end && b == 0 ? 1 : at_end ? -1 : 0;
    const Eigen::VectorXd place = body(gather, inward);
    result.tail(before) = place.head(before);
    result.segment(begin, end - begin) = place.tail(end - begin);
  }
  return result;
}

}  // namespace

OrderedParameters::OrderedParameters(const Eigen::Ref<const Eigen::VectorXd>& s, double period) {
  std::vector<Block> blocks = PoolViolators(s);
  if (period > 0.0 && !blocks.empty()) num_cut = PoolAcrossSeam(period, &blocks);
  SetBlocks(blocks, s.size(), this);
}

OrderedParameters::OrderedParameters(const Eigen::Ref<const Eigen::VectorXd>& s, double low,
                                     double high) {
  std::vector<Block> blocks;
  for (Block block : PoolViolators(s)) {
    block.mean = std::min(std::max(block.mean, low), high);
    const bool is_at_end = block.mean == low || block.mean == high;
    if (is_at_end && !blocks.empty() && blocks.back().mean == block.mean) {
      blocks.back().size += block.size;
    } else {
      blocks.push_back(block);
    }
  }
  first_at_end = !blocks.empty() && blocks.front().mean == low;
  last_at_end = !blocks.empty() && blocks.back().mean == high;
  SetBlocks(blocks, s.size(), this);
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
  return ByPlace(*this, [&ds](const auto& gather, int inward) {
    Eigen::VectorXd place = gather(ds);
    place.setConstant(inward == 0 ? place.mean() : 0.0);
    return place;
  });
}

Eigen::VectorXd OrderedParameters::KeptTogether(const Eigen::Ref<const Eigen::VectorXd>& ascent,
                                                const Eigen::Ref<const Eigen::VectorXd>& d) const {
  return ByPlace(*this, [&ascent, &d](const auto& gather, int inward) {
    return MeansOverRuns(gather(ascent), gather(d), inward != 0);
  });
}

Eigen::VectorXd OrderedParameters::SteepestAscent(
    const Eigen::Ref<const Eigen::VectorXd>& g) const {
  return ByPlace(*this, [&g](const auto& gather, int inward) {
    Eigen::VectorXd ascent = -OrderedParameters(-gather(g), 0.0).t;
    if (inward > 0) ascent = ascent.cwiseMin(0.0);
    if (inward < 0) ascent = ascent.cwiseMax(0.0);
    return ascent;
  });
}

}  // namespace batten
