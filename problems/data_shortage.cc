#include "problems/data_shortage.h"

#include "splines/schoenberg_whitney.h"

namespace batten {

std::string DataShortageText(const CurveFit& fit) {
  std::vector<double> parameters;
  for (Eigen::Index i = 0; i < fit.parameters().size(); ++i) {
    const bool counts = !fit.data().weights.has_value() || (*fit.data().weights)[i] > 0.0;
    if (counts) parameters.push_back(fit.parameters()[i]);
  }
  const DataShortage shortage = LargestDataShortage(fit.basis(), std::move(parameters));
  const int count = shortage.num_control_points;
  if (count == 0) return "";
  const int first = shortage.first_control_point;
  const int n = fit.basis().num_control_points();
  const std::string who = count == 1 ? "control point " + std::to_string(first) + " has "
                                     : "control points " + std::to_string(first) + " to " +
                                           std::to_string((first + count - 1) % n) + " have ";
  return who + std::to_string(shortage.num_parameters) +
         (shortage.num_parameters == 1 ? " distinct parameter for " : " distinct parameters for ") +
         std::to_string(count);
}

}  // namespace batten
