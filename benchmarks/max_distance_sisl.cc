// Data reduction by SISL (s1961: knot removal of Lyche and Morken) as a filter for
// max_distance_peers.py: it reads "dimension closed degree m" and m points, then tolerances; to
// each it answers "dof seconds number_of_knots number_of_coefficients", the knots and the
// coefficients of its curve with the fewest control points over three ways to share the tolerance,
// or "none".

#include <sisl.h>
#include <time.h>

#include <cmath>
#include <iomanip>
#include <iostream>
#include <vector>

namespace {

double ProcessorSeconds() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Control points that may be chosen: periodic ones repeat, a closed curve's last is its first.
int NumFree(const SISLCurve& curve, int iopen) {
  if (iopen == 1) return curve.in;
  if (iopen == 0) return curve.in - 1;
  int count = 0;
  const double begin = curve.et[curve.ik - 1], end = curve.et[curve.in];
  for (int i = 0; i < curve.in + curve.ik; ++i) count += curve.et[i] > begin && curve.et[i] <= end;
  return count;
}

}  // namespace

int main() {
  int dimension = 0, closed = 0, degree = 0, m = 0;
  if (!(std::cin >> dimension >> closed >> degree >> m)) return 2;
  std::vector<double> points(static_cast<std::size_t>(m) * dimension);
  for (double& x : points) std::cin >> x;
  // s1961 would add the first point to a closed curve, but not count it.
  if (closed != 0) points.insert(points.end(), points.begin(), points.begin() + dimension);
  std::cout << std::setprecision(17);
  for (double tolerance = 0.0; std::cin >> tolerance;) {
    std::vector<double> tolerances(static_cast<std::size_t>(dimension), tolerance),
        error = tolerances;
    SISLCurve* best = nullptr;
    int fewest = 0;
    const double begin = ProcessorSeconds();
    for (const int iopen : closed != 0 ? std::vector<int>{-1, 0} : std::vector<int>{1}) {
      for (const double share : {0.0, 0.2, 0.5}) {
        std::vector<double> copy = points;
        SISLCurve* curve = nullptr;
        int status = 0;
        s1961(copy.data(), static_cast<int>(copy.size()) / dimension, dimension, 1, nullptr,
              tolerances.data(), 0, 0, iopen, share, 10, degree + 1, &curve, error.data(), &status);
        if (status < 0 || curve == nullptr) continue;
        const int count = NumFree(*curve, iopen);
        if (best == nullptr || count < fewest) {
          std::swap(best, curve);
          fewest = count;
        }
        if (curve != nullptr) freeCurve(curve);
      }
    }
    if (best == nullptr) {
      std::cout << "none" << std::endl;
      continue;
    }
    std::cout << fewest << ' ' << ProcessorSeconds() - begin << ' ' << best->in + best->ik << ' '
              << best->in << '\n';
    for (int i = 0; i < best->in + best->ik; ++i) std::cout << best->et[i] << ' ';
    std::cout << '\n';
    for (int i = 0; i < best->in * dimension; ++i) std::cout << best->ecoef[i] << ' ';
    std::cout << std::endl;
    freeCurve(best);
  }
}
