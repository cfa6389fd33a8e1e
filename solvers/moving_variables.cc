#include "solvers/moving_variables.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "solvers/solver.h"

namespace batten {
namespace {

/// Calls body(window) for each window of the problem's blocks at all variables x.
template <typename Body>
void ForEachWindow(const Problem& problem, const Eigen::VectorXd& x, Body body) {
  BindingWindow window;
  for (const Problem::TermInstance& term : problem.terms()) {
    for (int block = 0; block < term.family->size(); ++block) {
      if (term.family->Window(x, block, &window)) body(window);
    }
  }
}

using Entry = Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator;

/// Of each variable its place among the free ones; -1: constraints determine it.
std::vector<int> PlacesInFree(const LinearElimination& elimination, int num_variables) {
  std::vector<int> places(static_cast<std::size_t>(num_variables), -1);
  if (elimination.trivial()) std::iota(places.begin(), places.end(), 0);
  for (std::size_t k = 0; k < elimination.free().size(); ++k) {
    places[static_cast<std::size_t>(elimination.free()[k])] = static_cast<int>(k);
  }
  return places;
}

}  // namespace

std::string WhyNoWindows(const Problem& problem, const std::string& solver_name) {
  std::string why_no_order = WhyNoOrder(problem, solver_name);
  if (!why_no_order.empty()) return why_no_order;
  std::vector<char> moves(static_cast<std::size_t>(problem.num_variables()), 0);
  bool is_bounded = false;
  ForEachWindow(problem, problem.start(), [&](const BindingWindow& window) {
    const int v = window.variable;
    moves[static_cast<std::size_t>(v)] = 1;
    is_bounded |= problem.has_bounds() && (std::isfinite(problem.lower_bounds()[v]) ||
                                           std::isfinite(problem.upper_bounds()[v]));
  });
  if (is_bounded) {
    return solver_name + " bounds free parameters itself; hold one by a linear constraint instead";
  }
  if (problem.elimination().trivial()) return "";
  const LinearElimination& elimination = problem.elimination();
  const std::vector<int> places = PlacesInFree(elimination, problem.num_variables());
  for (int v = 0; v < problem.num_variables(); ++v) {
    if (places[static_cast<std::size_t>(v)] >= 0) continue;
    for (Entry entry(elimination.z(), v); entry; ++entry) {
      const int other = elimination.free()[static_cast<std::size_t>(entry.col())];
      if (moves[static_cast<std::size_t>(v)] != 0 || moves[static_cast<std::size_t>(other)] != 0) {
        return solver_name +
               " takes constraints that hold free parameters, none that tie them to others; use "
               "lbfgs";
      }
    }
  }
  return "";
}

MovingVariables::MovingVariables(const Problem& problem, Eigen::VectorXd* y) {
  const std::vector<int> places = PlacesInFree(problem.elimination(), problem.num_variables());
  std::vector<char> is_known(static_cast<std::size_t>(y->size()), 0);
  ForEachWindow(problem, problem.elimination().Expand(*y), [&](BindingWindow window) {
    window.variable = places[static_cast<std::size_t>(window.variable)];
    if (window.variable < 0) return;
    char& known = is_known[static_cast<std::size_t>(window.variable)];
    if (known != 0) return;  // windows of other terms around the same variable are equal
    known = 1;
    (*y)[window.variable] = window.place;
    windows_.push_back(window);
  });
}

bool MovingVariables::AnyHasArrived(const Eigen::VectorXd& y) const {
  return std::any_of(windows_.begin(), windows_.end(), [&y](const BindingWindow& window) {
    const double value = y[window.variable];
    return (value <= window.low && window.place > window.low) ||
           (value >= window.high && window.place < window.high);
  });
}

std::vector<int> MovingVariables::Pressed(const Eigen::VectorXd& y,
                                          const Eigen::VectorXd& gradient) const {
  std::vector<int> pressed;
  for (const BindingWindow& window : windows_) {
    const int v = window.variable;
    if ((window.low_is_end && y[v] <= window.low && gradient[v] > 0.0) ||
        (window.high_is_end && y[v] >= window.high && gradient[v] < 0.0)) {
      pressed.push_back(v);
    }
  }
  return pressed;
}

bool MovingVariables::AnyIsAtAnEnd() const {
  return std::any_of(windows_.begin(), windows_.end(), [](const BindingWindow& window) {
    return (window.low_is_end && window.place <= window.low) ||
           (window.high_is_end && window.place >= window.high);
  });
}

}  // namespace batten
