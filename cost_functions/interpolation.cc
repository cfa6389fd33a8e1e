#include "cost_functions/interpolation.h"

#include "cost_functions/functor_family.h"

namespace batten {

TermInfo InterpolationResidual::Info() {
  TermInfo info;
  info.name = "interpolation";
  info.summary = "distance of the curve from each data point at its parameter";
  info.source = "Piegl & Tiller, The NURBS Book, sec. 9.4.1";
  info.affine = kAffine;
  return info;
}

std::unique_ptr<Term> MakeInterpolationTerm() {
  return std::make_unique<FunctorTerm<InterpolationResidual>>();
}

}  // namespace batten
