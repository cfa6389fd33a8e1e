#include "cost_functions/bessel_tangents.h"

#include <cmath>
#include <limits>
#include <vector>

namespace batten {
namespace {

struct Node {
  double parameter = 0.0;
  Eigen::RowVectorXd point;
};

/// Up to so many nodes of different parameters, nearest to the end first. Data need not be sorted.
std::vector<Node> NodesAt(const FitSetting& setting, bool at_end, std::size_t most) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Sites& data = *setting.data;
  std::vector<Node> nodes;
  double last = at_end ? kInfinity : -kInfinity;
  while (nodes.size() < most) {
    double next = at_end ? -kInfinity : kInfinity;
    for (int i = 0; i < data.size; ++i) {
      const double t = data.parameters[i];
      if (at_end ? t < last && t > next : t > last && t < next) next = t;
    }
    if (std::isinf(next)) break;
    Node node = {next, Eigen::RowVectorXd::Zero(setting.dimension)};
    int count = 0;
    for (int i = 0; i < data.size; ++i) {
      if (data.parameters[i] != next) continue;
      node.point += Eigen::Map<const Eigen::RowVectorXd>(
          data.points + static_cast<std::ptrdiff_t>(i) * setting.dimension, setting.dimension);
      ++count;
    }
    node.point /= count;
    nodes.push_back(std::move(node));
    last = next;
  }
  return nodes;
}

}  // namespace

Eigen::RowVectorXd EndDatum(const FitSetting& setting, bool at_end) {
  return NodesAt(setting, at_end, 1).front().point;
}

std::optional<Eigen::RowVectorXd> BesselTangent(const FitSetting& setting, bool at_end) {
  const std::vector<Node> nodes = NodesAt(setting, at_end, 3);
  if (nodes.size() < 2) return std::nullopt;
  const double t = at_end ? setting.basis->domain_end() : setting.basis->domain_begin();
  const Eigen::RowVectorXd first =
      (nodes[1].point - nodes[0].point) / (nodes[1].parameter - nodes[0].parameter);
  if (nodes.size() == 2) return first;
  const Eigen::RowVectorXd second =
      (nodes[2].point - nodes[1].point) / (nodes[2].parameter - nodes[1].parameter);
  const Eigen::RowVectorXd bend = (second - first) / (nodes[2].parameter - nodes[0].parameter);
  // Newton's form, differentiated.
  return first + bend * ((t - nodes[0].parameter) + (t - nodes[1].parameter));
}

}  // namespace batten
