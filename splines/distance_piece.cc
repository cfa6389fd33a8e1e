#include "splines/distance_piece.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace batten {
namespace {

constexpr double kPieceRounding = std::numeric_limits<double>::epsilon();
constexpr int kMaxProduct = 2 * kMaxDegree + 1;

/// binomial[p][i] up to 2 kMaxDegree.
using Binomials = std::array<std::array<double, kMaxProduct>, kMaxProduct>;

Binomials MakeBinomials() {
  Binomials table{};
  for (std::size_t p = 0; p < table.size(); ++p) {
    table[p][0] = 1.0;
    for (std::size_t i = 1; i <= p; ++i) {
      table[p][i] = table[p - 1][i - 1] + (i < p ? table[p - 1][i] : 0.0);
    }
  }
  return table;
}

/// weights[p][i][j] of v_i . v_j in coefficient i + j of the square.
struct SquareWeights {
  double weight[kMaxDegree + 1][kMaxOrder][kMaxOrder];
  SquareWeights() {
    const Binomials binomial = MakeBinomials();
    for (std::size_t p = 0; p <= kMaxDegree; ++p) {
      for (std::size_t i = 0; i <= p; ++i) {
        for (std::size_t j = 0; j <= p; ++j) {
          weight[p][i][j] = binomial[p][i] * binomial[p][j] / binomial[2 * p][i + j];
        }
      }
    }
  }
};

}  // namespace

DistancePiece::DistancePiece(int degree, int dimension, const double* points, const double* point,
                             double low, double high, double rounding)
    : degree_(degree), dimension_(dimension), low_(low), high_(high), rounding_(rounding) {
  for (int i = 0; i <= degree; ++i) {
    for (int c = 0; c < dimension; ++c) {
      v_[i * dimension + c] = points[i * dimension + c] - point[c];
    }
  }
  Look();
}

void DistancePiece::Look() {
  if (degree_ == 3 && dimension_ == 2) return LookAt<3, 2>();
  if (degree_ == 3 && dimension_ == 3) return LookAt<3, 3>();
  LookAt<-1, -1>();
}

template <int P, int D>
void DistancePiece::LookAt() {
  static const SquareWeights kWeights;
  const int p = P >= 0 ? P : degree_;
  const int d = D >= 0 ? D : dimension_;
  const auto& weight = kWeights.weight[p];
  double f[P >= 0 ? 2 * P + 1 : kMaxProduct] = {};
  double largest = 0.0;
  diameter_ = 0.0;
  for (int i = 0; i <= p; ++i) {
    const double* a = v_ + i * d;
    double square = 0.0;
    double apart = 0.0;
    for (int c = 0; c < d; ++c) {
      square += a[c] * a[c];
      apart += (a[c] - v_[c]) * (a[c] - v_[c]);
    }
    f[2 * i] += weight[i][i] * square;
    largest = std::max(largest, square);
    diameter_ = std::max(diameter_, apart);
    for (int j = i + 1; j <= p; ++j) {
      double product = 0.0;
      for (int c = 0; c < d; ++c) product += a[c] * v_[j * d + c];
      f[i + j] += 2.0 * weight[i][j] * product;
    }
  }
  diameter_ = 2.0 * std::sqrt(diameter_);
  // |v + delta|^2 - |v|^2 for every coordinate off by rounding_, and a rounding for each of the
  // at most p + d + 2 sums and products, all at once.
  const double size = std::sqrt(largest);
  const double noise =
      2.0 * std::sqrt(d) * rounding_ * (size + rounding_) + (p + d + 2) * kPieceRounding * largest;
  double least = f[0];
  bool rises = true, falls = true, convex = true;
  for (int k = 1; k <= 2 * p; ++k) {
    least = std::min(least, f[k]);
    rises = rises && f[k] - f[k - 1] > 2.0 * noise;
    falls = falls && f[k - 1] - f[k] > 2.0 * noise;
    if (k > 1) convex = convex && f[k] - 2.0 * f[k - 1] + f[k - 2] > 4.0 * noise;
  }
  lower_bound_ = std::max(0.0, least - noise);
  if (!std::isfinite(least)) lower_bound_ = std::numeric_limits<double>::infinity();
  shape_ = rises    ? Shape::kRises
           : falls  ? Shape::kFalls
           : convex ? Shape::kConvex
                    : Shape::kUnknown;
}

void DistancePiece::Split(DistancePiece* left, DistancePiece* right) const {
  const double middle = low_ + 0.5 * (high_ - low_);
  *left = *this;
  *right = *this;
  left->high_ = right->low_ = middle;
  for (int r = 1; r <= degree_; ++r) {
    // right->v_ holds level r - 1 from r - 1 on; left->v_[i] is the first point of level i.
    for (int i = 0; i <= degree_ - r; ++i) {
      for (int c = 0; c < dimension_; ++c) {
        double& value = right->v_[i * dimension_ + c];
        value = 0.5 * (value + right->v_[(i + 1) * dimension_ + c]);
      }
    }
    for (int c = 0; c < dimension_; ++c) left->v_[r * dimension_ + c] = right->v_[c];
  }
  left->Look();
  right->Look();
}

void BezierPoints(int degree, int dimension, const double* knots, int span, const double* window,
                  double low, double high, double* points) {
  const double* u = knots + span - degree;
  double level[kMaxOrder * kMaxDimension];
  for (int i = 0; i <= degree; ++i) {
    std::copy(window, window + (degree + 1) * dimension, level);
    for (int r = 1; r <= degree; ++r) {
      const double t = r <= degree - i ? low : high;
      for (int j = degree; j >= r; --j) {
        const double a = (t - u[j]) / (u[j + degree - r + 1] - u[j]);
        for (int c = 0; c < dimension; ++c) {
          double& value = level[j * dimension + c];
          value = (1.0 - a) * level[(j - 1) * dimension + c] + a * value;
        }
      }
    }
    std::copy(level + degree * dimension, level + (degree + 1) * dimension, points + i * dimension);
  }
}

}  // namespace batten
