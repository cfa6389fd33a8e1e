#include "cost_functions/loss.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "cost_functions/term.h"
#include "tests/roundoff.h"

namespace batten {
namespace {

std::shared_ptr<const ceres::LossFunction> OurLoss(const std::string& loss, double scale,
                                                   double size = 1.0) {
  OptionValues options(CommonTermOptions());
  options.SetWord("loss", loss);
  options.SetNumber("loss_scale", scale);
  return MakeLoss(options, size);
}

/// Ceres' own of the same name.
std::unique_ptr<ceres::LossFunction> FromCeres(const std::string& loss, double scale) {
  if (loss == "huber") return std::make_unique<ceres::HuberLoss>(scale);
  if (loss == "cauchy") return std::make_unique<ceres::CauchyLoss>(scale);
  if (loss == "tukey") return std::make_unique<ceres::TukeyLoss>(scale);
  return std::make_unique<ceres::SoftLOneLoss>(scale);
}

TEST(Loss, IsCeresLossOfTheSameName) {
  for (const char* name : {"huber", "cauchy", "tukey", "soft_l1"}) {
    for (const double scale : {0.3, 1.0, 7.0}) {
      for (const double s : {0.0, 0.01, 0.08, 0.5, 1.7, 60.0, 1e4}) {
        double ours[3], theirs[3];
        OurLoss(name, scale)->Evaluate(s, ours);
        FromCeres(name, scale)->Evaluate(s, theirs);
        for (int k = 0; k < 3; ++k) {
          // Theirs loses the digits of 1 beside s / scale^2.
          const double size = k == 0 ? s + scale * scale : 1.0 / std::pow(scale, 2 * k - 2);
          EXPECT_NEAR(ours[k], theirs[k], 16 * kEpsilon * size) << name << " " << scale << " " << s;
        }
      }
    }
  }
}

TEST(Loss, KeepsItsDigitsForResidualsMuchSmallerThanItsScale) {
  // rho(s) = s - s^2 / (2 b) + ... for all of them, b = 1e12 here: s to one part in 1e12.
  for (const char* name : {"huber", "cauchy", "tukey", "soft_l1"}) {
    for (const double s : {1e-12, 1e-4, 1.0}) {
      double rho[3];
      OurLoss(name, 1e6)->Evaluate(s, rho);
      EXPECT_NEAR(rho[0], s, 2e-12 * s * s + 4 * kEpsilon * s) << name;
      EXPECT_NEAR(rho[1], 1.0, 2e-12 * s + 4 * kEpsilon) << name;
    }
  }
}

TEST(Loss, ScaleIsInUnitsOfTheDataSize) {
  for (const char* name : {"huber", "cauchy", "tukey", "soft_l1"}) {
    double relative[3], absolute[3];
    OurLoss(name, 0.1, 0.7)->Evaluate(0.02, relative);
    OurLoss(name, 0.1 * 0.7)->Evaluate(0.02, absolute);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(relative[k], absolute[k]) << name;
  }
  EXPECT_EQ(OurLoss("none", 1.0), nullptr);
}

}  // namespace
}  // namespace batten
