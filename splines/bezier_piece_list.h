#ifndef BATTEN_SPLINES_BEZIER_PIECE_LIST_H_
#define BATTEN_SPLINES_BEZIER_PIECE_LIST_H_

#include <algorithm>
#include <vector>

#include "splines/bezier_subdivision.h"

namespace batten {

/// The result of a subdivision while it is made: pieces in their order along the curve.
class PieceList {
 public:
  /// Points are added divided by `unit`.
  PieceList(double unit, int degree, int dimension, bool keep_pieces)
      : unit_(unit), size_((degree + 1) * dimension), dimension_(dimension), keep_(keep_pieces) {}

  /// The curve begins at `point`; earlier pieces are forgotten.
  void Begin(const double* point) {
    parameters_.clear();
    pieces_.clear();
    AddVertex(point, 0.0);
  }
  /// Room for so many pieces at once.
  void Reserve(std::size_t num_pieces) {
    parameters_.reserve(num_pieces + 1);
    if (keep_) pieces_.reserve(num_pieces * static_cast<std::size_t>(size_));
    Grow(static_cast<Eigen::Index>(num_pieces) + 1);
  }
  void AddPiece(const double* points, double end) {
    AddVertex(points + size_ - dimension_, end);
    if (!keep_) return;
    for (int k = 0; k < size_; ++k) pieces_.push_back(unit_ * points[k]);
  }
  int size() const { return static_cast<int>(parameters_.size()) - 1; }

  void MoveTo(Subdivision* result) {
    vertices_.conservativeResize(static_cast<Eigen::Index>(parameters_.size()), dimension_);
    result->vertices.swap(vertices_);
    result->pieces = Eigen::Map<const Points>(
        pieces_.data(), static_cast<Eigen::Index>(pieces_.size()) / dimension_, dimension_);
    result->parameters = std::move(parameters_);
  }

 private:
  void AddVertex(const double* point, double parameter) {
    const auto row = static_cast<Eigen::Index>(parameters_.size());
    if (row == vertices_.rows()) Grow(std::max<Eigen::Index>(kFirstRows, 2 * row));
    double* const vertex = vertices_.data() + row * dimension_;
    for (int c = 0; c < dimension_; ++c) vertex[c] = unit_ * point[c];
    parameters_.push_back(parameter);
  }
  // Room grows in place where the system lets it; a second copy at the end took as long as cuts.
  void Grow(Eigen::Index rows) {
    if (rows > vertices_.rows()) vertices_.conservativeResize(rows, dimension_);
  }

  static constexpr Eigen::Index kFirstRows = 64;
  const double unit_;
  const int size_;
  const int dimension_;
  const bool keep_;
  std::vector<double> parameters_;
  Points vertices_;  // as many rows as there is room for
  std::vector<double> pieces_;
};

}  // namespace batten

#endif  // BATTEN_SPLINES_BEZIER_PIECE_LIST_H_
