#include "splines/bezier_cut_value.h"

#include "splines/bezier_hull.h"
#include "splines/bezier_measures.h"

namespace batten {
namespace {

double FlatnessOf(int degree, int dimension, const double* points) {
  const Quotient sum = Flatness(degree, dimension, points);
  return sum.numerator / sum.denominator;
}

}  // namespace

const char* ToString(CutMeasure measure) {
  return measure == CutMeasure::kFlatness ? "flatness" : "hull_area";
}

double CutValue::operator()(double u) {
  ++num_evaluations_;
  CutBezier(degree_, dimension_, u, points_, first_.data(), second_.data());
  if (measure_ == CutMeasure::kHullArea) {
    return HullArea(degree_, first_.data()) + HullArea(degree_, second_.data());
  }
  return FlatnessOf(degree_, dimension_, first_.data()) +
         FlatnessOf(degree_, dimension_, second_.data());
}

}  // namespace batten
