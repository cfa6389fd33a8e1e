// A term whose derivatives, written by hand, are one percent too large, everywhere or where its
// numbers are far from 0.
#include <ceres/sized_cost_function.h>

#include <cmath>

#include "cost_functions/cost_function_family.h"
#include "solvers/plugin.h"

/// r = p: draws a control point to the origin.
class Pull final : public ceres::SizedCostFunction<1, 1> {
 public:
  explicit Pull(double from) : from_(from) {}
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    residuals[0] = parameters[0][0];
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      jacobians[0][0] = std::abs(parameters[0][0]) >= from_ ? 1.01 : 1.0;
    }
    return true;
  }

 private:
  double from_;
};

class Faulty final : public batten::Term {
 public:
  batten::TermInfo Info() const override {
    batten::TermInfo info =
        batten::MakeTermInfo("faulty_term", "has a wrong gradient", "tests/plugins");
    info.options.push_back(batten::OptionInfo::Real("from", 0.0, 0.0, 10.0, "where it is wrong"));
    return info;
  }
  std::unique_ptr<batten::BlockFamily> MakeFamily(const batten::FitSetting& setting,
                                                  const batten::OptionValues& options,
                                                  std::string* /*error*/) const override {
    auto family = std::make_unique<batten::CostFunctionFamily>(options.Real("weight"));
    const int size = setting.basis->num_control_points() * setting.dimension;
    for (int i = 0; i < size; ++i) {
      family->AddBlock(std::make_unique<Pull>(options.Real("from")),
                       {setting.control_point_offset + i});
    }
    return family;
  }
};

BATTEN_PLUGIN(registry) { registry->Add(std::make_unique<Faulty>()); }
