#include "problems/cut_problem.h"

#include "cost_functions/bezier_cut.h"
#include "cost_functions/cost_function_family.h"
#include "cost_functions/options.h"

namespace batten {
namespace {

std::string WhyNoProblem(CutMeasure measure, const BezierCurve& curve, double start) {
  if (curve.degree() < 2) {
    return "found degree " + std::to_string(curve.degree()) + "; allowed: 2 to 60";
  }
  if (!(start > 0.0 && start < 1.0)) {
    return "found the start " + NumberText(start) + "; allowed: above 0 and below 1";
  }
  if (measure == CutMeasure::kHullArea && curve.dimension() != 2) {
    return "the hull's area needs a planar curve; found " + std::to_string(curve.dimension()) +
           " coordinates, use flatness";
  }
  return "";
}

}  // namespace

std::unique_ptr<Problem> MakeCutProblem(CutMeasure measure, const BezierCurve& curve, double start,
                                        std::string* error) {
  *error = WhyNoProblem(measure, curve, start);
  if (!error->empty()) return nullptr;
  const double unit = UnitOf(curve.control_points());
  const BezierCurve scaled = *BezierCurve::Make(curve.control_points() / unit, nullptr);
  auto family = std::make_unique<CostFunctionFamily>();
  family->AddBlock(measure == CutMeasure::kFlatness ? MakeCutCostFunction<CutFlatness>(scaled)
                                                    : MakeCutCostFunction<CutHullArea>(scaled),
                   {0});
  auto problem = std::make_unique<Problem>(std::string("cut_") + ToString(measure));
  problem->AddVariables("cut", Eigen::VectorXd::Constant(1, start));
  problem->AddTerm(ToString(measure), std::move(family));
  // The variable has no unit: gradients are in that of E.
  Units units;
  units.energy = unit * unit;
  units.gradient = unit * unit;
  problem->SetUnits(units);
  return problem;
}

}  // namespace batten
